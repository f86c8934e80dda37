"""Stress of loaded teeth, and pictures of it without a screen.

Sections with cracks (`fields`), teeth with pits cut out as holes (`holed`), pyvista's pictures and .vtu files (`render`).
"""
