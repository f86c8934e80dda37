"""Cracks and pits in the closed forms: against independent quadrature, and in the limits."""

import math
from dataclasses import replace

import numpy as np
import pytest
from damaged_sum import GEAR, RACK, STEEL, seven, stiffness
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq

import gearfe as gf
from gearfe.flexibility import hertz
from gearfe.flexibility.energy.closed import herringbone_article, textbook
from gearfe.flexibility.energy.closed.beam import SAINSOT, load_angle, sainsot
from gearfe.flexibility.energy.closed.section import DamagedTooth, limits, section
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.damage.hollow import centre_arc
from gearfe.geometry.tooth.profile import arc_at, cartesian, fillet, flank, form_point

MODELS = ("constant", "straight", "parabola")


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
    if gear.r_f > gear.r_b:
        return [on_flank(gear, math.sqrt(gear.r_f**2 - gear.r_b**2), roll)]
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
    got = textbook.components(GEAR, STEEL, roll, damage=DamagedTooth((crack,), crack_model=model))
    assert_allclose(np.ravel([got.bending, got.shear, got.axial]), want, rtol=1e-8)


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
    got = herringbone_article.components(GEAR, STEEL, roll, damage=DamagedTooth((gf.Crack(level=level),)))
    assert_allclose(np.ravel([got.bending, got.shear, got.axial]), want, rtol=1e-8)


@pytest.mark.parametrize("formulas", [textbook, herringbone_article], ids=["textbook", "herringbone_article"])
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
    got = formulas.components(GEAR, STEEL, roll, damage=DamagedTooth((), (pit,)))
    assert_allclose(np.ravel([got.bending, got.shear, got.axial]), want, rtol=1e-7)
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
    found = limits(GEAR, DamagedTooth((gf.Crack(level=rng.uniform(0.05, 0.5)),), crack_model=MODELS[seed % 3]))
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


HEALTHY = [(12, {}), (21, {}), (62, {}), (30, {"x": 0.5}), (25, {"rack_tip_radius": 0.0})]


@pytest.mark.quick
@pytest.mark.parametrize(("z", "numbers"), HEALTHY)
@pytest.mark.parametrize("formulas", [textbook, herringbone_article], ids=["textbook", "herringbone_article"])
def test_healthy_beams_equal_independent_quadrature(formulas, z, numbers):
    """Along the whole profile, or along the involute and a prism below the base circle."""
    gear = gf.Gear(z=z, r_bore=0.4 * z, **RACK | numbers)
    roll = gear.roll_f + 0.6 * (gear.roll_a - gear.roll_f)
    profiles = (true_profile if formulas is textbook else prism_profile)(gear, roll)
    want = expected(gear, roll, profiles, lambda x, y, _: (2 * x, 2 * x**3 / 3, 2 * x), [])
    got = formulas.components(gear, STEEL, roll)
    assert_allclose(np.ravel([got.bending, got.shear, got.axial]), want, rtol=1e-8)


@pytest.mark.parametrize("root", ["base", "line"])
def test_other_roots_equal_quadrature(root):
    roll = GEAR.roll_f + 0.5 * (GEAR.roll_a - GEAR.roll_f)
    sin, cos = math.sin(GEAR.base_half_angle), math.cos(GEAR.base_half_angle)
    profiles = [on_flank(GEAR, 1e-9, roll)]
    if root == "line":
        profiles.append((lambda r: (r * sin, r * cos), GEAR.r_f, GEAR.r_b))
    want = expected(GEAR, roll, profiles, lambda x, y, _: (2 * x, 2 * x**3 / 3, 2 * x), [])
    got = textbook.components(GEAR, STEEL, roll, root=root, foundation="none")
    assert_allclose(np.ravel([got.bending, got.shear, got.axial]), want, rtol=1e-8)
    assert (got.foundation == 0).all()


def test_all_roots_are_one_where_the_flank_reaches_the_root_circle():
    """Of many teeth without shift: nothing is left between base and root circle that a line or a prism could fill."""
    gear = gf.Gear(z=60, r_bore=30.0, **RACK)
    assert gear.r_f > gear.r_b
    roll = np.linspace(gear.roll_f, gear.roll_a, 5)
    base, *others = (textbook.components(gear, STEEL, roll, root=root) for root in ("base", "line", "prism"))
    for other in others:
        assert_allclose(other.total, base.total, rtol=1e-12)


# --- formulas


def test_sainsot_at_a_hand_computed_point():
    h, theta = 2.0, 0.1
    want = [a / theta**2 + b * h**2 + c * h / theta + d / theta + e * h + f for a, b, c, d, e, f in SAINSOT]
    assert_allclose(sainsot(h, theta), want, rtol=1e-14)
    assert_allclose(want[0], -5.574e-3 - 7.9944e-3 - 4.603e-3 + 0.047702 + 0.0542 + 6.8045, rtol=1e-12)


def test_published_contact_is_1_57_times_the_textbooks():
    assert_allclose(herringbone_article.contact((STEEL, STEEL)) / hertz.linear_hertz((STEEL, STEEL)), math.pi / 2, rtol=1e-12)


# --- limits and order


@pytest.mark.parametrize("formulas", [textbook, herringbone_article], ids=["textbook", "herringbone_article"])
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("contact", ["linear", "weber"])
def test_tiny_damage_is_no_damage(formulas, model, contact):
    options = {"formulas": formulas, "crack_model": model, "contact": contact}
    healthy = stiffness(formulas=formulas, contact=contact)
    assert_allclose(stiffness(gf.Crack(length=1e-7), **options), healthy, rtol=1e-6)
    assert_allclose(stiffness(gf.Pit(radius=21.0, z=5.0, axes=(1e-6, 1e-6), depth=1e-6), **options), healthy, rtol=1e-6)
    assert_allclose(stiffness(gf.Crack(level=0.3, tooth=9), *seven(tooth=-7), **options), healthy, rtol=1e-14)


@pytest.mark.parametrize("formulas", [textbook, herringbone_article], ids=["textbook", "herringbone_article"])
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


# --- rings


def test_rings_have_beams_but_no_sainsot():
    rack = RACK | {"rack_tip_radius": 0.3}
    ring = gf.Gear(z=72, r_rim=90.0, **rack)
    for formulas in (textbook, herringbone_article):
        with pytest.raises(ValueError, match="is invalid for a ring"):
            formulas.components(ring, STEEL, np.array([ring.roll_a]))
    roll = np.linspace(ring.roll_f, ring.roll_a, 5)
    whole = textbook.components(ring, STEEL, roll, foundation="none")
    cracked = textbook.components(ring, STEEL, roll, foundation="none", damage=DamagedTooth((gf.Crack(level=0.3),)))
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
