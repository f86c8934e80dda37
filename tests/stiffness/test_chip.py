"""A chipped tip: the new corner carries load, the tip beyond it does not, and what refuses it."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR_17_38 as PAIR

import gearfe as gf
from gearfe.geometry.damage.chip import Chip
from gearfe.geometry.pair.gear_pair import with_tips
from gearfe.geometry.tooth.gear import shortened

STEEL = gf.Material(E=206e3, nu=0.3)
FORCE = 1669.3
PHASES = np.array([-0.1, 0.05, 0.15, 0.3, 0.7, 1.1, 1.2, 1.3, 1.35, 1.45, 1.55, 1.62])


def case(side="pinion", **chip):
    return gf.Case(PAIR, FORCE, STEEL, damage={side: [gf.Chip(**{"depth": 1.0} | chip)]})


HEALTHY = case().healthy


@pytest.mark.quick
@pytest.mark.parametrize("side", ["pinion", "wheel"])
def test_both_methods_agree(side):
    """Within their estimates, at the new corner too; the pair carries nothing where the tip is gone."""
    ritz, fe, healthy = (
        gf.solve(one, gf.Solve(method, PHASES, error=True))
        for one, method in ((case(side), "ritz"), (case(side), "fe"), (HEALTHY, "ritz"))
    )
    assert (abs(ritz.k - fe.k) <= ritz.error + fe.error).all()
    assert_allclose(ritz.k, fe.k, rtol=3e-3)
    gone = PHASES > 1.4 if side == "pinion" else (PHASES > 0) & (PHASES < 0.1)
    assert (1 - ritz.k[gone] / healthy.k[gone] > 0.2).all()
    alike = (PHASES > 0.4) & (PHASES < 1.15)
    assert_allclose(ritz.k[alike], healthy.k[alike], rtol=3e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("angle", "side", "radius"),
    [
        (30, "loaded", None),
        (60, "unloaded", 4.0),
        (75, "loaded", None),
        (75, "loaded", 5.0),
        (75, "unloaded", None),
        (90, "unloaded", 6.0),
    ],
)
def test_cuts_at_any_angle(angle, side, radius):
    """Ends of the cut lie on the outline, and both methods agree for it."""
    chip = Chip(depth=2.0, angle=math.radians(angle), side=side, radius=radius)
    one = gf.Case(PAIR, FORCE, STEEL, damage={"pinion": [chip]})
    gear, phases = PAIR.gear_1, np.array([0.3, 1.1, 1.3, 1.5])
    start, stop = chip.outline(gear)[:, [0, -1]].T
    assert np.hypot(*start) == pytest.approx(gear.r_a - 2.0)
    fall = math.atan2(abs(stop[0] - start[0]), stop[1] - start[1])
    assert math.degrees(fall) == pytest.approx(angle)
    for flank in ("loaded", "unloaded"):  # the outline runs from the centre line to the end of that flank
        pieces = chip.top(gear, flank)
        ends = [place(np.array([0.0, 1.0])) for _, place in pieces]
        assert ends[0][0, 0] == pytest.approx(0.0, abs=1e-12)
        assert np.hypot(*ends[-1][:, 1]) == pytest.approx(math.hypot(gear.r_b, chip.end_roll(gear, flank)))
        for before, after in zip(ends[:-1], ends[1:], strict=True):
            assert_allclose(before[:, 1], after[:, 0], atol=1e-12)
    ritz, fe = (gf.solve(one, gf.Solve(method, phases)) for method in ("ritz", "fe"))
    assert_allclose(ritz.k, fe.k, rtol=3e-3)


def cut_off():
    """A chip of 90 degrees, the pair with that smaller tip circle, and phases at which no other tooth is near its tip."""
    cut = case(angle=math.pi / 2)
    return cut, with_tips(PAIR, [cut.broken[0][0].cut(PAIR.gear_1)[0], None]), PHASES[PHASES > 0.4]


@pytest.mark.quick
def test_a_whole_tip_cut_off_is_a_shorter_tooth():
    """At 90 degrees the tooth is that of a gear with a smaller tip circle, but for its flat top; a small chip changes little."""
    cut, short, phases = cut_off()
    want = gf.solve(replace(HEALTHY, pair=short), gf.Solve("ritz", phases))
    assert_allclose(gf.solve(cut, gf.Solve("ritz", phases)).k, want.k, rtol=1e-3)
    on_path = PHASES[PHASES < 1.6]
    least = gf.solve(case(depth=1e-3), gf.Solve("ritz", on_path))
    assert_allclose(least.k, gf.solve(HEALTHY, gf.Solve("ritz", on_path)).k, rtol=1e-4)


def hollow(depth, angle, radius):
    """Edge of an outline of the independent solver, in place of its chamfer: an arc with the centre outside of the tooth."""

    def edge(outline, _):
        start = outline.r_a - depth
        turn = float(outline.cut(start))
        first = start * np.array([math.sin(turn), math.cos(turn)])
        along = np.array([-math.sin(angle), math.cos(angle)])
        ahead = first @ along
        chord = -ahead + math.sqrt(ahead**2 - start**2 + outline.r_a**2)
        centre = first + along * chord / 2 + math.sqrt(radius**2 - chord**2 / 4) * np.array([math.cos(angle), math.sin(angle)])
        begin = math.atan2(*(first - centre)[::-1])
        length = 2 * radius * math.asin(chord / 2 / radius)

        def place(t):
            x, y = centre[0] + radius * np.cos(begin - t / radius), centre[1] + radius * np.sin(begin - t / radius)
            return np.hypot(x, y), np.arctan2(x, y)

        samples = np.linspace(0.0, length, 4001)
        radii, angles = place(samples)
        return SimpleNamespace(start=start, last=length, place=place, half=lambda r: np.interp(r, radii, angles))

    return edge


@pytest.mark.slow
def test_rounded_whole_outlines_pressed_together_agree(monkeypatch):
    """The independent solver with its own arc on every tooth, where no other tooth is near its tip, and at the corner."""
    from validation.shared.arbiter import outline, pressing

    one, phases = {"depth": 1.0, "angle": math.pi / 4, "radius": 2.0}, PHASES[PHASES > 0.4]
    monkeypatch.setattr(outline, "_Chamfer", hollow(**one))
    want = pressing.pressed(PAIR, (gf.Flank(tip_chamfer=1.0), None), FORCE / 15, phases, (206e3, 0.3))
    got = gf.solve(case(**one), gf.Solve("ritz", phases, error=True))
    print(got.k / (15e3 * want.k) - 1, got.error / got.k)
    assert (abs(got.k - 15e3 * want.k) <= got.error + 15e3 * want.error).all()
    assert_allclose(got.k, 15e3 * want.k, rtol=5e-3)


@pytest.mark.quick
def test_a_rounded_cut_of_a_large_radius_is_a_plane():
    """In stiffness, section and drawing; a radius below the length of the cut is rejected."""
    plane, large = (gf.solve(case(radius=radius), gf.Solve("ritz", PHASES[5:])).k for radius in (None, 1e7))
    assert_allclose(large, plane, rtol=1e-7)
    gear = PAIR.gear_1
    line = Chip(depth=1.0, radius=1e7).outline(gear)
    assert_allclose(line[:, [0, -1]], Chip(depth=1.0).outline(gear), atol=1e-9)
    bent = Chip(depth=1.0, radius=2.0).outline(gear)
    off = (bent - bent[:, :1]).T @ np.array([1.0, 1.0]) / math.sqrt(2)  # distance from the chord, away from the tooth
    chord = np.hypot(*(bent[:, -1] - bent[:, 0]))
    assert off.min() == pytest.approx(-(2.0 - math.sqrt(4 - chord**2 / 4)), rel=1e-6)
    with pytest.raises(ValueError, match=r"radius = 1 mm: the cut of the chip is 1\.\d+ mm long; give at least this length"):
        case(radius=1.0)


FLANKS = {
    "pinion": gf.Flank(root_relief=0.012, root_start_diameter=49.0),
    "wheel": gf.Flank(tip_relief=0.015, tip_start_diameter=116.0),
}


def test_a_chip_of_modified_flanks():
    """Both methods agree; deviations that vanish give the chip alone; the chip takes the relief above it."""
    cut = replace(case(), flanks=FLANKS)
    ritz, fe = (gf.solve(cut, gf.Solve(method, PHASES)) for method in ("ritz", "fe"))
    assert_allclose(ritz.k, fe.k, rtol=4e-3)
    plain, least = (
        gf.solve(replace(case(), flanks=one), gf.Solve("ritz", PHASES))
        for one in (None, {"wheel": gf.Flank(profile_crowning=1e-9)})
    )
    assert_allclose(least.k, plain.k, rtol=1e-3)
    tip = {"pinion": gf.Flank(tip_relief=0.02, tip_start_diameter=55.6)}
    on = PHASES[(PHASES > 0.4) & (PHASES < 1.3)]
    taken, bare = (gf.solve(replace(case(), flanks=one), gf.Solve("ritz", on)) for one in (tip, None))
    assert_allclose(taken.k[on > 1.1], bare.k[on > 1.1], rtol=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("flanks", "rtol"), [({"pinion": None, "wheel": None}, 5e-3), (FLANKS, 1e-2)], ids=["plain", "modified"])
def test_whole_outlines_pressed_together_agree(flanks, rtol):
    """The independent solver with teeth of a smaller tip circle and the same deviations, where no other tooth is near its tip."""
    from validation.shared.arbiter import pressing

    cut, short, phases = cut_off()
    want = pressing.pressed(short, tuple(flanks.values()), FORCE / 15, phases, (206e3, 0.3))
    got = gf.solve(replace(cut, flanks=flanks), gf.Solve("ritz", phases, error=True))
    print(got.k / (15e3 * want.k) - 1, got.error / got.k)
    assert (abs(got.k - 15e3 * want.k) <= got.error + 15e3 * want.error).all()
    assert_allclose(got.k, 15e3 * want.k, rtol=rtol)


def test_what_does_not_model_it_refuses_it():
    for method in ("textbook", "herringbone_article", "coupled"):
        with pytest.raises(ValueError, match=r"a chip with|damage with"):
            gf.solve(case(), gf.Solve(method, 4))
    with pytest.raises(ValueError, match="chips of rounded or chamfered tips"):
        gf.solve(replace(case(), flanks={"pinion": gf.Flank(tip_rounding=0.2)}), gf.Solve("ritz", 4))
    with pytest.raises(ValueError, match="has a chip and has a crack"):
        gf.Case(PAIR, FORCE, STEEL, damage={"pinion": [gf.Chip(depth=1.0, tooth=3), gf.Crack(level=0.3, tooth=3)]})
    with pytest.raises(ValueError, match="tetrahedra have no chip"):
        gf.export_mesh("x.vtu", PAIR.gear_1, [gf.Chip(depth=1.0)], cells="tetrahedra")
    with pytest.raises(ValueError, match=r"leaves less than 0\.5 modules of the flank"):
        case(depth=6.0)
    with pytest.raises(ValueError, match=r"angle = 0\.08727 rad: the cut of a chip lies in the tooth of z = 17 only above"):
        case(angle=math.radians(5))
    for wrong in ({"depth": -1.0}, {"angle": 2.0}, {"tooth": 0.5}, {"depth": math.nan}, {"radius": -1.0}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            gf.Chip(**{"depth": 1.0} | wrong)


@pytest.mark.slow
def test_a_ring_and_a_shortened_gear():
    """A ring's chip cuts off what points inwards; `shortened` ends flanks where it is told to."""
    ring = gf.Gear(z=84, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_rim=95.0, rack_tip_radius=0.3, addendum=0.9)
    pair = gf.GearPair(gf.Gear(z=31, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=11.4), ring)
    roll = Chip(depth=0.6).cut(pair.gear_2)[0]
    assert shortened(pair.gear_2, roll).roll_a == pytest.approx(roll)
    assert math.hypot(roll, ring.r_b) == pytest.approx(pair.gear_2.r_a + 0.6)
    hurt = gf.Case(pair, FORCE, STEEL, damage={"wheel": [gf.Chip(depth=0.6)]})
    phases = np.array([0.02, 0.15, 0.5, 1.2])
    ritz, fe, healthy = (
        gf.solve(one, gf.Solve(method, phases)) for one, method in ((hurt, "ritz"), (hurt, "fe"), (hurt.healthy, "ritz"))
    )
    assert_allclose(ritz.k, fe.k, rtol=3e-3)
    assert ritz.k[0] < 0.9 * healthy.k[0]


@pytest.mark.slow
def test_a_chip_of_a_part_of_the_width():
    """Over the whole width it is the whole chip within the estimates; the part of the width that is left carries."""
    phases = np.array([0.3, 1.1, 1.45, 1.55])
    whole, part, half, healthy = (
        gf.solve(one, gf.Solve("ritz3d", phases, error=True))
        for one in (case(), case(width=(0, 15)), case(width=(0, 7.5)), HEALTHY)
    )
    assert (abs(part.k - whole.k) <= part.error + whole.error).all()
    assert_allclose(part.k, whole.k, rtol=1e-3)
    assert (half.error < 6e-3 * half.k).all()
    gone = phases > 1.4
    assert (half.k[gone] > 1.05 * part.k[gone]).all()
    assert (half.k[gone] < 0.95 * healthy.k[gone]).all()
    mirrored = gf.solve(case(width=(7.5, 15)), gf.Solve("ritz3d", phases))
    assert_allclose(mirrored.k, half.k, rtol=1e-6)


@pytest.mark.parametrize(
    ("width", "method", "message"),
    [
        ((0, 7.5), "ritz", "chips with method = 'ritz', a transverse section"),
        ((0, 16), "ritz3d", "width = \\(0, 16\\) mm: the chip goes beyond the face, which ends at 15 mm"),
        ((7, 3), "ritz3d", "give two increasing heights"),
    ],
)
def test_a_part_of_the_width_needs_three_dimensions_and_the_face(width, method, message):
    with pytest.raises(ValueError, match=message):
        gf.solve(case(width=width), gf.Solve(method, 4))
