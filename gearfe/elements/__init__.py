"""Flexibility by finite elements: whole sections (`fe`), whole gears of hexahedra (`fe3d`), single loaded teeth.

Brute force on purpose: it is what the energy methods are judged by. Also stress intensities of cracks and decks for CalculiX.
"""
