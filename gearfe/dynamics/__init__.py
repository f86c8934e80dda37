"""Gearbox dynamics: models of masses, springs and meshes, their simulation and their steady state."""
