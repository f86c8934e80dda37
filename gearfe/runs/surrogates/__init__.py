"""A fitted stand-in for `ritz` over a stated range of gears and cracks: k in microseconds, its error held against fresh cases.

`space` names what may vary, `zoned` writes a curve by the zones of the mesh cycle, `fit` fits, `surrogate` answers.
"""
