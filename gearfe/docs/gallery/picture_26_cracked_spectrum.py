"""
Spectrum of a cracked tooth
===========================

The cracked tooth meshes once per revolution. Sidebands at the distance of the shaft frequency appear around the mesh
harmonics. The rate is a hundred times the mesh frequency, so that what folds falls on its multiples.
"""

from math import radians

import gearfe as gf

rack, steel = dict(m_n=2.0, alpha_n=radians(20), b=20.0), gf.Material(E=206e3, nu=0.3)
pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
curve = gf.mesh_stiffness(pair, 2000.0, steel)
cracked = gf.mesh_stiffness(pair, 2000.0, steel, span="tooth", damage={"pinion": [gf.Crack(level=0.5)]})
spectra = {}
for name, damage in {"healthy": (), "crack 50 %": (gf.ToothDamage(body=0, tooth=0, curve=cracked),)}.items():
    machine = gf.single_mesh(0.2, curve, 1050.0, force=2000.0, zeta=0.07, teeth=(21, 31), damage=damage)
    response = gf.simulate(machine, 0.45, rate=105000.0)
    late = response.time > 0.05
    spectra[name] = gf.spectrum(gf.Signal(response["pair.x acceleration"][late], 105000.0, "m/s^2"))
lines = gf.expected_lines(1050.0, 50.0, count=2)
gf.plot_spectra(spectra, lines, "spectrum.png", top=2500, title="21/31 teeth, 50 turns of the pinion per second")
