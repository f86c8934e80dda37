"""Whole planetary sets in plane strain: one contact problem of sun, planets and an elastic ring.

Modules: flexibility of a gear over all its teeth (`whole_gear`), support of the ring (`rim`), tooth positions (`standing`),
contacts of each mesh (`meshes`), load sharing (`balance`), results (`solve`).
"""
