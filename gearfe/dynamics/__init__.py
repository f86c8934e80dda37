"""Vibration: machines (masses, springs, meshes), their simulation and their steady state."""
