"""The table of methods says what they do, and a user's own flexibility stands where `ritz` and `fe` do."""

import math
from dataclasses import replace
from importlib import resources

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.own_model import own_models
from gearfe.flexibility.energy.closed import coupled, textbook
from gearfe.flexibility.energy.ritz import plane as ritz
from gearfe.geometry.pair import lines
from gearfe.stiffness.methods import FACES, METHODS, NAMES, RING_FOUNDATIONS, ROWS, fitted

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 2.0}
BETA = math.radians(16)
SPUR = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
HELICAL = gf.GearPair(gf.Gear(z=18, r_bore=9.0, beta=BETA, **RACK), gf.Gear(z=27, r_bore=12.0, beta=-BETA, **RACK))
RING = gf.GearPair(gf.Gear(z=31, r_bore=11.4, **RACK), gf.Gear(z=84, r_rim=95.0, addendum=0.8, rack_tip_radius=0.2, **RACK))
PIT = gf.Pit(radius=21.0, z=1.0, axes=(0.2, 0.4), depth=0.1)
FORCE = 200.0
# which it takes on pages of the validation that are computed again, too: whole gears take a minute
ELSEWHERE = {("ritz3d", "crack"), ("ritz3d", "crack of part of the width"), ("ritz3d", "sloping crack")}
# what a method may take: options, and whether its row says so
INPUTS = {
    "nothing": ({}, lambda row: True),
    "crack": ({"damage": {"pinion": [gf.Crack(level=0.3)]}}, lambda row: bool(row.cracks)),
    "crack of part of the width": (
        {"damage": {"pinion": [gf.Crack(level=0.3, width=(0.0, 1.0))]}},
        lambda row: row.cracks == "any",
    ),
    "sloping crack": ({"damage": {"wheel": [gf.Crack(level=0.3, ends=(1.0, 0.4))]}}, lambda row: row.cracks == "any"),
    "pit": ({"damage": {"pinion": [PIT]}}, lambda row: row.pits),
    "ring": ({"pair": RING}, lambda row: row.rings == "yes"),
    "ring without its body": ({"pair": RING, "variants": {"foundation": "external"}}, lambda row: row.rings in RING_FOUNDATIONS),
    "helical": ({"pair": HELICAL, "face": "helical"}, lambda row: "helical" in row.faces),
    "herringbone": ({"pair": HELICAL, "face": "herringbone", "groove": 0.4}, lambda row: "herringbone" in row.faces),
    "variants": ({"variants": {"contact": "linear"}}, lambda row: row.variants),
    "teeth": ({"teeth": 3}, lambda row: row.teeth),
}  # fmt: skip


def curve_of(steel, method, **options):
    coarse = {"fe": 0.4, "ritz3d": 0.5, "fe3d": 0.5}.get(method if isinstance(method, str) else "", 1.0)
    run = {"pair": SPUR, "force": FORCE, "phases": [0.5], "refine": coarse} | options
    return gf.mesh_stiffness(material=steel, method=method, **run)


@pytest.mark.parametrize(
    ("method", "what"),
    [
        (name, what)
        for name in METHODS
        for what in INPUTS
        if name != "fe3d" and (name, what) not in ELSEWHERE  # fe3d: elements/test_fe_gear3d.py; what it refuses: below
    ],
)
def test_each_method_takes_what_its_row_says(steel, method, what):
    """Either a curve, or a ValueError that names the method."""
    options, says = INPUTS[what]
    if says(METHODS[method]):
        curve = curve_of(steel, method, **options)
        assert np.isfinite(curve.k).all()
        assert curve.meta["method"] == method
    else:
        with pytest.raises(ValueError, match=f"method = '{method}'"):
            curve_of(steel, method, **options)


@pytest.mark.parametrize("what", [name for name in INPUTS if name not in ("nothing", "variants")])
def test_refusals_of_whole_gears_are_quick(steel, what):
    """Of fe3d everything that its row has not, without the slow solves."""
    options, says = INPUTS[what]
    if not says(METHODS["fe3d"]):
        with pytest.raises(ValueError, match="method = 'fe3d'"):
            curve_of(steel, "fe3d", **options)


@pytest.mark.parametrize("method", [name for name in METHODS if METHODS[name].kind != "solid"])
def test_error_extension_and_resolution_are_as_the_row_says(steel, method):
    row, phase = METHODS[method], [0.03, 0.66]  # a tip corner touches ahead of the path at the second
    plain = curve_of(steel, method, phases=phase, error=row.error)
    assert (plain.error is not None) == row.error
    for option in [] if row.error else [{"error": True}]:
        with pytest.raises(ValueError, match=f"error = True with method = '{method}'"):
            curve_of(steel, method, phases=phase, **option)
    if not row.converged:
        with pytest.raises(ValueError, match=r"refine = 0\.7 with method"):
            curve_of(steel, method, phases=phase, refine=0.7)
        with pytest.raises(ValueError, match="order = 3 with method"):
            curve_of(steel, method, phases=phase, order=3)
    without = curve_of(steel, method, phases=phase, extended=False)
    assert (not np.allclose(without.k, plain.k, rtol=1e-6)) == row.extended
    if row.converged:
        assert not np.array_equal(curve_of(steel, method, phases=phase, refine=0.7).k, plain.k)
    assert plain.meta.get("order") == row.order
    if row.order:
        assert not np.array_equal(curve_of(steel, method, phases=phase, order=row.order - 1).k, plain.k)


def test_the_energy_model_of_finite_width_is_as_its_row_says(steel):
    row = METHODS["ritz3d"]
    plain = curve_of(steel, "ritz3d", phases=[0.66], error=row.error)
    assert plain.error is not None
    assert plain.meta["order"] == row.order
    assert row.extended
    assert plain.k[0] > 1.001 * curve_of(steel, "ritz3d", phases=[0.66], extended=False).k[0]


def test_rows_are_complete():
    assert NAMES == ("auto", "ritz", "ritz3d", "fe", "fe3d", "coupled", "textbook", "herringbone_article")
    assert FACES == lines.FACES
    for row in ROWS:
        assert row.about
        assert row.cost in ("milliseconds", "seconds", "minutes")
        loaded = row.load()
        assert callable(loaded.components if row.kind == "sum" else loaded)
        assert f"``{row.name}``" in gf.Solve.__doc__


def test_one_rule_for_what_a_method_gets():
    case = gf.Case(HELICAL, 100.0, gf.Material(), face="herringbone", groove=0.4)
    for row in ROWS:
        given, variants, left_out = fitted(row.name, case)
        if row.kind == "section":
            assert (given.face, given.groove, given.pair.gear_1.b) == (None, 0.0, 1.6)
            assert left_out == (f"{row.name} is the transverse section: herringbone teeth are taken as spur teeth 1.6 mm wide, b "
                                "less the groove of 0.4 mm",)  # fmt: skip
        else:
            assert (given, variants, left_out) == (case, None, ())
        _, variants, left_out = fitted(row.name, gf.Case(RING, 100.0, gf.Material()))
        assert (variants is not None) == (row.rings in RING_FOUNDATIONS) == bool(left_out)
    assert fitted("auto", case) == (case, None, ())
    assert [bool(gf.Case(pair, 100.0, gf.Material()).why_wide) for pair in (SPUR, HELICAL)] == [False, True]


def test_a_herringbone_scene_with_a_groove_by_the_section(tmp_path, capsys):
    text = (resources.files("gearfe.scene.scenes") / "herringbone.toml").read_text()
    path, out = tmp_path / "grooved.toml", tmp_path / "k.csv"
    path.write_text(text.replace('face = "herringbone"', 'face = "herringbone"\ngroove_mm = 4.0'))
    assert main(["stiffness", str(path), "--method", "ritz", "--phases", "4", "-o", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "ritz is the transverse section: herringbone teeth are taken as spur teeth 56 mm wide, b less the groove" in printed
    assert "width 56 mm" in printed
    chosen = gf.load_scene("herringbone").pair()
    gears = [replace(gear, b=56.0) for gear in (chosen.pair.gear_1, chosen.pair.gear_2)]
    narrow = gf.mesh_stiffness(gf.GearPair(*gears, chosen.pair.a), chosen.force, chosen.materials, method="ritz", phases=4)
    assert_allclose(gf.StiffnessCurve.from_csv(out).k, narrow.k, rtol=1e-9)


def test_help_names_every_method(capsys):
    with pytest.raises(SystemExit):
        main(["stiffness", "--help"])
    text = capsys.readouterr().out
    for row in ROWS:
        assert f"{row.name:19s} {row.about}; {row.cost}" in text


# one's own flexibility


@pytest.fixture(scope="module")
def solved(steel):
    return [ritz.flexibility(gear, steel, neighbours=2) for gear in (SPUR.gear_1, SPUR.gear_2)]


def sections(gear, material, radius, tooth):
    """The closed form `coupled` spelled out: beams on one annulus."""
    roll = np.sqrt(radius**2 - gear.r_b**2)
    loads = coupled.body_loads(gear, roll)
    apart = np.abs(tooth[:, None] - tooth)
    body = coupled.body(gear, material, neighbours=int(apart.max()))
    turned = np.where((tooth[:, None] >= tooth)[..., None, None], body[apart], np.swapaxes(body[apart], -1, -2))
    bulk = np.einsum("ai,ijab,bj->ij", loads, turned, loads)
    return bulk + np.diag(coupled.beam(gear, material, roll).sum(axis=0))


@pytest.mark.parametrize("extended", [True, False])
def test_named_and_solved_gears_give_the_curve_of_their_method(steel, solved, extended):
    want = curve_of(steel, "ritz", phases=12, extended=extended)
    for own in (gf.OwnFlexibility("ritz"), gf.OwnFlexibility("ritz", solved[1]), gf.OwnFlexibility(*solved)):
        found = curve_of(steel, own, phases=12, extended=extended)
        assert_allclose(found.k, want.k, rtol=1e-12)
        assert found.meta["extended"] is extended


def test_bulk_and_neighbours_are_the_users_and_the_dent_is_added(steel):
    """The closed form spelled out by its user gives its curve; without neighbours the mesh is stiffer where two pairs touch."""
    want = curve_of(steel, "coupled", phases=16)
    own = curve_of(steel, gf.OwnFlexibility(sections), phases=16)
    assert_allclose(own.k, want.k, rtol=1e-6)
    alone = gf.OwnFlexibility(lambda *given: np.diag(np.diag(sections(*given))))
    loner = curve_of(steel, alone, phases=16)
    double = np.arange(16) / 16 < SPUR.eps_alpha - 1
    assert_allclose(loner.k[~double], want.k[~double], rtol=1e-6)
    assert (loner.k[double] > 1.005 * want.k[double]).all()


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_teeth_are_counted_to_the_loaded_side_of_their_gear(steel, gear):
    """A soft tooth of the pair ahead gives its load to the other: pinion's tooth 1, wheel's tooth -1."""
    number = 1 if gear == "pinion" else -1

    def soft(gear, material, radius, tooth):
        return sections(gear, material, radius, tooth) + np.diag(np.where(tooth == number, 3e-5, 0.0))

    parts = (soft, "coupled") if gear == "pinion" else ("coupled", soft)
    healthy, weak = (curve_of(steel, method, phases=[0.2]) for method in ("coupled", gf.OwnFlexibility(*parts)))
    ahead = list(weak.order).index(1)
    assert weak.share[0, ahead] < healthy.share[0, list(healthy.order).index(1)] - 0.05
    assert weak.k[0] < healthy.k[0]


class OnlyMatrix:
    """What the documentation asks of an object: ``matrix(roll, teeth)`` and nothing else."""

    def __init__(self, flexibility):
        self.flexibility = flexibility

    def matrix(self, roll, teeth):
        return self.flexibility.matrix(roll, teeth)


def test_an_object_with_only_a_matrix(steel, solved):
    want = curve_of(steel, gf.OwnFlexibility(*solved), phases=12, extended=False)
    found = curve_of(steel, gf.OwnFlexibility(*map(OnlyMatrix, solved)), phases=12)
    assert_allclose(found.k, want.k, rtol=1e-12)
    assert found.meta["flexibility"] == ["OnlyMatrix", "OnlyMatrix"]


@pytest.mark.slow
def test_own_flexibility_in_compare():
    scene = gf.load_scene("planetary_pitting")
    models = {"energy": gf.OwnFlexibility("ritz"), "mine": gf.OwnFlexibility(sections)}
    found = gf.compare(scene, models=models, phases=2, refine=0.4)
    assert_allclose(found.curves["energy"].k, found.curves["ritz"].k, rtol=1e-12)
    assert_allclose(found.curves["mine"].k, found.curves["coupled"].k, rtol=1e-6)
    assert found.table().markdown().splitlines()[0].endswith("| energy [N/um] | error | mine [N/um] | error |")
    assert found.curves["mine"].meta["method"] == "mine"
    assert list(own_models([gf.OwnFlexibility(sections)])) == ["sections"]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("textbook", "textbook is a formula that adds the stiffnesses of independent tooth pairs: it has no flexibility"),
        ("herringbone_article", "use it as method = 'herringbone_article', or give one of ritz, fe or coupled, a function"),
        (textbook, "textbook is a formula that adds"),
        (textbook.components, "textbook is a formula that adds"),
        ("ritz3d", "give a function f"),
        (3.0, "pinion = 3.0, but give a function f"),
    ],
)
def test_what_is_no_flexibility(given, message):
    with pytest.raises(ValueError, match=message):
        gf.OwnFlexibility(given)
    with pytest.raises(ValueError, match="wheel = "):
        gf.OwnFlexibility("ritz", given)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda gear, material, radius, tooth: np.ones(radius.size + 1), r"array of shape \(\d,\), but give \(\d, \d\)"),
        (lambda gear, material, radius, tooth: np.full((radius.size,) * 2, np.nan), "not finite"),
        (lambda gear, material, radius, tooth: np.diag(-1e-6 * radius), "not positive"),
        (lambda gear, material, radius, tooth: np.diag(radius) + np.triu(np.full((radius.size,) * 2, 0.1), 1), "not symmetric"),
        (lambda gear, material, radius, tooth: "stiff", "but give a matrix of real numbers"),
        (lambda gear, material, radius, tooth: np.diag(radius) * (1 + 1j), "complex128, but give a matrix of real numbers"),
        (lambda gear, material, radius, tooth: [[1.0], [1.0, 2.0]], "give a matrix of numbers"),
        (lambda gear, material, radius, tooth: {}["k"], "it failed with KeyError: 'k'"),
        (lambda gear, material, radius, tooth: 1 // 0, "it failed with ZeroDivisionError"),
        (lambda gear, material, radius: radius, "it failed with TypeError: .*positional"),
        (lambda gear, material, radius, tooth: textbook.components(gear, material, radius - gear.r_b), "returned Components"),
    ],
)
def test_impossible_matrices_are_named(steel, function, message):
    with pytest.raises(ValueError, match=message):
        curve_of(steel, gf.OwnFlexibility(function, name="mine"), phases=[0.2])


def test_own_flexibility_refuses_what_it_has_not(steel, solved):
    own = gf.OwnFlexibility(sections, name="mine")
    for options, message in (
        ({"damage": {"pinion": [gf.Crack(level=0.3)]}}, "damage with method = 'mine', which has none"),
        ({"face": "helical", "pair": HELICAL}, "face = 'helical' with method = 'mine'"),
        ({"variants": {"contact": "linear"}}, "variants"),
    ):
        with pytest.raises(ValueError, match=message):
            curve_of(steel, own, **options)
    with pytest.raises(ValueError, match="a Flexibility of z = 31 was given for z = 21"):
        curve_of(steel, gf.OwnFlexibility(solved[1]))
    with pytest.raises(ValueError, match="'ritz' is a method of gearfe"):
        gf.OwnFlexibility(sections, name="ritz")
    with pytest.raises(ValueError, match="given = 'all'"):
        gf.OwnFlexibility(sections, given="all")
    with pytest.raises(ValueError, match="or an OwnFlexibility"):
        curve_of(steel, sections)
