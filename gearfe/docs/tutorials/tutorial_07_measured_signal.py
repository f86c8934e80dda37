"""
7. Reading a measured signal
============================

Units, spectra, orders, envelope and kurtogram of a signal from a file.
"""

# %%
# A file
# ------
# A synthetic signal replaces the measurement. It has two gears at 480 Hz, a damaged tooth with 20 impacts per second that excite
# a housing resonance at 6 kHz, and noise. The header of the file states the units, because gearfe never guesses them.

import numpy as np

import gearfe as gf

rate, fault, mesh = 25600.0, 20.0, 480.0
time = np.arange(int(4 * rate)) / rate
since = np.mod(time, 1 / fault)  # time since the last knock
knocks = 3.0 * np.exp(-800 * since) * np.sin(2 * np.pi * 6000 * since)
noise = np.random.default_rng(1).standard_normal(time.size)
acceleration = 2.0 * np.sin(2 * np.pi * mesh * time) + knocks + 0.5 * noise
table = np.transpose([time, acceleration])
np.savetxt("measured.csv", table, delimiter=",", header="time [s], housing [m/s^2]", fmt="%.9g")

signal = gf.read_signal("measured.csv")
print(f"{signal.name}: {signal.duration:.1f} s at {signal.rate:.0f} Hz in {signal.unit}")

# %%
# The spectrum shows the gears
# ----------------------------
# The impacts are hardly visible, because their energy is distributed over many lines.

found = gf.spectrum(signal)
for name, (frequency, amplitude) in gf.find_lines(found, gf.expected_lines(mesh, fault, count=1)).items():
    print(f"{name:14s} {frequency:6.1f} Hz {amplitude:7.4f} {signal.unit}")

# %%
# The kurtogram finds the band of the impacts
# -------------------------------------------
# The *kurtosis* of a band is large if its signal is impulsive. A frame marks the band with the largest kurtosis.

kurtogram = gf.fast_kurtogram(signal, levels=5)
print(f"best band {kurtogram.band[0]:.0f} to {kurtogram.band[1]:.0f} Hz")
gf.plot_kurtogram(kurtogram, "kurtogram.png")

# %%
# The envelope in that band repeats with the fault
# ------------------------------------------------
# ``demodulate`` selects this band, squares the envelope, and compares the lines at the fault frequency with adjacent lines.

print(gf.demodulate(signal, fault).text())

# %%
# Time synchronous average
# ------------------------
# If the shaft speed is known, the mean over its revolutions keeps what repeats with the shaft and suppresses everything else.

turning = gf.Signal(signal.values, signal.rate, signal.unit, shaft_frequency=fault)
average, turns = gf.synchronous_average(turning)
left = gf.residual_signal(average, teeth=int(mesh / fault))
place = abs(left).argmax() / left.size
print(f"{turns} turns averaged; what a healthy gear would not show is largest at {place:.3f} of a turn")

# %%
# The command ``gearfe signal measured.csv --mesh 480 --fault 20 --kurtogram k.png`` prints the same lines and all indicators.
