"""Cracks and pits in the closed forms: against independent quadrature, and in the limits."""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq

import gearfe as gf
from gearfe import hertz
from gearfe.energy import published, textbook
from gearfe.energy.beam import SAINSOT, Validity, load_angle
from gearfe.energy.plain_sum import plain_sum
from gearfe.energy.section import limits, section
from gearfe.energy.slices import faces
from geometry.damage import crack_path
from geometry.pit import centre_arc, lost_width, pit_row
from geometry.tooth import arc_at, cartesian, fillet, flank, form_point

STEEL = gf.Material(E=207e3, nu=0.3)
BOTH = (STEEL, STEEL)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
GEAR = gf.Gear(z=21, r_bore=7.4, **RACK)
PHASE = np.arange(-4, 30) / 16 + 0.003
MODELS = ("constant", "straight", "parabola")


@lru_cache
def pair(beta=0.0, b=20.0):
    rack = RACK | {"beta": beta, "b": b}
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))


def seven(**numbers):
    return pit_row(7, 2.0, 18.0, **{"radius": pair().pitch_radius_1, "axes": (1.0, 1.0), "depth": 0.2} | numbers)


def stiffness(*damage, on=None, formulas=textbook, load=100.0, phase=PHASE, **options):
    """K [N/mm per mm] with cracks and pits on the pinion."""
    cracks = tuple(d for d in damage if isinstance(d, gf.Crack))
    pits = tuple(d for d in damage if isinstance(d, gf.Pit))
    solve, _ = plain_sum(on or pair(), BOTH, phase, formulas, cracks=(cracks, ()), pits=(pits, ()), **options)
    return load / solve(load).approach


# --- the integrals


def by_quad(profiles, living, breaks, roll, integrand):
    """Integral over y of `integrand(y, area, inertia)` along profiles ``(curve, start, stop)``, numerical slopes."""
    total = 0.0
    for curve, start, stop in profiles:

        def f(t, curve=curve, h=1e-5 * (stop - start)):
            (x, y), far = curve(t), [curve(t + k * h)[1] for k in (-2, -1, 1, 2)]
            return integrand(y, *living(x, y, t)) * (far[0] - 8 * far[1] + 8 * far[2] - far[3]) / (12 * h)

        cuts = [start, stop]
        at = np.linspace(start, stop, 301)
        for switch in breaks:
            values = [switch(*curve(t)) for t in at]
            cuts += [
                brentq(lambda t, s=switch, c=curve: s(*c(t)), at[i], at[i + 1], xtol=1e-15)
                for i in range(300)
                if values[i] * values[i + 1] < 0
            ]
        cuts = sorted(cuts, reverse=stop < start)
        cuts = [c for c, last in zip(cuts, [math.inf, *cuts], strict=False) if abs(c - last) > 1e-12]
        total += sum(quad(f, a, b, epsabs=0, epsrel=1e-11, limit=400)[0] for a, b in zip(cuts, cuts[1:], strict=False))
    return total


def expected(gear, roll, profiles, living, breaks):
    """Bending, shear, axial of a section ``living(x, y, t) -> area, inertia, area without cracks``."""
    radius, angle = flank(gear, roll)
    x_f, y_f = radius * math.sin(angle), radius * math.cos(angle)
    beta = roll / gear.r_b - gear.base_half_angle
    arm = lambda y: math.cos(beta) * (y_f - y) - x_f * math.sin(beta)  # noqa: E731
    parts = (lambda y, a, i, u: arm(y) ** 2 / i, lambda y, a, i, u: 1 / a, lambda y, a, i, u: 1 / u)
    bending, area, whole = (by_quad(profiles, living, breaks, roll, part) for part in parts)
    return (
        bending / STEEL.E,
        1.2 * math.cos(beta) ** 2 * area / STEEL.shear_modulus,
        math.sin(beta) ** 2 * whole / STEEL.E,
    )


def on_flank(gear, low, roll):
    return lambda s: tuple(v for v in cartesian(*flank(gear, s))), low, roll


def true_profile(gear, roll):
    lower = (lambda p: tuple(cartesian(*fillet(gear, p))), math.pi / 2, form_point(gear)[0])
    return [lower, on_flank(gear, gear.roll_f, roll)]


def prism_profile(gear, roll):
    x = gear.r_b * math.sin(gear.base_half_angle)
    bottom, top = math.sqrt(gear.r_f**2 - x**2), gear.r_b * math.cos(gear.base_half_angle)
    return [(lambda y: (x, y), bottom, top), on_flank(gear, 1e-9, roll)]


def cut(model, tip, mouth, corner):
    """The living half thickness on the cracked side, and where its formula changes."""

    def curve(start, y):
        if model == "constant":
            return start[0]
        part = max(0.0, (y - start[1]) / (corner[1] - start[1]))
        return start[0] + (corner[0] - start[0]) * (part if model == "straight" else math.sqrt(part))

    def line(x, y):
        return curve(tip, y) + max(0.0, x - curve(mouth, y))

    breaks = [lambda x, y: y - mouth[1], lambda x, y: x - line(x, y), lambda x, y: x - curve(mouth, y)]
    return lambda x, y: min(x, line(x, y)) if y >= mouth[1] else x, breaks


@pytest.mark.parametrize(
    "crack", [gf.Crack(level=0.25), gf.Crack(level=0.6, turning=True), gf.Crack(length=0.7, side="unloaded")]
)
@pytest.mark.parametrize("model", MODELS)
def test_textbook_with_a_crack_equals_independent_quadrature(crack, model):
    roll = GEAR.roll_f + 0.7 * (GEAR.roll_a - GEAR.roll_f)
    path = crack_path(GEAR, crack) * [[1 if crack.side == "loaded" else -1], [1]]
    edge, breaks = cut(model, path[:, -1], path[:, 0], cartesian(*flank(GEAR, GEAR.roll_a)))

    def living(x, y, _):
        area = x + edge(x, y)
        return area, area**3 / 12, 2 * x

    want = expected(GEAR, roll, true_profile(GEAR, roll), living, breaks)
    got = textbook.components(GEAR, STEEL, roll, cracks=(crack,), crack_model=model)
    assert_allclose([float(v[0]) for v in (got.bending, got.shear, got.axial)], want, rtol=1e-8)


@pytest.mark.parametrize("level", [0.2, 0.6])
def test_published_with_a_crack_equals_independent_quadrature(level):
    """The crack begins at the foot of the prism and runs at 45 degrees; half its thickness is level 0.5."""
    roll = GEAR.roll_f + 0.7 * (GEAR.roll_a - GEAR.roll_f)
    profiles = prism_profile(GEAR, roll)
    foot = (GEAR.r_b * math.sin(GEAR.base_half_angle), profiles[0][1])
    edge, breaks = cut("constant", (foot[0] * (1 - 2 * level), None), foot, None)

    def living(x, y, _):
        area = x + edge(x, y)
        return area, area**3 / 12, 2 * x

    want = expected(GEAR, roll, profiles, living, breaks[1:])
    got = published.components(GEAR, STEEL, roll, cracks=(gf.Crack(level=level),))
    assert_allclose([float(v[0]) for v in (got.bending, got.shear, got.axial)], want, rtol=1e-8)


@pytest.mark.parametrize("formulas", [textbook, published], ids=["textbook", "published"])
def test_pits_equal_independent_quadrature(formulas):
    """A T-shaped section by the parallel-axis theorem, from the ellipse's own chord."""
    pit = gf.Pit(radius=20.8, z=8.0, axes=(0.6, 2.0), depth=0.3)
    roll = GEAR.roll_a - 0.1
    middle = centre_arc(GEAR, pit)

    def living(x, y, t):
        share = 0.0
        if t > 1.6 and y < 30:  # on the flank: roll lengths; rack tip angles and prism heights are not in the pit's arcs
            u = (t**2 / (2 * GEAR.r_b) - middle) / 0.6
            share = 4.0 * math.sqrt(max(0.0, 1 - u * u)) / GEAR.b
        lost = share * 0.3
        area = 2 * x - lost
        away = x - 0.15
        inertia = 2 * x**3 / 3 - (share * 0.3**3 / 12 + lost * away**2) - (lost * away) ** 2 / area
        return area, inertia, area

    ends = [math.sqrt(2 * GEAR.r_b * (middle + k * 0.6)) for k in (-1, 1)]
    lower, (curve, start, stop) = true_profile(GEAR, roll) if formulas is textbook else prism_profile(GEAR, roll)
    living_below = lambda x, y, t: (2 * x, 2 * x**3 / 3, 2 * x)  # noqa: E731
    above = [(curve, a, b) for a, b in zip([start, *ends], [*ends, stop], strict=True)]
    want = np.add(expected(GEAR, roll, [lower], living_below, []), expected(GEAR, roll, above, living, []))
    got = formulas.components(GEAR, STEEL, roll, pits=(pit,))
    assert_allclose([float(v[0]) for v in (got.bending, got.shear, got.axial)], want, rtol=1e-7)
    healthy = formulas.components(GEAR, STEEL, roll)
    assert want[0] > healthy.bending[0] * 1.001, "the pit matters"


@pytest.mark.parametrize("seed", range(8))
def test_section_equals_a_sum_over_its_width(seed):
    """Overlapping pits on both flanks, and a crack, cut into 20 000 strips of the width."""
    rng = np.random.default_rng(seed)
    pits = [
        gf.Pit(
            radius=rng.uniform(20.0, 22.5), z=rng.uniform(0, 20), axes=tuple(rng.uniform(0.3, 4.0, 2)),
            depth=rng.uniform(0.05, 0.5), angle=rng.uniform(-1.5, 1.5), side=("loaded", "unloaded")[k % 3 == 0],
        )
        for k in range(6)
    ]  # fmt: skip
    found = limits(GEAR, [gf.Crack(level=rng.uniform(0.05, 0.5))], MODELS[seed % 3])
    roll = rng.uniform(GEAR.roll_f, GEAR.roll_a, 9)
    h, y = cartesian(*flank(GEAR, roll))
    arc = arc_at(GEAR, roll)
    area, inertia, _ = section(GEAR, h, y, arc, found, pits)
    z = (np.arange(20_000)[:, None] + 0.5) / 1000
    top, bottom = found[0].edge(h, y) + 0 * z, -h + 0 * z
    for pit in pits:
        a, b, c = pit.form
        u, w = arc - centre_arc(GEAR, pit), z - pit.z
        inside = a * w**2 + 2 * b * u * w + c * u**2 < 1
        if pit.side == "loaded":
            top = np.where(inside, np.minimum(top, h - pit.depth), top)
        else:
            bottom = np.where(inside, np.maximum(bottom, pit.depth - h), bottom)
    want, first = (top - bottom).mean(axis=0), ((top**2 - bottom**2) / 2).mean(axis=0)
    second = ((top**3 - bottom**3) / 3).mean(axis=0) - first**2 / want
    assert_allclose(area, want, rtol=1e-4)
    assert_allclose(inertia, second, rtol=1e-4)
    assert (inertia > 0).all()


@pytest.mark.parametrize("root", ["base", "line"])
def test_other_roots_equal_quadrature(root):
    roll = GEAR.roll_f + 0.5 * (GEAR.roll_a - GEAR.roll_f)
    sin, cos = math.sin(GEAR.base_half_angle), math.cos(GEAR.base_half_angle)
    profiles = [on_flank(GEAR, 1e-9, roll)]
    if root == "line":
        profiles.append((lambda r: (r * sin, r * cos), GEAR.r_f, GEAR.r_b))
    want = expected(GEAR, roll, profiles, lambda x, y, _: (2 * x, 2 * x**3 / 3, 2 * x), [])
    got = textbook.components(GEAR, STEEL, roll, root=root, foundation="none")
    assert_allclose([float(v[0]) for v in (got.bending, got.shear, got.axial)], want, rtol=1e-8)
    assert (got.foundation == 0).all()


# --- limits and order


@pytest.mark.parametrize("formulas", [textbook, published], ids=["textbook", "published"])
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("contact", ["linear", "weber"])
def test_tiny_damage_is_no_damage(formulas, model, contact):
    options = {"formulas": formulas, "crack_model": model, "contact": contact}
    healthy = stiffness(formulas=formulas, contact=contact)
    assert_allclose(stiffness(gf.Crack(length=1e-7), **options), healthy, rtol=1e-6)
    assert_allclose(stiffness(gf.Pit(radius=21.0, z=5.0, axes=(1e-6, 1e-6), depth=1e-6), **options), healthy, rtol=1e-6)
    assert_allclose(stiffness(gf.Crack(level=0.3, tooth=9), *seven(tooth=-7), **options), healthy, rtol=1e-14)


@pytest.mark.parametrize("formulas", [textbook, published], ids=["textbook", "published"])
@pytest.mark.parametrize("seed", range(6))
def test_worse_damage_is_never_stiffer(formulas, seed):
    rng = np.random.default_rng(seed)
    crack = gf.Crack(level=rng.uniform(0.05, 0.5), side=("loaded", "unloaded")[seed % 2], angle=rng.uniform(0.5, 1.2))
    pit = gf.Pit(
        radius=rng.uniform(20.5, 22.5), z=rng.uniform(0, 20), axes=tuple(rng.uniform(0.3, 2.0, 2)), depth=rng.uniform(0.05, 0.3),
        angle=rng.uniform(-1.5, 1.5),
    )  # fmt: skip
    options = {"formulas": formulas, "crack_model": MODELS[seed % 3], "lost": ("hertz", "slices")[seed % 2]}
    steps = [
        (),
        (crack,),
        (crack, pit),
        (crack, replace(pit, depth=pit.depth * 1.5)),
        (crack, replace(pit, depth=pit.depth * 1.5, axes=tuple(1.3 * a for a in pit.axes))),
        (replace(crack, level=crack.level * 1.2), replace(pit, depth=pit.depth * 1.5, axes=tuple(1.3 * a for a in pit.axes))),
    ]
    k = np.array([stiffness(*damage, **options) for damage in steps])
    assert (np.diff(k, axis=0) <= 1e-9 * k[0]).all()
    assert (k[-1] < 0.999 * k[0]).any()


def test_damage_belongs_to_its_tooth():
    """Tooth k of the pinion is in pair k, of the wheel in pair -k in its own numbering; both modulo the tooth number."""
    crack = gf.Crack(level=0.4)
    base = stiffness(crack)
    assert_allclose(stiffness(replace(crack, tooth=1), phase=PHASE - 1), base, rtol=1e-12)
    assert_allclose(stiffness(replace(crack, tooth=-20), phase=PHASE - 1), base, rtol=1e-12)
    swapped = gf.GearPair(pair().gear_2, pair().gear_1)
    wheel = {"cracks": ((), (replace(crack, tooth=-2),)), "pits": ((), tuple(seven(radius=31.2, tooth=-2)))}
    other = {"cracks": ((crack,), ()), "pits": (tuple(seven(radius=31.2)), ())}
    one = plain_sum(pair(), BOTH, PHASE - 2, textbook, **wheel)[0](100.0)
    two = plain_sum(swapped, BOTH, pair().eps_alpha - PHASE, textbook, **other)[0](100.0)
    assert_allclose(one.approach, two.approach, rtol=1e-12)
    assert_allclose(one.line_load.sum(axis=1), 100.0, rtol=1e-12)


def test_cracks_and_pits_that_leave_nothing_are_refused():
    with pytest.raises(ValueError, match="leave nothing of the tooth of z = 21"):
        stiffness(gf.Crack(level=0.9))
    assert (stiffness(gf.Crack(level=0.9), crack_model="straight") < stiffness(gf.Crack(level=0.3))).any()
    with pytest.raises(ValueError, match="no contact is left at phase"):
        stiffness(gf.Pit(radius=21.0, z=10.0, axes=(0.2, 1e4), depth=0.1))
    across = gf.Pit(radius=22.0, z=10.0, axes=(0.3, 1e4), depth=0.1)
    in_double_contact = (math.sqrt(22.0**2 - GEAR.r_b**2) - pair().path[0]) / pair().p_bt
    assert 1 < in_double_contact < pair().eps_alpha
    one = plain_sum(pair(), BOTH, in_double_contact, textbook, pits=((across,), ()))[0](100.0)
    assert (one.line_load > 0).sum() == 1, "a pair whose contact is lost altogether carries nothing"


# --- contact


def test_lost_contact_acts_on_the_contact_or_on_the_slices():
    phase = np.array([pair().pitch_phase])
    lost = lost_width(GEAR, seven(), arc_at(GEAR, pair().curvature_radii(phase)[0]))
    assert_allclose(lost, 14.0, rtol=1e-9)
    shallow = seven(depth=1e-7)
    healthy, c = stiffness(phase=phase), hertz.linear_hertz(BOTH)
    want = {"hertz": 1 / (1 / healthy - c + c / 0.3), "slices": 0.3 * healthy}
    for name, value in want.items():
        assert_allclose(stiffness(*shallow, phase=phase, lost=name), value, rtol=1e-6)


@pytest.mark.parametrize("contact", ["weber", "palmgren"])
def test_load_dependent_contact(contact):
    """One approach for all, loads that add up, and a tangent that is the derivative."""
    solve, _ = plain_sum(pair(), BOTH, PHASE, textbook, contact=contact, pits=(tuple(seven()), ()))
    low, middle, high = (solve(load) for load in (99.9, 100.0, 100.1))
    assert_allclose(middle.line_load.sum(axis=1), 100.0, rtol=1e-12)
    assert_allclose(middle.tangent, 0.2 / (high.approach - low.approach), rtol=1e-6)
    assert (middle.tangent > 100.0 / middle.approach).all()
    assert (solve(200.0).approach < 2 * middle.approach).all()


def test_weber_reproduces_the_reference_local_part():
    """Contact-model notes of the gearcalc project (reference.toml, single_pair): h 0.8108 and 0.8252 mm, a 0.0839 mm."""
    steel = gf.Material(E=206e3, nu=0.3)
    a, h = 0.0839, (0.8108, 0.8252)
    radius = a**2 * math.pi * hertz.contact_modulus((steel, steel)) / (4 * 300.0)
    want = sum(2 * 0.91 / (math.pi * 206e3) * (math.log(2 * d / a) - 0.3 / 1.4) for d in h)
    assert_allclose(hertz.weber_line(300.0, (steel, steel), radius, h)[0], want, rtol=1e-12)


def test_palmgren_of_steel_is_the_handbook_formula():
    """Harris: delta = 3.84e-5 Q**0.9 / L**0.8 (mm, N), steel."""
    steel = gf.Material(E=206e3, nu=0.3)
    got = 50.0 * hertz.palmgren_line(50.0, (steel, steel), 10.0)[0]
    assert_allclose(got, 3.84e-5 * 500.0**0.9 / 10.0**0.8, rtol=0.003)


# --- slices


DAMAGE = {"none": (), "crack": (gf.Crack(level=0.3),), "pits": tuple(seven()), "both": (gf.Crack(level=0.3), *seven())}


@pytest.mark.parametrize("name", DAMAGE)
@pytest.mark.parametrize("lost", ["hertz", "slices"])
def test_without_helix_a_helical_gear_is_a_spur_gear(name, lost):
    spur = stiffness(*DAMAGE[name], lost=lost)
    assert_allclose(stiffness(*DAMAGE[name], lost=lost, face="helical", on=pair(1e-13)), spur, rtol=1e-10)


@pytest.mark.parametrize("beta", [0.1, 0.45])
def test_helical_sum_is_the_exact_integral_of_the_spur_curve(beta):
    gears = pair(beta)
    lag = faces(gears, "helical")[0][2]
    assert_allclose(lag, 20.0 * math.sin(beta) / (math.pi * 2.0), rtol=1e-12, err_msg="eps_beta = b sin(beta) / (pi m_n)")
    phase = np.array([0.05, 0.3, 0.77])
    got = stiffness(on=gears, phase=phase, face="helical")
    for p, k in zip(phase, got, strict=True):
        jumps = [n + e for n in range(-4, 3) for e in (0.0, gears.eps_alpha % 1) if p - lag < n + e < p]
        ends = [p - lag, *sorted(jumps), p]
        parts = [
            quad(lambda q: float(stiffness(on=gears, phase=np.array([q]))[0]), a, b, epsrel=1e-11)[0]
            for a, b in zip(ends, ends[1:], strict=False)
        ]
        assert_allclose(k, sum(parts) / lag, rtol=1e-9)


@pytest.mark.parametrize("lost", ["hertz", "slices"])
def test_slices_converge_to_the_damaged_helical_sum(lost):
    """Midpoint slices, each a spur gear with the sections of the whole tooth."""
    gears, damage = pair(0.3), (gf.Crack(level=0.3), *seven(radius=21.3)[1::2])
    phase = np.array([0.9])
    got = stiffness(*damage, on=gears, phase=phase, face="helical", lost=lost)[0]
    lag = faces(gears, "helical")[0][2]
    z = (np.arange(4000) + 0.5) / 4000
    whole = [d for d in damage if isinstance(d, gf.Crack)] + [d for d in damage if isinstance(d, gf.Pit)]
    total = 0.0
    contact = hertz.linear_hertz(BOTH)
    for number in (-1, 0, 1, 2):
        place = phase[0] + number - lag * z
        on = (place > 0) & (place < gears.eps_alpha)
        if not on.any():
            continue
        rolls = gears.curvature_radii(place[on])
        here = {"cracks": tuple(whole[:1]), "pits": tuple(whole[1:])} if number == 0 else {}
        teeth = textbook.components(gears.gear_1, STEEL, rolls[0], **here).total
        teeth = teeth + textbook.components(gears.gear_2, STEEL, rolls[1]).total
        free = np.ones(on.sum(), dtype=bool)
        if number == 0:
            arc = arc_at(gears.gear_1, rolls[0])
            for pit in whole[1:]:
                free &= (arc - centre_arc(gears.gear_1, pit)) ** 2 + (20.0 * z[on] - pit.z) ** 2 > 1
            assert 0.1 < 1 - free.mean() < 0.9, "the line crosses pits"
        total += (
            (1 / (teeth + contact / free.mean())).sum() / 4000 if lost == "hertz" else (free / (teeth + contact)).sum() / 4000
        )
    assert_allclose(got, total, rtol=5e-4)


def test_helical_curve_is_no_staircase():
    """The curve's steps shrink with the phase step, by its square root where the line begins to cross a pit."""
    gears = pair(0.3)
    steps = [
        np.abs(np.diff(stiffness(*seven(), on=gears, phase=np.linspace(0.8, 0.9, n), face="helical"))).max()
        for n in (11, 41, 161)
    ]
    assert steps[1] < 0.7 * steps[0]
    assert steps[2] < 0.7 * steps[1]


def test_herringbone_is_two_helical_halves():
    two = stiffness(on=pair(0.3, 18.0), face="helical")
    assert_allclose(stiffness(on=pair(0.3, 40.0), face="herringbone", groove=4.0), two * 36.0 / 40.0, rtol=1e-12)
    mirrored = [replace(pit, z=40.0 - pit.z) for pit in seven()]
    one, other = (stiffness(*pits, on=pair(0.3, 40.0), face="herringbone", groove=4.0) for pits in (seven(), mirrored))
    assert_allclose(one, other, rtol=1e-10)
    with pytest.raises(ValueError, match="groove = 40"):
        stiffness(on=pair(0.3, 40.0), face="herringbone", groove=40.0)


# --- ranges of validity, and refusals


def test_sainsot_table_equals_the_published_one():
    """Sainsot et al. 2004, Table 1, as ten public implementations copy it (ross gear_element.py and others)."""
    want = [
        [-5.574e-05, -0.0019986, -0.00023015, 0.0047702, 0.0271, 6.8045],
        [0.00060111, 0.0281, -0.0083431, -0.0099256, 0.1624, 0.9086],
        [-0.00050952, 0.1855, 5.38e-06, 0.0533, 0.2895, 0.9236],
        [-6.2042e-05, 0.0090889, -0.00040964, 0.0078297, -0.1472, 0.6904],
    ]
    assert_allclose(SAINSOT, want, rtol=1e-12)


def test_what_is_outside_its_range_is_named():
    _, details = plain_sum(pair(), BOTH, PHASE, textbook)
    assert [type(v) for v in details["outside"]] == [Validity]
    seen = details["outside"][0]
    assert "theta_f" in seen.what
    assert seen.value > seen.high == 0.12
    thin = gf.GearPair(*(gf.Gear(z=62, r_bore=r, **RACK) for r in (50.0, 20.0)))
    assert [v.what for v in plain_sum(thin, BOTH, PHASE, published)[1]["outside"]] == ["h = r_f / r_bore of z = 62 (Sainsot)"]
    assert plain_sum(pair(), BOTH, PHASE, textbook, foundation="none")[1]["outside"] == ()


def test_rings_have_beams_but_no_sainsot():
    rack = RACK | {"tip_radius": 0.3}
    ring = gf.Gear(z=72, r_rim=90.0, **rack)
    for formulas in (textbook, published):
        with pytest.raises(ValueError, match="does not hold for a ring"):
            formulas.components(ring, STEEL, np.array([ring.roll_a]))
    roll = np.linspace(ring.roll_f, ring.roll_a, 5)
    whole = textbook.components(ring, STEEL, roll, foundation="none")
    cracked = textbook.components(ring, STEEL, roll, foundation="none", cracks=(gf.Crack(level=0.3),))
    assert (np.diff(whole.total) > 0).all(), "softer towards the tip"
    assert (cracked.bending > whole.bending).all()
    x_f, y_f = cartesian(*flank(ring, ring.roll_a))
    beta = load_angle(ring, ring.roll_a)
    profiles = [(lambda p: cartesian(*fillet(ring, p)) * [1, -1], math.pi / 2, form_point(ring)[0])]
    profiles.append((lambda s: cartesian(*flank(ring, s)) * [1, -1], ring.roll_f, ring.roll_a))
    want = by_quad(
        profiles,
        lambda x, y, _: (2 * x, 2 * x**3 / 3, 2 * x),
        [],
        ring.roll_a,
        lambda y, a, i, u: (math.cos(beta) * (-y_f - y) - x_f * math.sin(beta)) ** 2 / i,
    )
    assert_allclose(whole.bending[-1], want / STEEL.E, rtol=1e-8)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"crack_model": "curved"}, "constant, straight, parabola"),
        ({"root": "square"}, "fillet, base, line"),
        ({"foundation": "rigid"}, "'sainsot' or 'none'"),
        ({"contact": "iso"}, "linear, published, weber, palmgren"),
        ({"face": "bevel"}, "spur, helical, herringbone"),
        ({"groove": 2.0}, "only face = 'herringbone'"),
        ({"lost": "width"}, "'hertz' or 'slices'"),
    ],
)
def test_unknown_options_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        stiffness(gf.Crack(level=0.3), **options)
