"""Meshes of teeth and gears: gmsh triangulations, curved sectors for the energy model, hexahedra, teeth with holes.

Only this package uses gmsh. Boundaries have names. Loads and materials are not part of it.
"""
