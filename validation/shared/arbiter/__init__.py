"""The arbiter: whole outlines of two gears pressed together in plane strain, with nothing of gearfe's contact geometry.

`cutting` cuts teeth by brute force, `outline` adds what flanks lack, `touching` finds where rigid outlines first touch,
`body` is a finite-element gear, `pressing` finds the contact pressures between outlines, `cases` are the gears it judges.

Gears, pairs and flanks are taken as input numbers. Of the pair's kinematics only the definition of a phase is used:
``pair.path[0]``, ``pair.p_bt`` and ``pair.turn(nominal)`` say at which angles both gears stand at a phase. That is no physics.
"""
