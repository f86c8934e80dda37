"""Whole planetary sets in plane strain: one contact problem of sun, planets and an elastic ring.

Each gear's flexibility over all its teeth (`whole_gear`), a ring on what holds its rim (`rim`), where teeth stand (`standing`),
what pairs know of their contact (`meshes`), who carries how much (`balance`), and what comes out of it (`solve`).
"""
