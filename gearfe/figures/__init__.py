"""Plots of stiffness and vibration with matplotlib.

Nothing is computed here.
"""
