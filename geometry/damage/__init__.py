"""Damage of a tooth: root cracks (straight, kinked, in parts of the width), pits, spalls, missing teeth and chips.

This package describes the position of the damage on the tooth, and the seams of cracks in a mesh. `gearfe` computes the effect on
stiffness.
"""
