"""Flexibility by finite elements of whole sections (`fe`) and of whole gears (`fe3d`): meshes, elements, solvers.

It is deliberately based on large meshes, because it is the reference for the energy methods.
"""
