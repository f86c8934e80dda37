"""Flexibility by finite elements: whole sections (`fe`), whole gears of hexahedra (`fe3d`); meshes, elements, solvers.

It uses brute force on purpose, as the reference of the energy methods.
"""
