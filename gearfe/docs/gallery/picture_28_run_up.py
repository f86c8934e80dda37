"""
A run-up
========

The mesh and its harmonics climb through the natural frequency of 6.7 kHz, and each is loud where it crosses it.
"""

import numpy as np

import gearfe as gf

phase = np.arange(64) / 64
k = gf.Samples(phase, 3.5e8 * (1 + 0.15 * np.cos(2 * np.pi * phase) + 0.05 * np.cos(4 * np.pi * phase)))
machine = gf.single_mesh(0.2, k, 5000.0, force=2000.0, zeta=0.03)
response = gf.simulate(gf.with_speed(machine, [0.0, 1.0], [0.2, 1.6]), 1.0, rate=102400.0)
signal = gf.Signal(response["pair.x acceleration"], 102400.0, "m/s^2", name="acceleration")
gf.plot_spectrogram(gf.spectrogram(gf.decimate(signal, 32000.0)), "run_up.png", "mesh frequency from 1000 to 8000 Hz")
