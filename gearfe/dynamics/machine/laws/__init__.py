"""Contact laws of gear meshes, one file for each: force of flanks over their penetration.

`gearfe.dynamics.machine.contact_law` contains the table of laws and describes how to add one.
"""
