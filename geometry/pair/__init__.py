"""Meshing gears: centre distance, path of contact, contact ratios, contact lines, interference, planetary sets.

Kinematics only: where flanks touch, never how hard.
"""
