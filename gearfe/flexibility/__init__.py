"""Flexibility of one gear between its contacts, in the transverse section (`plane`) and over the width (`solid`).

Everything meets here: finite elements and energy methods make these two types, contact reads them. Beside them the local
laws of contact: Hertz's line contact, the half-space, Flamant's half-plane.
"""
