"""Machines (dynamic models) as tables of masses, springs and gear meshes, and built-in machines.

`tables` defines the types. Each built-in machine has one file. `of_scene` builds the machine of a scene.
"""
