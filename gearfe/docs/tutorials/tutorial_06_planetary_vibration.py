"""
6. Vibration of a planetary gearbox
===================================

From the stiffness of a cracked tooth to the lines of a spectrum.
"""

# %%
# A machine from a scene
# ----------------------
# The scene ``compound_planetary`` describes a gearbox of two planetary stages, in which one tooth of a sun has a crack. A
# *machine* is a table of masses, springs and gear meshes; ``build_machine`` makes it, with the stiffness curves of all its pairs.

import gearfe as gf

scene = gf.load_scene("compound_planetary")
machines = {case or "healthy": gf.build_machine(scene, case=case) for case in (None, "crack50")}
machine = machines["crack50"]
print(f"{len(machine.dofs)} degrees of freedom, {len(machine.meshes)} gear meshes")
for stage in machine.stages:
    print(
        f"{stage.name}: mesh frequency {stage.mesh:.1f} Hz" + (f", fault frequency {stage.fault:.1f} Hz" if stage.fault else "")
    )

# %%
# Simulation
# ----------
# ``simulate`` starts at rest under load. It chooses its step and estimates its error.

responses = {case: gf.simulate(each, 1.5) for case, each in machines.items()}
print(f"error estimate {responses['crack50'].stats['error']:.1e} of the range")
print(", ".join(responses["crack50"].names[:6]), "...")

# %%
# Spectra
# -------
# Each time the cracked tooth meshes with one of the three planets, the mesh stiffness drops and excites the sun. The spectrum of
# its acceleration then contains *sidebands*, lines around the mesh frequency at multiples of the fault frequency.

signals = {}
for case, response in responses.items():
    late = response.time > 0.5  # after the start-up transient
    signals[case] = gf.Signal(response["sun2.theta acceleration"][late], rate=1 / response.time[1], unit="rad/s^2")
spectra = {case: gf.spectrum(signal) for case, signal in signals.items()}
stage = machine.stages[-1]
lines = gf.expected_lines(stage.mesh, stage.fault, count=3)
gf.plot_spectra(spectra, lines, "spectra.png", title="compound_planetary, sun2.theta acceleration")

# %%
for name in ("f_m", "f_m - f_fault", "f_m + f_fault", "f_fault"):
    healthy, cracked = (gf.find_lines(found, lines)[name][1] for found in spectra.values())
    print(f"{name:14s} healthy {healthy:8.5f}   crack {cracked:8.5f} rad/s^2")

# %%
# The force of a single mesh, ``response["force sun2_b1"]``, drops only when the cracked tooth meets that planet. This is a third
# as often, so its sidebands are three times as dense.
#
# Natural frequencies
# -------------------
# With every mesh at its mean stiffness:

frequencies = gf.natural_frequencies(machine)[0]
print(", ".join(f"{f:.0f}" for f in frequencies[frequencies > 1][:8]), "Hz")
