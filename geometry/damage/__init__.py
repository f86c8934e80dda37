"""Damage of a tooth: root cracks (straight, kinked, in parts of the width), pits, spalls, missing teeth and chips.

This package contains the position of the damage on the tooth, and the cracks' seams in a mesh. Its effect on stiffness is
computed in `gearfe`.
"""
