"""The converged energy model, in the section (`plane`) and over the width (`solid`).

Polynomials on one pitch sector (`panel`, `panel3d`), condensed onto its sides and joined to the whole gear.
"""
