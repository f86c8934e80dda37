"""Meshing gears: centre distance, path of contact, contact ratios, contact lines, interference, planetary sets.

The package contains kinematics only, without forces.
"""
