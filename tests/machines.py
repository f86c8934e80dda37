"""Machines that several tests share."""

import math

import numpy as np

import gearfe as gf
from gearfe.dynamics.machine.gear_mesh import GearMesh
from gearfe.dynamics.machine.herringbone_planetary import herringbone_planetary
from gearfe.dynamics.machine.loads import Load
from gearfe.dynamics.machine.mesh_curves import Samples, cycle_table
from gearfe.dynamics.machine.springs import Spring
from gearfe.dynamics.machine.tables import Machine
from gearfe.dynamics.motion.run_differences import differences, seen

WAVE = 1e8 * (1 + 0.2 * np.cos(2 * math.pi * np.arange(64) / 64))

SHAPE = 1 + 0.15 * np.cos(2 * math.pi * np.arange(64) / 64) + 0.05 * np.sin(4 * math.pi * np.arange(64) / 64)
STEEL = gf.Material(E=207e3, nu=0.25)


def two_masses(c=10.0, zeta=0.03, stiffness=WAVE, load=1000.0, **mesh):
    one = GearMesh("m", np.array([1.0, -1.0]), stiffness, frequency=500.0, zeta=zeta, **mesh)
    ground = Spring("ground", np.array([0.0, 1.0]), 5e7, c)
    return Machine(("a.x", "b.x"), np.array([1.0, 2.0]), (ground,), (one,), (Load("F", np.array([1.0, 0.0]), load),))


def stepped(machine, duration, dt, every=1, **options):
    """Simulate with a step of about `dt` that divides the duration, and keep every n-th state, unfiltered."""
    count = math.ceil(duration / dt / every * (1 - 1e-12))
    return gf.simulate(machine, duration, rate=count / duration, step=duration / count / every, filtered=False, **options)


def worst(got, want):
    """Largest error of a displacement over its range."""
    return (np.abs(got.q - want.q).max(axis=0) / np.ptp(want.q, axis=0)).max()


def difference(one, two):
    """Largest differences of the displacements and of the mesh forces of two runs, over their ranges."""
    return differences(seen(one), seen(two), two.machine)[:2]


def tooth(wave, loss, eps):
    """A damaged tooth's curve: the healthy wave less a smooth dip over its engagement."""
    phase = np.arange(-16, math.ceil((eps + 0.25) * 64) + 1) / 64
    dip = np.where((phase > 0) & (phase < eps), np.sin(np.pi * np.clip(phase / eps, 0, 1)) ** 2, 0.0)
    return Samples(phase, cycle_table(wave)(phase % 1.0) * (1 - loss * dip))


def herringbone(stage, damage=None, **options):
    stiffness = {"sun_planet": 6e8 * SHAPE, "planet_ring": 7e8 * SHAPE}
    options = {"members": gf.load_scene("herringbone").machine["bodies"]} | options
    return herringbone_planetary(stage, stiffness, damage=damage, **options)


def lines(response, name, base, orders):
    """Amplitudes of a steady channel at multiples of `base`, over whole periods."""
    x = response[name][:-1]
    spectrum = np.abs(np.fft.rfft(x)) * 2 / x.size
    step = 1 / response.time[-1]
    return spectrum[[round(base * k / step) for k in orders]]
