"""Every input drawn at random gives a result that keeps the invariants, or a ValueError that names the input.

Invariants: ``0 < k`` within the range of teeth, forces that add up, symmetry under exchange of the gears, nothing stiffer by
damage, continuity in the inputs, error estimates that cover the difference of methods.
"""

import math
import warnings

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from judge import unsound
from usual import STEEL

import gearfe as gf

KEPT = {"deadline": None, "database": None, "derandomize": True, "suppress_health_check": list(HealthCheck)}


ODD = st.sampled_from([math.nan, math.inf, -1.0, 0.0, 1e30, True, "1"])
WIDE = {"z": st.integers(5, 90), "x": st.floats(-0.6, 0.9), "bore": st.floats(0.3, 0.9), "b": st.floats(2.0, 60.0)}
WIDE |= {"addendum": st.floats(0.6, 1.2), "rack_tip_radius": st.floats(0.0, 0.5)}
GEARS = st.builds(  # gears of many kinds, some with one number that cannot be
    lambda own, spoilt, name, odd: own | ({name: odd} if spoilt > 8 else {}),
    st.fixed_dictionaries(WIDE), st.integers(0, 10), st.sampled_from([name for name in WIDE if name != "bore"]), ODD,
)  # fmt: skip
FORCES = st.builds(lambda own, spoilt, odd: odd if spoilt > 8 else own, st.floats(1e-3, 1e5), st.integers(0, 10), ODD)
SENSIBLE = st.fixed_dictionaries({"z": st.integers(14, 60), "x": st.floats(-0.2, 0.5), "bore": st.floats(0.3, 0.75)})


def gear(z, x, bore, b=20.0, alpha_n=0.35, addendum=1.0, rack_tip_radius=0.38):
    size = z if isinstance(z, int) else 20
    return gf.Gear(z, 2.0, alpha_n, b, bore * (size - 2.5), x=x, addendum=addendum, rack_tip_radius=rack_tip_radius)


def made(one, two):
    """A pair without its warnings, or None if there is no such pair."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return gf.GearPair(gear(**one), gear(**two))
        except ValueError as error:
            assert len(str(error)) > 20
            return None


def stiffness(pair, force, method, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        return gf.mesh_stiffness(pair, force, STEEL, method=method, **options)


def run(check, examples, **drawn):
    """Judge `check` on so many draws."""
    settings(max_examples=examples, **KEPT)(given(**drawn)(check))()


def test_any_gears_and_loads():
    """Of any two gears under any force: a sound curve, the same with the gears exchanged, or an error that says why."""
    told = {"answered": 0, "refused": 0}

    def check(one, two, force, phase):
        pair = made(one, two)
        if pair is None:
            told["refused"] += 1
            return
        try:
            curve = stiffness(pair, force, "textbook", phases=[phase])
        except ValueError as error:
            told["refused"] += 1
            assert "force" in str(error), str(error)
            return
        told["answered"] += 1
        assert not unsound(curve)
        end = pair.eps_alpha % 1.0
        assume(min(phase, 1 - phase, abs(phase - end)) > 1e-6)  # where a pair enters or leaves, one side of the jump is right
        swapped = stiffness(gf.GearPair(pair.gear_2, pair.gear_1, pair.a), force, "textbook", phases=[pair.eps_alpha - phase])
        np.testing.assert_allclose(swapped.k, curve.k, rtol=1e-9)

    run(check, 100, one=GEARS, two=GEARS, force=FORCES, phase=st.floats(0, 1))
    assert min(told.values()) > 5, told


def test_the_energy_model_keeps_its_invariants():
    """Exchange of the gears, a crack that softens, a slightly other input that changes little."""

    def check(one, two, force, phase, level, gap):
        pair = made(one, two)
        assume(pair is not None)
        options = {"method": "ritz", "phases": [phase]}
        try:
            curve = stiffness(pair, force, **options)
        except (ValueError, RuntimeError) as error:
            assert "force" in str(error) or "triangles" in str(error), str(error)
            return
        assert not unsound(curve)
        swapped = stiffness(gf.GearPair(pair.gear_2, pair.gear_1, pair.a), force, method="ritz", phases=[pair.eps_alpha - phase])
        np.testing.assert_allclose(swapped.k, curve.k, rtol=2e-3, err_msg="exchange")
        close = stiffness(pair, force * (1 + 1e-9), **options)
        np.testing.assert_allclose(close.k, curve.k, rtol=1e-6, err_msg="continuity in the force")
        hurt = [{"pinion": [gf.Crack(level=part)]} for part in (level, level + gap)]
        less, more = (stiffness(pair, force, damage=one, **options).k for one in hurt)
        assert (less < curve.k * 1.002).all(), "a crack softens"
        assert (more < less * 1.002).all(), "a deeper one more"

    run(check, 4, one=SENSIBLE, two=SENSIBLE, force=st.floats(10.0, 5000.0), phase=st.floats(0.05, 0.95),
        level=st.floats(0.1, 0.4), gap=st.floats(0.05, 0.3))  # fmt: skip


PAIR = made({"z": 21, "x": 0.0, "bore": 0.4}, {"z": 31, "x": 0.0, "bore": 0.4})
HEALTHY = {}


def test_pits_of_any_size_and_depth():
    """A pit of any depth lies between none and a deep one, and k falls with the depth without a jump."""
    options = {"method": "ritz3d", "phases": [0.5]}

    def check(radius, z, along, across, angle, depth):
        if not HEALTHY:
            HEALTHY["k"] = stiffness(PAIR, 2000.0, **options).k[0]
        depths = (1e-12, depth, depth * 1.001, 0.3)
        pits = [gf.Pit(radius, z, (along, across), one, angle) for one in depths]
        k = [stiffness(PAIR, 2000.0, damage={"pinion": [one]}, **options).k[0] for one in pits]
        assert abs(k[0] / HEALTHY["k"] - 1) < 5e-4, "a pit of no depth is none"
        assert (np.diff(k) < 2e-6 * k[0]).all(), k
        assert k[1] - k[2] < 1e-3 * k[1], "continuous in the depth"

    run(check, 3, radius=st.floats(20.0, 22.0), z=st.floats(0.0, 20.0), along=st.floats(0.05, 1.5),
        across=st.floats(0.05, 6.0), angle=st.floats(-1.5, 1.5), depth=st.floats(-5.0, -1.0).map(lambda p: 10**p))  # fmt: skip
