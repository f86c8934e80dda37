"""`mesh_stiffness`: from a gear pair to its stiffness curve, with its error estimate.

Inputs are checked here, methods chosen, solved gears kept, curves given to `gearfe.core.files` and read back.
"""
