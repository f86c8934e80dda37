"""Common records of the stage of S0 and S1 for the page `planetary_pitting`, with pits by the formula of S0."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import Draw, changed, noise
from ..shared.simulated import amplitude, knocked, machine, record, scene, signal, spectrum
from .planetary_numbers import CASES, NAME, speeds

SECONDS, SETTLE = 10.0, 0.25
DRAWN, DRAWN_SETTLE = 1.0, 0.25  # [s] record and discarded start of a draw of the unprinted inputs
RATE = 10000.0  # [Hz] sampling rate of S0: 100 000 steps in 10 s
FINE = 256 * 280.0  # [Hz] more than twice the highest natural frequency, 16.5 kHz, and a multiple of the mesh frequency
OWN, ROWS, LINEAR, ALONE = "impact law", "impact law, rows of five", "linear stiffness", "linear stiffness, isolated pairs"
STEADY = ", no pulses"
CARRIER, FORCE, SENSOR, HOUSING = (
    "carrier.theta acceleration",
    "force sun_planet1",
    "ring.y acceleration",
    "ring's forces through its window",
)
BEARING = 1e8  # bearing stiffness of the ring [N/m], the default of `gf.pitted_planetary`
HIGHEST = 6  # harmonics of the fault frequency in the bandwidth


@cache
def _built(case, impact, layout):
    """Return the machine with the impact law. Its torque pulses are those of the scene times `impact`."""
    own, case = scene(NAME), f"{case}_rows" if case and layout == ROWS else case
    options = own.machine["impact"] | {"pulse_Nm": impact * own.machine["impact"]["pulse_Nm"]}
    if not impact:
        options = {key: value for key, value in options.items() if not key.startswith("pulse")}
    return gf.build_machine(replace(own, machine=own.machine | {"contact": "impact", "impact": options}), case)


@cache
def linear(case, law=LINEAR):
    """Return the machine with linear stiffness curves, of the whole set or of isolated pairs."""
    return gf.build_machine(replace(scene(NAME), set=None), case, method="ritz3d") if law == ALONE else machine(NAME, case)


@cache
def record_of(case, impact, law=OWN):
    """Response of a case, with the pulses on the carrier scaled by a factor. A `Draw` changes the machine."""
    name = None if case == "healthy" else case
    if isinstance(law, Draw):
        return record(changed(_built(name, float(impact), OWN), law), DRAWN, RATE, DRAWN_SETTLE)
    if law not in (LINEAR, ALONE):
        return record(_built(name, float(impact), law), SECONDS, RATE, SETTLE)
    made = linear(name, law)
    options = scene(NAME).machine["impact"]
    made = knocked(made, "carrier torque", options, SECONDS + SETTLE) if impact else made
    return record(made, SECONDS, RATE, SETTLE)


@cache
def finer(case, law=OWN):
    """Return force amplitudes without pulses, sampled fast enough to avoid aliasing, over whole periods of the lines."""
    name = None if case == "healthy" else case
    made = linear(name, law) if law in (LINEAR, ALONE) else _built(name, 0.0, law)
    return spectrum(signal(record(made, 0.3, FINE, SETTLE), FORCE))


def ring_path(foundation=1.0):
    """Return the window of a sensor on the ring: a thin ring between root circle and rim on an elastic foundation."""
    ring = scene(NAME).pairs["planet_ring"].pair.gear_2
    thick, radius = 1e-3 * (ring.r_rim - ring.r_f), 5e-4 * (ring.r_rim + ring.r_f)
    bending = 1e6 * scene(NAME).pairs["planet_ring"].materials[1].E * 1e-3 * ring.b * thick**3 / 12
    return gf.ring_window(radius, bending, foundation * BEARING / (np.pi * radius))


@cache
def signal_of(case, impact, channel=FORCE, law=OWN):
    """Return a channel. A draw adds noise, relative to the standard deviation of the mild case without pulses."""
    one = _clean(case, impact, channel, law)
    if not isinstance(law, Draw):
        return one
    size = law["noise"] * _clean("mild", False, channel, law).values.std()
    return replace(one, values=one.values + size * noise(law, f"{case} {impact} {channel}", one.values.size))


@cache
def _clean(case, impact, channel, law):
    response = record_of(case, impact, law)
    if channel == HOUSING:
        return gf.housing_signal(response, window=ring_path(law["path"] if isinstance(law, Draw) else 1.0))
    return signal(response, channel)


@cache
def values_of(case, impact, channel=FORCE, law=OWN):
    """Return the indicators of a channel."""
    return signal_of(case, impact, channel, law).indicators(*speeds()[2:])


@cache
def spectrum_of(case, impact, channel=FORCE, law=OWN):
    """Return the amplitudes of a channel."""
    return spectrum(signal_of(case, impact, channel, law))


def sidebands_of(case, law=OWN, channel=FORCE):
    """Return the mean amplitude at f_m +- f_fault without pulses."""
    mesh, fault = speeds()[2:]
    found = spectrum_of(case, False, channel, law)
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


def bandwidth_of(case, law=OWN, channel=FORCE):
    """Return the sideband bandwidth about f_m without pulses [Hz]: RMS distance of lines, weighted with their power."""
    mesh, fault = speeds()[2:]
    found = spectrum_of(case, False, channel, law)
    order = np.array([k for k in range(-HIGHEST, HIGHEST + 1) if k])
    power = np.array([amplitude(found, mesh + k * fault) ** 2 for k in order])
    return float(fault * np.sqrt((power * order**2).sum() / power.sum()))


def standing_out(case, law=OWN, channel=FORCE):
    """Return the largest deviation of the damaged tooth's mesh cycle over the median of the other teeth, without pulses."""
    mesh, fault = speeds()[2:]
    teeth = scene(NAME).gears["sun"].z
    # [mesh cycles] one revolution of the sun for one mesh, or the period over all planets
    period = teeth if channel == FORCE else round(mesh / fault)
    x = signal_of(case, False, channel, law).values
    turn = round(RATE * period / mesh)
    folded = np.abs(x - x.mean())[: x.size // turn * turn].reshape(-1, turn).mean(axis=0)
    cycle = [part.max() for part in np.array_split(folded, period)]
    return float(max(cycle) / np.median(cycle))


def rises(quantity):
    """Return whether a quantity rises with each level of damage, by more than 0.1 %."""
    found = [quantity(case) for case in CASES]
    return all(b > 1.001 * a for a, b in zip(found, found[1:], strict=False))


def forget():
    """Clear the caches of input draws."""
    for one in (record_of, signal_of, _clean, values_of, spectrum_of):
        one.cache_clear()
