"""What a loaded tooth bears: its deflection, its root stress, the stress intensity of its cracks, all by finite elements."""
