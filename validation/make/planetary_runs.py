"""Common records of the stage of S0 and S1 for the page `planetary_pitting`, with pits by the formula of S0."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import adding, changed
from ..shared.simulated import Heard, record, scene, signal, spectrum
from .planetary_numbers import CASES, NAME, speeds

SECONDS, SETTLE = 10.0, 0.25
DRAWN, DRAWN_SETTLE = 1.0, 0.25  # [s] record and discarded start of a draw of the unprinted inputs
RATE = 10000.0  # [Hz] sampling rate of S0: 100 000 steps in 10 s
FINE = 256 * 280.0  # [Hz] more than twice the highest natural frequency, 16.5 kHz, and a multiple of the mesh frequency
CARRIER, FORCE, SENSOR, HOUSING = (
    "carrier.theta acceleration",
    "force sun_planet1",
    "ring.y acceleration",
    "ring's forces through its window",
)
BEARING = 1e8  # bearing stiffness of the ring [N/m], the default of `gf.pitted_planetary`
HIGHEST = 6  # harmonics of the fault frequency in the bandwidth


@cache
def _built(case, impact):
    """Return the machine with the impact law. Its torque pulses are those of the scene times `impact`."""
    own, case = scene(NAME), None if case == "healthy" else case
    options = own.machine["impact"] | {"pulse_Nm": impact * own.machine["impact"]["pulse_Nm"]}
    if not impact:
        options = {key: value for key, value in options.items() if not key.startswith("pulse")}
    return gf.build_machine(replace(own, machine=own.machine | {"contact": "impact", "impact": options}), case)


def recorded(draw=None):
    """Return the response as a function of a case and a factor of the pulses on the carrier. A draw changes the machine."""
    if draw is None:
        return cache(lambda key: record(_built(key[0], float(key[1])), SECONDS, RATE, SETTLE))
    return cache(lambda key: record(changed(_built(key[0], float(key[1])), draw), DRAWN, RATE, DRAWN_SETTLE))


@cache
def finer(case):
    """Return force amplitudes without pulses, sampled fast enough to avoid aliasing, over whole periods of the lines."""
    return spectrum(signal(record(_built(case, 0.0), 0.3, FINE, SETTLE), FORCE))


def ring_path(foundation=1.0):
    """Return the window of a sensor on the ring: a thin ring between root circle and rim on an elastic foundation."""
    ring = scene(NAME).pairs["planet_ring"].pair.gear_2
    thick, radius = 1e-3 * (ring.r_rim - ring.r_f), 5e-4 * (ring.r_rim + ring.r_f)
    bending = 1e6 * scene(NAME).pairs["planet_ring"].materials[1].E * 1e-3 * ring.b * thick**3 / 12
    return gf.ring_window(radius, bending, foundation * BEARING / (np.pi * radius))


class Machine:
    """Channels of the machine by name, as `Heard` of (case, factor of the pulses), of the scene or with the inputs of a draw."""

    def __init__(self, draw=None):
        """Keep the responses, which all channels share."""
        self.records, self.channel = recorded(draw), cache(self._channel)
        self.draw, self.values = draw, cache(self._values)

    def _channel(self, channel):
        def through(response):
            if channel == HOUSING:
                return gf.housing_signal(response, window=ring_path(1.0 if self.draw is None else self.draw["path"]))
            return signal(response, channel)

        return Heard(self.records, through, adding(self.draw, channel), ("mild", False))

    def _values(self, case, impact, channel=FORCE):
        """Return the indicators of a channel."""
        return self.channel(channel)((case, impact)).indicators(*speeds()[2:])


OWN = Machine()


def sidebands_of(case, heard):
    """Return the mean amplitude at f_m +- f_fault without pulses."""
    return heard.sidebands((case, False), *speeds()[2:])


def bandwidth_of(case, heard):
    """Return the sideband bandwidth about f_m without pulses [Hz]: RMS distance of lines, weighted with their power."""
    mesh, fault = speeds()[2:]
    order = np.array([k for k in range(-HIGHEST, HIGHEST + 1) if k])
    power = np.array([heard.line((case, False), mesh + k * fault) ** 2 for k in order])
    return float(fault * np.sqrt((power * order**2).sum() / power.sum()))


def standing_out(case, heard, *, force):
    """Return the largest deviation of the damaged tooth's mesh cycle over the median of the other teeth, without pulses."""
    mesh, fault = speeds()[2:]
    # [mesh cycles] one revolution of the sun for the force of one mesh, or the period over all planets
    period = scene(NAME).gears["sun"].z if force else round(mesh / fault)
    x = heard((case, False)).values
    turn = round(RATE * period / mesh)
    folded = np.abs(x - x.mean())[: x.size // turn * turn].reshape(-1, turn).mean(axis=0)
    cycle = [part.max() for part in np.array_split(folded, period)]
    return float(max(cycle) / np.median(cycle))


def rises(quantity):
    """Return whether a quantity rises with each level of damage, by more than 0.1 %."""
    found = [quantity(case) for case in CASES]
    return all(b > 1.001 * a for a, b in zip(found, found[1:], strict=False))
