"""Motion of a machine: `simulate` for the time response, `steady` for periodic motion.

The package has a compiled exponential integrator with exact linear part, its step control, and methods of scipy as reference.
"""
