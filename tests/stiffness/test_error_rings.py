"""The energy model's estimate covers its error at every phase of ring pairs, where tip corners slide over hats."""

import math
import warnings

import numpy as np
import pytest

import gearfe as gf

STEEL = gf.Material(E=206e3, nu=0.3)


@pytest.fixture(autouse=True)
def discretisation_alone(monkeypatch):
    """What the model of contact may be off is in every estimate, too; here it is left out of it."""
    monkeypatch.setattr("gearfe.stiffness.section_curves.MODEL", 0.0)
    monkeypatch.setattr(
        "gearfe.contact.pair_contact.left_out", lambda contact, line, closing, beyond, shut: np.zeros(closing.size)
    )


def ring_pair(seed):
    """A random ring pair, a load, and damage."""
    rng = np.random.default_rng(seed)
    rack = {
        "m_n": float(rng.choice([1.0, 2.0, 3.5])),
        "alpha_n": math.radians(rng.choice([17.5, 20, 22.5, 25])),
        "b": 10.0,
        "rack_tip_radius": float(rng.choice([0.1, 0.2, 0.3])),
    }
    z = int(rng.integers(14, 50))
    more, x = int(rng.integers(18, 80)), float(rng.uniform(-0.2, 0.5))
    one = gf.Gear(z=z, x=x, r_bore=float(rng.uniform(0.3, 0.9)) * (z / 2 - 1.25 + x) * rack["m_n"], **rack)
    outside = ((z + more) / 2 + 1.25) * rack["m_n"]
    two = gf.Gear(z=z + more, x=x, r_rim=outside + float(rng.uniform(1.5, 8)) * rack["m_n"], **rack)
    force, damage = float(10 ** rng.uniform(0.7, 3)) * 10, None
    if rng.random() < 0.35:
        gear = str(rng.choice(["pinion", "wheel"]))
        level, angle = float(rng.uniform(0.05, 0.7)), math.radians(rng.uniform(30, 70))
        damage = {gear: [gf.Crack(level=level, angle=angle, start=str(rng.choice(["30deg", "middle"])))]}
    return gf.GearPair(one, two), force, damage


def errors(seed, fine, count=64):
    """Relative error against a solve with `fine` options, and its estimate, ``(2, n)``; none where there is no such pair."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        try:
            pair, force, damage = ring_pair(seed)
            n, cycles, start = (count, 1.0, 0.0) if damage is None else (count * 3 // 2, 3.5, -1.0)
            run = {"phases": start + cycles * (np.arange(n) + 0.37) / n, "damage": damage, "cache": False}
            curve = gf.mesh_stiffness(pair, force, STEEL, method="ritz", error=True, **run)
            truth = gf.mesh_stiffness(pair, force, STEEL, **({"method": "ritz"} | fine), **run)
        except ValueError:
            return np.zeros((2, 0))
    return np.array([np.abs(curve.k / truth.k - 1), curve.error / curve.k])


@pytest.mark.slow
@pytest.mark.parametrize("seed", [38, 59, 74, 129, 228])
def test_phases_at_which_it_was_short(seed):
    """Single phases of these pairs erred by up to 1.6 times the estimate from coarser solves alone (seeds it was tuned on)."""
    found, told = errors(seed, {"order": 6, "refine": 2.0})
    assert found.size
    assert (found < told).all()


def share_inside(seeds, fine, least, count=64):
    found, told = np.concatenate([errors(seed, fine, count) for seed in seeds], axis=1)
    print(
        f"{(found < told).sum()} of {found.size} phases inside, closest {np.max(found / told):.2f}, median {np.median(told):.2e}"
    )
    assert found.size >= least
    assert np.median(told) < 4e-3
    return np.mean(found < told)


@pytest.mark.slow
def test_other_ring_pairs():
    assert share_inside(range(1150, 1158), {"order": 6, "refine": 2.0}, 400) >= 0.99
