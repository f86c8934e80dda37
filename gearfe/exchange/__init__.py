"""Exchange with other programs: gear units from REXS, and gears, curves and laws in the forms that other programs read."""
