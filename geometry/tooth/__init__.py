"""One gear: its data (ISO 21771), the involute, and the outline of one tooth with its fillet.

Lengths in mm, angles in rad. No meshes, no damage, no loads.
"""
