"""The plain sum of damaged pairs: teeth, contact laws, slices of helical gears, ranges of validity."""

import math
from dataclasses import replace

import numpy as np
import pytest
from checks import lost_width
from damaged_sum import BOTH, GEAR, PHASE, RACK, STEEL, pair, seven, stiffness
from numpy.testing import assert_allclose
from scipy.integrate import quad

import gearfe as gf
from gearfe.flexibility import hertz
from gearfe.flexibility.energy.closed import herringbone_article, textbook
from gearfe.flexibility.energy.closed.beam import SAINSOT, Validity, load_angle
from gearfe.flexibility.energy.closed.plain_sum import plain_sum
from gearfe.flexibility.energy.closed.section import DamagedTooth
from gearfe.flexibility.energy.closed.slices import faces
from gearfe.geometry.damage.hollow import centre_arc
from gearfe.geometry.tooth.profile import arc_at, root_half_angle

# --- teeth


def test_damage_belongs_to_its_tooth():
    """Tooth k of the pinion is in pair k, of the wheel in pair -k in its own numbering; both modulo the tooth number."""
    crack = gf.Crack(level=0.4)
    base = stiffness(crack)
    assert_allclose(stiffness(replace(crack, tooth=1), phase=PHASE - 1), base, rtol=1e-12)
    assert_allclose(stiffness(replace(crack, tooth=-20), phase=PHASE - 1), base, rtol=1e-12)
    swapped = gf.GearPair(pair().gear_2, pair().gear_1)
    wheel = gf.Case(pair(), 1.0, STEEL, damage={"wheel": [replace(crack, tooth=2), *seven(radius=31.2, tooth=2)]})
    other = gf.Case(swapped, 1.0, STEEL, damage={"pinion": [crack, *seven(radius=31.2)]})
    one = plain_sum(wheel, PHASE - 2, textbook)[0](100.0)
    two = plain_sum(other, pair().eps_alpha - PHASE, textbook)[0](100.0)
    assert_allclose(one.closing, two.closing, rtol=1e-12)
    assert_allclose(one.line_load.sum(axis=1), 100.0, rtol=1e-12)


def test_cracks_and_pits_that_leave_nothing_are_refused():
    with pytest.raises(ValueError, match="leave no section of the tooth of z = 21"):
        stiffness(gf.Crack(level=0.9))
    assert (stiffness(gf.Crack(level=0.9), crack_model="straight") < stiffness(gf.Crack(level=0.3))).any()
    with pytest.raises(ValueError, match="no contact is left at phase"):
        stiffness(gf.Pit(radius=21.0, z=10.0, axes=(0.2, 1e4), depth=0.1))
    across = gf.Pit(radius=22.0, z=10.0, axes=(0.3, 1e4), depth=0.1)
    in_double_contact = (math.sqrt(22.0**2 - GEAR.r_b**2) - pair().path[0]) / pair().p_bt
    assert 1 < in_double_contact < pair().eps_alpha
    one = plain_sum(gf.Case(pair(), 1.0, STEEL, damage={"pinion": [across]}), in_double_contact, textbook)[0](100.0)
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


@pytest.mark.parametrize("half", [0, 1])
def test_summed_widths_act_wherever_the_line_is(half):
    """Article S4: k_h with L less the sum of the pits' widths, also at phases at which the line meets no pit."""
    gears = pair(0.3, 40.0)
    row = seven(depth=1e-7, axes=(0.1, 1.0), radius=gears.gear_1.r_a - 0.2)
    pits = [replace(pit, z=abs(40.0 * half - pit.z)) for pit in row]
    c, options = hertz.linear_hertz(BOTH), {"on": gears, "face": "herringbone", "phase": np.array([0.7])}
    none, one = stiffness(**options)[0], stiffness(*pits, lost="summed", **options)[0]
    assert_allclose(stiffness(*pits, **options), none, rtol=1e-6, err_msg="the line meets pits")

    def compliance(part):
        """Of pair 0 in one half, from slices of which pits leave a part of the contact."""
        lag = faces(gears, "herringbone")[0][2]
        place = 0.7 - lag * (np.arange(20000) + 0.5) / 20000
        rolls = gears.curvature_radii(place[(place > 0) & (place < gears.eps_alpha)])
        teeth = sum(textbook.components(g, STEEL, r).total for g, r in zip((gears.gear_1, gears.gear_2), rolls, strict=True))
        return (1 / (teeth + c / part)).sum() / 20000 / 2

    assert_allclose(none - one, compliance(1.0) - compliance(1 - 14 / 20), rtol=2e-4)
    with pytest.raises(ValueError, match=r"damaged widths add up to 1\.4 times"):
        stiffness(*pits, *(replace(pit, radius=pit.radius - 0.5) for pit in pits), lost="summed", **options)


def test_beam_and_body_of_the_article_end_where_they_are_told_to():
    """Beams on the base circle lose the prism, nothing else; a body that ends there has its lever and its S_f counted there."""
    roll = np.array([3.0, 5.0])
    whole, beam, body = (
        herringbone_article.components(GEAR, STEEL, roll, **one) for one in ({}, {"root": "base"}, {"foot": "base"})
    )
    assert_allclose(whole.foundation, beam.foundation, rtol=0)
    assert_allclose(whole.bending, body.bending, rtol=0)
    sin, cos = math.sin(GEAR.base_half_angle), math.cos(GEAR.base_half_angle)
    prism = GEAR.r_b * cos - math.sqrt(GEAR.r_f**2 - (GEAR.r_b * sin) ** 2)
    force = load_angle(GEAR, roll)
    assert_allclose(whole.axial - beam.axial, np.sin(force) ** 2 * prism / (2 * STEEL.E * GEAR.r_b * sin), rtol=1e-9)
    crack = DamagedTooth((gf.Crack(level=0.3),))
    hurt = herringbone_article.components(GEAR, STEEL, roll, damage=crack, root="base")
    assert (hurt.bending < herringbone_article.components(GEAR, STEEL, roll, damage=crack).bending).all()
    on_base = replace(GEAR, dedendum=(GEAR.r - GEAR.r_b) / GEAR.m_n)  # its root circle is the base circle
    assert_allclose(body.foundation, herringbone_article.components(on_base, STEEL, roll).foundation, rtol=1e-6)
    for name in ("root", "foot"):
        with pytest.raises(ValueError, match=f"{name} = 'tip'"):
            herringbone_article.components(GEAR, STEEL, roll, **{name: "tip"})


@pytest.mark.parametrize("contact", ["weber", "palmgren"])
def test_load_dependent_contact(contact):
    """One approach for all, loads that add up, and a tangent that is the derivative."""
    solve, _ = plain_sum(gf.Case(pair(), 1.0, STEEL, damage={"pinion": seven()}), PHASE, textbook, contact=contact)
    low, middle, high = (solve(load) for load in (99.9, 100.0, 100.1))
    assert_allclose(middle.line_load.sum(axis=1), 100.0, rtol=1e-12)
    assert_allclose(middle.tangent, 0.2 / (high.closing - low.closing), rtol=1e-6)
    assert (middle.tangent > 100.0 / middle.closing).all()
    assert (solve(200.0).closing < 2 * middle.closing).all()


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
        here = DamagedTooth(tuple(whole[:1]), tuple(whole[1:])) if number == 0 else DamagedTooth()
        teeth = textbook.components(gears.gear_1, STEEL, rolls[0], damage=here).total
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
    case = gf.Case(pair(), 1.0, STEEL)
    _, details = plain_sum(case, PHASE, textbook)
    assert [type(v) for v in details["outside"]] == [Validity]
    seen = details["outside"][0]
    assert "theta_f" in seen.what
    assert seen.value > seen.high == 0.12
    thin = gf.GearPair(*(gf.Gear(z=62, r_bore=r, **RACK) for r in (50.0, 20.0)))
    outside = plain_sum(gf.Case(thin, 1.0, STEEL), PHASE, herringbone_article)[1]["outside"]
    assert [v.what for v in outside] == ["h = r_f / r_bore of z = 62 (Sainsot)"]
    assert plain_sum(case, PHASE, textbook, foundation="none")[1]["outside"] == ()


@pytest.mark.parametrize("formulas", [textbook, herringbone_article])
def test_a_ring_has_beams_and_its_planet_a_foundation(formulas):
    """With foundation 'external' the planet's tooth is as before and the ring's that without any foundation."""
    roll = np.array([8.0, 9.0])
    planet = gf.Gear(z=27, r_bore=12.0, **RACK)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.86, rack_tip_radius=0.2, **RACK)
    own, whole = (formulas.components(planet, STEEL, roll, foundation=name) for name in ("external", "sainsot"))
    assert_allclose(own.total, whole.total, rtol=0)
    at = np.linspace(ring.roll_a, ring.roll_f, 4)[1:3]
    inner, bare = (formulas.components(ring, STEEL, at, foundation=name) for name in ("external", "none"))
    assert_allclose(inner.total, bare.total, rtol=0)
    assert (inner.bending > 0).all()
    assert inner.bending[0] > inner.bending[1]  # nearer the tip
    with pytest.raises(ValueError, match="is invalid for a ring"):
        formulas.components(ring, STEEL, at)


@pytest.mark.parametrize("formulas", [textbook, herringbone_article])
def test_a_ring_has_the_foundation_of_external_gears_if_printed(formulas):
    """Article S4's bracket with h = 1, in front of the planet's unchanged one."""
    planet = gf.Gear(z=27, r_bore=12.0, **RACK)
    ring = gf.Gear(z=72, r_rim=90.0, addendum=0.86, rack_tip_radius=0.2, **RACK)
    roll = np.array([8.0, 9.0])
    own, whole = (formulas.components(planet, STEEL, roll, foundation=name) for name in ("printed", "sainsot"))
    assert_allclose(own.total, whole.total, rtol=0)
    at = np.linspace(ring.roll_a, ring.roll_f, 4)[1:3]
    got = formulas.components(ring, STEEL, at, foundation="printed")
    theta = root_half_angle(ring) if formulas is textbook else float(ring.half_thickness(ring.r_f))
    angle = load_angle(ring, at)
    u = (ring.r_f - ring.r_b / np.cos(angle)) / (2 * ring.r_f * theta)  # inwards from the root circle to the centre-line
    first, m, p, q = (a / theta**2 + b + c / theta + d / theta + e + f for a, b, c, d, e, f in SAINSOT)  # with h = 1
    tan = np.tan(angle)
    last = p * (1 + q * tan**2) if formulas is textbook else p * (1 + tan**2) + q * tan
    assert_allclose(got.foundation, np.cos(angle) ** 2 / STEEL.E * (first * u**2 + m * u + last), rtol=1e-12)
    assert any("h = r_f / r_bore" in seen.what and seen.value == 1.0 for seen in got.outside)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"crack_model": "curved"}, "constant, straight, parabola"),
        ({"root": "square"}, "fillet, base, line"),
        ({"foundation": "rigid"}, "sainsot, external, printed, none"),
        ({"contact": "iso"}, "linear, herringbone_article, weber, palmgren"),
        ({"face": "bevel"}, "spur, helical, herringbone"),
        ({"groove": 2.0}, "only face = 'herringbone'"),
        ({"lost": "width"}, "one of hertz, slices, summed"),
    ],
)
def test_unknown_options_are_refused(options, message):
    with pytest.raises(ValueError, match=message):
        stiffness(gf.Crack(level=0.3), **options)
