"""Machines as tables of masses, springs and gear meshes, and the built-in ones.

`tables` holds the types, one file per machine states its bodies; `of_scene` builds them from a scene.
"""
