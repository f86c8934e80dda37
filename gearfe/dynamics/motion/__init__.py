"""How a machine moves: `simulate` in time, `steady` for periodic motion.

An exponential integrator with exact linear part, its compiled twin, its step control, and scipy's methods as the reference.
"""
