"""
A phase portrait
================

One gear pair on its line of action, near resonance: displacement and velocity of the steady motion.
"""

import numpy as np

import gearfe as gf

phase = np.arange(64) / 64
k = gf.Samples(phase, 3.0e8 * (1 + 0.15 * np.cos(2 * np.pi * phase)))
machine = gf.single_mesh(0.5, k, 3500.0, force=2000.0, zeta=0.03)
response = gf.simulate(machine, 0.1)
late = response.time > 0.08
channel = response.names[0]
signal = gf.Signal(response[channel][late], rate=1 / response.time[1], unit="m", name=channel)
gf.plot_phase(gf.phase_portrait(signal), gf.poincare_section(signal, 3500.0), "m", "phase.png", "single mesh, near resonance")
