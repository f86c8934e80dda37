"""Load sharing: unilateral contacts of tooth pairs, and the loads that they carry.

`pair_contact` solves the plane section, `wide_contact` contact lines over the width; both read flexibilities and never ask where
these came from.
"""
