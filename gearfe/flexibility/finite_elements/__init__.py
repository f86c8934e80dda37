"""Flexibility by finite elements of whole sections (`fe`) and of whole gears (`fe3d`): meshes, elements, solvers.

It uses brute force on purpose, as the reference of the energy methods.
"""
