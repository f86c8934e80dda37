"""Independent reference: whole outlines of two gears in contact in plane strain, without gearfe's contact geometry.

`cutting` generates teeth by brute force, and `outline` removes the flank modifications. `touching` finds the first contact of
rigid outlines. `body` is a gear in finite elements, `pressing` computes the contact pressures, and `cases` are the compared
gears.

Gears, pairs and flanks are taken as input numbers. Of the pair's kinematics only the definition of a phase is used:
``pair.path[0]``, ``pair.p_bt`` and ``pair.turn(nominal)`` give the angles of both gears at a phase.
"""
