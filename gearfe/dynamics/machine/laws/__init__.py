"""Contact laws of gear meshes, one file for each: how hard flanks push when they are pressed into each other.

The table of them, and what a new one needs, is in `gearfe.dynamics.machine.contact_law`.
"""
