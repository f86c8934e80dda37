"""Who carries how much: contacts that can push but not pull share a load.

`pair_contact` solves the plane section, `wide_contact` contact lines over the width; both read flexibilities and never ask where
these came from.
"""
