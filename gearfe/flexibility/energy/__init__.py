"""Flexibility and stiffness by potential energy: converged (`ritz`) and in closed form (`closed`).

`ritz` minimises the energy over polynomials on curved triangles; `closed` are the formulas of the literature.
"""
