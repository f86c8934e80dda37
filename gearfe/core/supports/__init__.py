"""Supports of a gear: a hub on springs, or a shaft on two bearings.

This package contains the statics of straight beams only. `gearfe.contact` uses it for the deflection of the flanks with their
hub.
"""
