"""Records of machines and planetary sets that cannot be: each is refused where it is made, by a message with its name."""

import math
from dataclasses import replace

import numpy as np
import pytest
from dynamics.test_models import PAIRS
from planetary_sets.sets import STEEL, case, gears, unequal

import gearfe as gf

pytestmark = pytest.mark.quick
NAN, INF = math.nan, math.inf
NO_NUMBER = NAN, INF, "1", 1j
NEGATIVE = *NO_NUMBER, -1.0
NOT_POSITIVE = *NEGATIVE, 0.0
ROW, K = np.ones(1), {"sun_planet": 3e8, "planet_ring": 4e8}
CENTRAL = gf.Member(1.0, 1e-3, 1e8, 0.03)
LOADED = gf.mesh_stiffness(gears().sun_planet, [500.0, 1000.0], STEEL, method="textbook", phases=4)
FRICTION = {"static": 0.08, "dynamic": 0.05, "v_static": 1e-4, "v_dynamic": 1e-2}


def layout(*bodies):
    return gf.Layout(bodies or (gf.Body("one", 1.0, 1e-3), gf.Body("two", 2.0, 4e-3)))


def row(one="one", two="two", **other):
    return layout().mesh(one, two, **{"angle": 0.0, "alpha": 0.35, "radii": (0.04, 0.08)} | other)


def mesh(stiffness=1e8, frequency=100.0, **other):
    return gf.GearMesh("m", ROW, stiffness, frequency, **other)


def stage(n=3, sun=CENTRAL, **other):
    return gf.planetary(sun, CENTRAL, CENTRAL, CENTRAL, **{"n_planets": n, "alpha": (0.35, 0.35), "stiffness": K} | other)


def phases(n=3, **other):
    return gf.stage_phases((gears().sun_planet, gears().planet_ring), n, **other)


def pitted(**other):
    return gf.pitted_planetary(gears(), K, **other)


def herringbone(**other):
    return gf.herringbone_planetary(gears(), K, **other)


def compound(**other):
    return gf.compound_planetary(dict.fromkeys(PAIRS, 1e9), pairs=PAIRS, **other)


def pair(**other):
    drive = {"speed": 100.0, "torque": 10.0, "support": {"x": 1e8, "y": 1e8}} | other
    return gf.gear_pair_machine(gears().sun_planet, (gf.Body("one", 1.0, 1e-3), gf.Body("two", 2.0, 4e-3)), 1e8, **drive)


def run(**other):
    machine = gf.single_mesh(1.0, 1e8, 500.0, force=10.0)
    return gf.simulate(machine, **{"duration": 0.01, "rate": 2e4} | other)


RECORDS = {
    "body": [
        (lambda v: gf.Body(v, 1.0, 1.0), ("", "a,b", "a b", "a.x", None, 5)),
        (lambda v: gf.Body("one", v, 1.0), NOT_POSITIVE),
        (lambda v: gf.Body("one", 1.0, v), NOT_POSITIVE),
        (lambda v: gf.Body("one", 1.0, 1.0, v), ("", "x x", "w", "theta x theta", 5)),
        (lambda v: gf.Body("one", 1.0, 1.0, "tilt_x", v), NOT_POSITIVE),
    ],
    "bod": [
        (lambda v: layout(*v), ((gf.Body("one", 1.0, 1.0), gf.Body("one", 2.0, 1.0)),)),
        (lambda v: layout().point(v, (1.0, 0.0)), ("three", None)),
        (lambda v: row("one", v), ("one", "three")),
    ],
    "freedom": [(lambda v: layout().unit("one", v), ("z", "", None))],
    "stiffness": [
        (lambda v: layout().springs("one", None, {"x": v}, 0.02), NEGATIVE),
        (mesh, ("1e8", -1.0, NAN, INF, None, [1e8, NAN], np.ma.masked_array([1e8, 2e8], [0, 1]), 1j)),
    ],
    "direction": [(lambda v: layout().springs("one", None, {v: 1e8}, 0.02), ("w", 3))],
    "zeta": [
        (lambda v: layout().springs("one", None, {"x": 1e8}, v), NEGATIVE),
        (lambda v: mesh(zeta=v), NEGATIVE),
    ],
    "alpha": [
        (lambda v: row(alpha=v), (20.0, 0.0, -0.35, NAN, "20")),
        (lambda v: stage(alpha=(v, v)), (90.0, math.pi / 2)),
    ],
    "angle": [(lambda v: row(angle=v), NO_NUMBER)],
    "sense": [(lambda v: row(sense=v), (5, 0, "1"))],
    "radii": [(lambda v: row(radii=(v, 0.08)), NOT_POSITIVE)],
    "teeth": [(lambda v: mesh(teeth=v), ((0, 0), (21.5, 31), None, (21,), (21, -3), ("21", 31), 21))],
    "first": [(lambda v: mesh(first=v), ((NAN, 0), (0.5, 0), None, 0))],
    "push": [(lambda v: mesh(push=v), ("no", 1, None))],
    "frequency": [
        (lambda v: mesh(frequency=v), NO_NUMBER),
        (lambda v: phases(frequency=v), NO_NUMBER),
        (lambda v: gf.Stage("one", ("a",), ("b",), v, 1.0), NEGATIVE),
    ],
    "phase": [(lambda v: mesh(phase=v), NO_NUMBER)],
    "backlash": [(lambda v: mesh(backlash=v), (-1e-6, NAN, "0"))],
    "film": [(lambda v: mesh(film=v), (-0.5, 1.5, NAN))],
    "error": [
        (lambda v: mesh(error=v), (((1.0, NAN, 0.0),), ((1e-6, 5.0),), (("1", 5.0, 0.0),))),
        (lambda v: run(error=v), ("no", 1)),
    ],
    "damage": [
        (lambda v: mesh(damage=v), ((1,), ("crack",))),
        (lambda v: gf.ToothDamage(v, 0, gf.Samples(np.arange(3.0), np.ones(3))), (2, -1, True, "0")),
        (lambda v: gf.ToothDamage(0, v, gf.Samples(np.arange(3.0), np.ones(3))), (0.5, NAN, None, "0")),
    ],
    "spring": [
        (lambda v: gf.Spring("s", ROW, v), NEGATIVE),
        (lambda v: gf.Spring("s", ROW, 1.0, v), NEGATIVE),
        (lambda v: gf.Spring(v, ROW, 1.0), ("", None)),
        (lambda v: gf.Spring("s", v, 1.0), ([NAN], [[1.0]], "1", np.ma.masked_array([1.0], [1]))),
    ],
    "load": [
        (
            lambda v: gf.Load("l", ROW, v),
            (NAN, INF, "1", None, ([0.0, 1.0], [1.0]), ([1.0, 0.0], [1.0, 1.0]), ([], []), (1, 2, 3)),
        ),
        (lambda v: gf.Load("l", ROW, ([0.0, 1.0], v)), ([1.0, NAN], ["a", "b"], np.ma.masked_array([1.0, 2.0], [0, 1]))),
    ],
    "mass": [
        (lambda v: gf.single_mesh(v, 1e8, 500.0), NOT_POSITIVE),
        (lambda v: gf.Member(v, 1.0, 1e8, 0.03), NOT_POSITIVE),
    ],
    "inertia": [(lambda v: gf.Member(1.0, v, 1e8, 0.03), NOT_POSITIVE)],
    "bearing|stiffness|tilt|housing|support": [
        (lambda v: gf.Member(1.0, 1.0, v, 0.03), NEGATIVE),
        (lambda v: pitted(bearing=v), NEGATIVE),
        (lambda v: herringbone(bearing=v), NEGATIVE),
        (lambda v: compound(bearing=v), NEGATIVE),
        (lambda v: herringbone(tilt=v), NEGATIVE),
        (lambda v: herringbone(housing=v), NEGATIVE),
        (lambda v: pair(support={"x": v}), NEGATIVE),
    ],
    "torsion|stiffness|drive|hold": [
        (lambda v: gf.Member(1.0, 1.0, 1e8, 0.03, v), NEGATIVE),
        (lambda v: pitted(drive=v), NEGATIVE),
        (lambda v: herringbone(drive=v), NEGATIVE),
        (lambda v: compound(hold=v), NEGATIVE),
    ],
    "r_b": [(lambda v: gf.Member(1.0, 1.0, 1e8, v), NOT_POSITIVE)],
    "width": [
        (lambda v: gf.gear_member(gears().sun, 7800.0, 0.0, width=v), NOT_POSITIVE),
        (lambda v: gf.RimSupports(3, v), NOT_POSITIVE),
    ],
    "density": [
        (lambda v: gf.gear_member(gears().sun, v, 0.0), NOT_POSITIVE),
        (lambda v: pitted(density=v), NOT_POSITIVE),
        (lambda v: herringbone(density=v), NOT_POSITIVE),
    ],
    "n_planets": [(stage, (0, -2, 2.5, NAN, True, "3")), (phases, (0, -2, 2.5, NAN))],
    "planet_angles": [
        (lambda v: stage(planet_angles=v), ([0.0, 0.0, 0.0], [0.0, 1.0], [0.0, NAN, 2.0], "abc")),
        (lambda v: phases(2, planet_angles=v), ([0.0, NAN], [0.0])),
    ],
    "start": [
        (lambda v: phases(start=v), NO_NUMBER),
        (lambda v: run(start=v), (1e300, NAN, "0")),
        (lambda v: gf.pulses(0.0, 1.0, 1.0, 0.1, 3, start=v), NO_NUMBER),
    ],
    "friction": [
        (lambda v: pitted(friction=FRICTION | {"static": v}), NEGATIVE),
        (lambda v: pitted(friction=FRICTION | {"v_static": v}), (0.0, NAN, 1.0)),
    ],
    "torque|load": [(lambda v: pitted(torque=v), NO_NUMBER), (lambda v: herringbone(torque=v), NO_NUMBER)],
    "speed|frequency|spin": [(lambda v: pitted(speed=v), NO_NUMBER), (lambda v: compound(speed=v), NO_NUMBER)],
    "base|peak|period|width": [
        (lambda v: gf.pulses(v, 1.0, 1.0, 0.1, 3), NO_NUMBER),
        (lambda v: gf.pulses(0.0, 1.0, v, 0.1, 3), NOT_POSITIVE),
    ],
    "count": [
        (lambda v: gf.pulses(0.0, 1.0, 1.0, 0.1, v), (0, 2.5, NAN, "3")),
        (lambda v: gf.RimSupports(v, 5.0), (0, 10**9, 2.5, "6")),
    ],
    "first|rad": [(lambda v: gf.RimSupports(6, 5.0, first=v), (1e20, NAN, INF, "0"))],
    "duration": [(lambda v: run(duration=v), (0.0, -1.0, NAN, INF, "1", None, 10**400))],
    "rate|step": [
        (lambda v: run(rate=v), NOT_POSITIVE),
        (lambda v: run(step=v), (1e-300, 0.0, NAN, "1")),
    ],
    "planet": [
        (lambda v: case(flanks={v: gf.Flank()}), ("planet0", "planet4", "planets", ("planet", 3))),
        (
            lambda v: case(flanks={"planet3": gf.Flank(pitch=[0.001] + [0.0] * 30)}).with_(planet_angles=v),
            ([0.0, 2 * math.pi / 3],),
        ),
    ],
    "flanks|damage": [(lambda v: case(flanks={"planet": v}), (True, None, "Flank"))],
    "crack": [(lambda v: case(damage={"sun": v}), ([gf.Crack(level=0.6), gf.Crack(level=0.6, side="unloaded")],))],
    "harmonics": [(lambda v: gf.campbell(gf.single_mesh(1.0, 1e8, 500.0), [0.5, 4.0], harmonics=v), (0, 2.5, 10**7, "3"))],
    "force": [(lambda v: gf.ForceLaw.of(LOADED, v), (-7.5, 0.0, NAN))],
    "shape|rise": [(lambda v: replace(gf.ForceLaw.of(LOADED), phase=v), (np.arange(4.0)[:, None, None], np.arange(3.0)))],
    "end_length": [(lambda v: gf.Flank(end_length=v), (-7.5, (1.0, -1.0), NAN))],
    "other": [
        (lambda v: stage(stiffness=v), (K | {"other": 1e8},)),
        (lambda v: gf.pitted_planetary(gears(), v), (K | {"other": 1e8},)),
        (lambda v: gf.herringbone_planetary(gears(), v), (K | {"other": 1e8},)),
        (lambda v: gf.compound_planetary(v, pairs=PAIRS), (dict.fromkeys([*PAIRS, "other"], 1e9),)),
        (lambda v: pitted(friction=v), (FRICTION | {"other": 1.0},)),
    ],
    "pin": [(lambda v: case(pin=v), (0.0, -1.0, NAN, "1e5"))],
}
INPUTS = [(name, build, value) for name, rows in RECORDS.items() for build, values in rows for value in values]


@pytest.mark.parametrize(("name", "build", "value"), INPUTS, ids=[f"{name}-{i}" for i, (name, *_) in enumerate(INPUTS)])
def test_what_cannot_be_is_refused_by_name(name, build, value):
    with pytest.raises(ValueError, match=f"(?i){name}") as caught:
        build(value)
    assert len(str(caught.value)) > 15


@pytest.mark.parametrize(("force", "pin"), [(3e5, INF), (2000.0, 1e-3), (2000.0, 300.0)])
def test_sets_beyond_small_displacements_are_refused(force, pin):
    made = case(pin=pin, floating=True).with_(force=force)
    with pytest.raises(ValueError, match="small displacements"):
        gf.planetary_stiffness(made, 1, refine=0.4, error=False)


def test_gears_with_another_number_of_planets_stand_equally_spaced():
    assert case().with_(gears=gears(1)).planets == 1
    assert unequal(0, 34, 71).with_(force=1000.0).planet_angles == unequal(0, 34, 71).planet_angles


@pytest.mark.slow
def test_numbers_of_other_types_run_as_floats():
    plain, single = (run(duration=number(0.0078125)) for number in (float, np.float32))
    assert single.time.dtype == plain.time.dtype
    assert len(single.time) == len(plain.time)


@pytest.mark.parametrize("force", [[-0.5], "x", math.nan, -1.0])
def test_a_copy_of_a_result_is_checked_too(force):
    """The record class is loaded only by the user, but its copies come from `dataclasses.replace`."""
    law = gf.force_law(gears().sun_planet, [500.0, 1000.0], STEEL, method="textbook", phases=8)
    with pytest.raises(ValueError, match="force"):
        replace(law, force=force)


def test_pulses_that_do_not_fit_into_memory_are_rejected():
    with pytest.raises(ValueError, match=r"count = 1000000000000 needs about .* GB, but .* GB are free: give fewer pulses"):
        gf.pulses(base=0.0, peak=1.0, period=1.0, width=0.1, count=10**12)
