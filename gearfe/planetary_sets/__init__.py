"""Whole planetary sets in plane strain: one contact problem of sun, planets and an elastic ring.

The modules compute the flexibility of a gear over all teeth (`whole_gear`), the support of the ring (`rim`), tooth positions
(`standing`), contacts of each mesh (`meshes`), load sharing (`balance`) and results (`solve`).
"""
