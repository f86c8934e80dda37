"""Exchange with other programs: import of REXS gear units, export of gears, curves and force laws."""
