"""Load sharing between tooth pairs in unilateral contact.

`pair_contact` solves the plane section. `wide_contact` solves contact lines over the width. Both use flexibilities of the gears
from any method.
"""
