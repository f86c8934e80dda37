"""Flexibility by finite elements: whole sections (`fe`), whole gears of hexahedra (`fe3d`); meshes, elements, solvers.

Brute force on purpose: it is what the energy methods are judged by.
"""
