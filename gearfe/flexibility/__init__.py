"""Flexibility of one gear between its contacts, in the transverse section (`plane`) and over the width (`solid`).

Finite elements and energy methods compute these two types, and the contact solvers use them. The package also contains the local
laws of contact: Hertzian line contact, the half-space, Flamant's half-plane.
"""
