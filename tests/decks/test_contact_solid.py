"""Decks of whole pairs in three dimensions: that the bodies touch, that the deck is whole, and CalculiX's verdict."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from usual import STEEL

import gearfe as gf
from gearfe.decks.contact_solid import SolidDeck
from gearfe.decks.solid_deck import FACES, TWENTY, sides_of
from gearfe.flexibility.finite_elements.hexahedron import gauss, shapes
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.tooth.profile import flank
from validation.shared import outsider
from validation.shared.decks import digest
from validation.shared.kept_rows import stored

APPROACH = 0.015  # mm
COARSE = {"per_width": 0.6}
PIT = gf.Pit(radius=14.0, z=2.0, axes=(0.4, 0.4), depth=0.2, tooth=1)


def pair_of(degrees, *, ring=False):
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}
    beta = math.radians(degrees)
    first = gf.Gear(z=13, x=0.3, r_bore=8.0, beta=beta, **rack)
    if ring:
        return gf.GearPair(first, gf.Gear(z=30, r_rim=39.0, rack_tip_radius=0.2, addendum=0.8, beta=beta, **rack))
    return gf.GearPair(first, gf.Gear(z=16, x=0.2, r_bore=10.0, beta=-beta, **rack))


def written(tmp_path, pair, **options):
    face = "helical" if pair.gear_1.beta else "spur"
    return gf.write_contact_inp(tmp_path / "p.inp", pair, 0.45, APPROACH, 300.0, (STEEL, STEEL), face=face, **options)


def depth(pair, part, order):
    """Gap [mm], as a turn of the wheel times r_b2, from the nodes of the wheel's flank of a pair to the pinion's, at equal z.

    A point of the wheel is on the pinion's flank of that pair if its angle about the pinion is that flank's.
    """
    gear = pair.gear_1
    x, y, z = part.points[:, np.unique(part.faces[f"flank {-order % pair.gear_2.z}"])]
    radius = np.hypot(x, y)
    there = (radius > gear.r_form) & (radius < gear.r_a)
    ahead = 0.45 * pair.p_bt + math.tan(gear.beta_b) * (z - (pair.gear_1.b if gear.beta > 0 else 0.0))
    turn = (pair.path[0] + ahead) / gear.r_b - math.tan(pair.alpha_wt)
    # at the pitch point, n = r_b tan(alpha_wt), the flank's point is straight above the centre
    pitch = flank(gear, np.array(gear.r_b * math.tan(pair.alpha_wt)))[1]
    own = flank(gear, np.sqrt(np.maximum(radius**2 - gear.r_b**2, 0.0)))[1] - pitch + turn + 2 * math.pi * order / gear.z
    return ((np.arctan2(x, y) - own) * gear.r_b)[there]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the ring's tip:UserWarning")
@pytest.mark.parametrize(("degrees", "ring"), [(15.0, False), (15.0, True), (-15.0, False), (0.0, False)])
def test_flanks_touch_along_their_lines_and_nowhere_overlap(tmp_path, degrees, ring):
    pair = pair_of(degrees, ring=ring)
    deck = written(tmp_path, pair)
    for order in deck.slaves:
        gap = depth(pair, deck.parts[1], order)
        assert gap.min() > -2e-3 * 0.5  # nodes only; conjugate flanks share their contact line and nothing else
        assert gap.min() < 5e-3
    assert sorted(deck.slaves) == ([0, 1] if degrees else [0])


def test_hexahedra_of_a_mirrored_ring_are_right_handed(tmp_path):
    slopes = shapes(gauss(2)[0])[1]
    for part in written(tmp_path, pair_of(15.0, ring=True)).parts:
        nodes = part.points[:, part.cells[np.argsort(TWENTY)]]
        assert np.linalg.det(np.einsum("dkm,kcq->mqdc", nodes, slopes)).min() > 0


@pytest.fixture(scope="module")
def damaged(tmp_path_factory):
    """Path and deck of a pair with a pit on the pinion's tooth 1 and a crack of half the width in the wheel."""
    folder = tmp_path_factory.mktemp("deck")
    damage = {"pinion": [PIT], "wheel": [gf.Crack(level=0.4, width=(0.0, 3.0))]}
    return folder / "p.inp", written(folder, pair_of(15.0), damage=damage, **COARSE)


@pytest.mark.slow
def test_deck_is_whole(damaged):
    path, deck = damaged
    text = path.read_text()
    tets, bricks = (part.cells.shape[1] for part in deck.parts)
    assert (len(deck.parts[0].cells), len(deck.parts[1].cells)) == (10, 20)
    assert text.count("*CONTACT PAIR") == text.count("*CONTACT PRINT") == len(deck.slaves) == 2
    rows = text.split("*ELEMENT, TYPE=C3D20R")[1].split("*MATERIAL")[0].splitlines()[1::2]
    assert [int(row.split(",")[0]) for row in rows] == list(range(tets + 1, tets + bricks + 1))
    for part in deck.parts:  # every face of a flank is a side of one element
        for name, faces in part.faces.items():
            if name.startswith("flank"):
                element, side = sides_of(part.cells, faces)
                assert element.size == faces.shape[1]
                corners = np.array(FACES[len(part.cells)])[side].T
                assert (np.sort(part.cells[corners, element], axis=0).sum() == faces.sum()).all()
    assert deck.parts[1].faces["crack 0 body"].shape == deck.parts[1].faces["crack 0 tooth"].shape
    assert deck.parts[1].points[2, deck.parts[1].faces["crack 0 body"]].max() <= 3.0 + 1e-9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"face": "spur"}, "but the gears have beta"),
        ({"face": "herringbone"}, "but the gears have beta"),
        ({"pose": "left"}, "must be one of"),
        ({"damage": {"ring": []}}, "'pinion' and 'wheel'"),
        ({"face": None, "damage": {"pinion": [gf.Crack(level=0.3)]}}, "cannot contain damage"),
        ({"face": None, "damage": None, "misalignment": gf.Misalignment(F_beta_x=0.01)}, "this deck is a section"),
        ({"damage": {"pinion": [PIT, gf.Crack(level=0.3, width=(0.0, 3.0))]}}, "through the whole width"),
        ({"pits": "filled", "damage": {"pinion": [gf.Crack(level=0.3)]}}, "damage contains no pit"),
        ({"pits": "holes", "damage": {"pinion": [PIT]}}, "must be one of"),
    ],
)
def test_impossible_decks_are_refused(tmp_path, options, message):
    run = {"face": "helical"} | options
    with pytest.raises(ValueError, match=message):
        gf.write_contact_inp(tmp_path / "p.inp", pair_of(15.0), 0.45, APPROACH, 300.0, (STEEL, STEEL), **run)


def test_a_line_load_has_its_resultant_and_stays_on_the_flank(tmp_path):
    gear = pair_of(15.0).gear_1
    deck = gf.write_line_inp(tmp_path / "g.inp", gear, 14.0, 100.0, STEEL, half_width=0.4, refine=0.4)
    assert abs(np.linalg.norm(deck.load.sum(axis=0)) / 600.0 - 1) < 2e-3
    axial = deck.load.sum(axis=0)[2] / np.linalg.norm(deck.load.sum(axis=0))
    assert abs(axial - math.sin(gear.beta_b)) < 2e-3
    with pytest.raises(ValueError, match="extends beyond the flank"):
        gf.write_line_inp(tmp_path / "g.inp", gear, gear.r_a, 100.0, STEEL)
    with pytest.raises(RuntimeError, match="does not exist"):
        deck.deflection(tmp_path / "none.dat")


@pytest.mark.slow
@pytest.mark.parametrize("name", list(outsider.lines()))
def test_line_loads_on_file_are_of_the_decks_written_today(name, tmp_path):
    """A rule of the mesh that changes makes rows of another mesh of them, which do not repeat."""
    mesh = outsider.LINE_MESHES[0]  # the coarser, in which rules of least numbers of edges decide
    row = outsider.stored()[name, outsider.told(mesh)]
    assert outsider.line_deck(tmp_path, name, mesh).part.points.shape[1] == row["nodes"]
    assert digest(tmp_path / "gear.inp") == row["deck"]


@pytest.mark.parametrize("name", ["ring, healthy", *(pytest.param(n, marks=pytest.mark.slow) for n in stored(outsider.OURS))])
def test_the_energy_model_is_that_of_the_frozen_page(name):
    """Without pits, it is within 0.5 % of CalculiX on the finest mesh."""
    found, known = outsider.ritz3d_row(name), stored(outsider.OURS)[name]
    assert found == pytest.approx({key: known[key] for key in found}, rel=1e-4)
    if "pits" not in name:
        runs = [row for (case, _), row in outsider.stored().items() if case == name]
        assert found["value"] == pytest.approx(max(runs, key=lambda row: row["nodes"])["theirs"], rel=5e-3)


PRINTED = """ statistics for slave set C1P{k}, master set C2P{k} and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

   {wrench}

   center of gravity and mean normal

   {middle} 8.81E-01  4.05E-01 -2.43E-01
"""


def test_what_pairs_carry_is_read_from_forces_and_moments(tmp_path):
    """A force at a place has its moment; where the line of action is nearest to the area's middle is that place's height."""
    place, force, middle = np.array([-1.6, 13.1, 2.9]), np.array([-1070.0, -490.0, 296.0]), np.array([-1.6, 13.1, 2.9])
    aside = np.cross(force, [1.0, 2.0, 3.0])  # the area's middle is off the line, at right angles
    wrench = [*force, *np.cross(place, force)]
    rows = [PRINTED.format(k=k, wrench=" ".join(f"{v:.6E}" for v in own), middle="{:.6E} {:.6E} {:.6E}".format(*(middle + aside)))
            for k, own in ((0, wrench), (1, 6 * [0.0]))]  # fmt: skip
    (tmp_path / "p.dat").write_text("\n".join(rows), encoding="ascii")
    deck = SolidDeck((), (), (), (), {0: (0, None), 1: (0, None)})
    found = deck.carried(tmp_path / "p.dat")
    assert list(found) == [0]  # the other does not touch
    np.testing.assert_allclose(found[0], (np.linalg.norm(force), 2.9), rtol=1e-5)
    (tmp_path / "p.dat").write_text("")
    with pytest.raises(RuntimeError, match="no contact forces"):
        deck.carried(tmp_path / "p.dat")


def test_a_deck_carries_the_modified_flanks(tmp_path):
    """The pinion's flanks that may touch lie behind their involutes by what is removed there, in the place of their phase."""
    pair = pair_of(15.0)
    flanks, askew = {"pinion": gf.Flank(helix_crowning=0.02, tip_relief=0.01, tip_start_roll=5.0)}, gf.Misalignment(F_beta_x=0.01)
    deck = written(tmp_path, pair, flanks=flanks, misalignment=askew)
    form, part, gear = flank_forms(pair, flanks, askew)[0], deck.parts[0], pair.gear_1
    assert deck.slaves
    for order in deck.slaves:
        faces = part.faces[f"flank {order % gear.z}"]
        x, y, z = part.points[:, np.unique(faces)]
        radius = np.hypot(x, y)
        there = (radius > gear.r_form) & (radius < gear.r_a)
        roll = np.sqrt(radius[there] ** 2 - gear.r_b**2)
        removed = form.at(z[there]).removed(roll) + form.at(z[there]).shift(np.zeros(roll.size, dtype=int))
        seen = SimpleNamespace(points=part.points, faces={f"flank {-order % pair.gear_2.z}": faces})
        np.testing.assert_allclose(-depth(pair, seen, order), removed, atol=1e-6)
        assert np.ptp(removed) > 0.01
