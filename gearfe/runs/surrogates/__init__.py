"""Surrogate of `ritz` over a range of gears and cracks: k in microseconds, with its error on held-back cases.

`space` defines the inputs, `zoned` represents a curve by the zones of the mesh cycle, `fit` fits, `surrogate` evaluates.
"""
