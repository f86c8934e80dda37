"""Load sharing between tooth pairs in unilateral contact.

`pair_contact` solves the plane section, `wide_contact` contact lines over the width; both read flexibilities and never ask where
these came from.
"""
