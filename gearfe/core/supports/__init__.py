"""What holds a gear: a hub on springs, or on a shaft between two bearings.

Only statics of straight beams stands here; `gearfe.contact` asks it how far the flanks of a loaded gear give way with its hub.
"""
