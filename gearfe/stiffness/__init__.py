"""`mesh_stiffness`: from a gear pair to its stiffness curve with an error estimate.

The package checks inputs, selects the method, stores solved gears, and writes and reads curves.
"""
