"""Meshes of teeth and gears: gmsh triangulations, curved sectors for the energy model, hexahedra, teeth with holes.

The only room that opens gmsh. Boundaries are named; nothing here knows about loads or materials.
"""
