"""Strength of a loaded tooth: deflection, root stress and stress intensity of cracks, by finite elements."""
