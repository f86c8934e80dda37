"""Decks and pictures of loaded sets: where the pads are drawn, and what cannot be meshed."""

import math

import numpy as np
import pytest
from independent import AT, STANDS, small
from numpy.testing import assert_allclose
from sets import case, unequal

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection
from gearfe.planetary_sets.shape import loaded_shapes
from validation.shared.kept_rows import stored

PADS = gf.RimSupports(6, 4.8, first=0.2)


def solved(given, at=0.3):
    return gf.planetary_stiffness(given, [at])


@pytest.mark.slow
@pytest.mark.parametrize("name", STANDS)
def test_forces_of_all_meshes_are_those_of_calculix(name):
    """A planet ahead by 2 um; CalculiX solved the deck of `gearfe.write_set_inp` with all flanks in contact."""
    row = stored("sets_calculix")[name]
    force = gf.planetary_stiffness(small(STANDS[name]), [AT]).force[:, 0]
    assert_allclose(force, list(row["forces"].values()), rtol=2.2e-3)
    assert_allclose(force, list(row["ours"].values()), rtol=1e-4, err_msg="page sets")


@pytest.mark.slow
def test_the_ring_is_drawn_still_where_its_pads_are(monkeypatch):
    """The marks of the picture lie on nodes of the rim that do not move; in the middle between two of them the rim does."""
    drawn = []
    monkeypatch.setattr("gearfe.planetary_sets.shape.draw_set", lambda *args, **_: drawn.append(args))
    gf.plot_planetary_set(solved(case(ring=PADS)))
    ((shapes, marks, _),) = drawn
    assert len(shapes) == 5
    place, moved = shapes[-1].place, np.hypot(*shapes[-1].moved)
    rim = np.hypot(*place) > 95.0 * (1 - 1e-9)
    angle, moved = np.arctan2(*place[:, rim]), moved[rim]

    def nearest(to):
        return np.abs((angle - to + math.pi) % (2 * math.pi) - math.pi).argmin()

    pads = np.arctan2(*marks)
    assert_allclose(moved[[nearest(one) for one in pads]], 0, atol=1e-12)
    assert min(moved[nearest(one + math.pi / 6)] for one in pads) > 0.01 * moved.max()


@pytest.mark.slow
@pytest.mark.parametrize(("gear", "at"), [("sun", 0.9375), ("planet1", 0.6875), ("ring", 0.7)])
def test_a_drawn_crack_takes_the_work_that_the_set_computes(monkeypatch, gear, at):
    """Forces and stiffness of all meshes give the work of the crack; the picture meshes the gears again."""
    work, solve, damaged = [], HeldSection.solve, {gear: [gf.Crack(level=0.3)]}
    monkeypatch.setattr(HeldSection, "solve", lambda self, load: work.append((load, solve(self, load))) or work[-1][1])
    drawn, expected = [], []
    for damage in (None, damaged):
        curves = gf.planetary_stiffness(case(damage=damage), [at], error=False)
        work.clear()
        loaded_shapes(curves, [0])
        drawn.append(sum(float((load * moved).sum()) for load, moved in work) * curves.meta["case"].width)
        expected.append(1e3 * (curves.force**2 / curves.k).sum())
    assert_allclose(drawn[1] - drawn[0], expected[1] - expected[0], rtol=0.05)


def surfaces(deck):
    """Segments ``(n, 2, 2)`` of the contact surfaces of a deck by name, and the pairs of names."""
    node, element, surface, pairs, name = {}, {}, {}, [], ""
    for line in deck.read_text(encoding="ascii").splitlines():
        row = [one.strip() for one in line.split(",")]
        if line.startswith("*"):
            kind, name = row[0], row[-1] if len(row) < 2 else row[1].removeprefix("NAME=")
        elif kind == "*NODE":
            node[int(row[0])] = np.array(row[1:3], dtype=float)
        elif kind == "*ELEMENT":
            element[int(row[0])] = [int(one) for one in row[1:]]
        elif kind == "*SURFACE":
            own, face = element[int(row[0])], int(row[1][1]) - 1
            one, middle, two = (node[own[k]] for k in (face, 3 + face, (face + 1) % 3))
            surface.setdefault(name, []).extend([(one, middle), (middle, two)])
        elif kind == "*CONTACT PAIR":
            pairs.append(row)
    return {name: np.array(one) for name, one in surface.items()}, pairs


def apart(nodes, segments):
    """Least distance [mm] of nodes ``(n, 2)`` from segments ``(m, 2, 2)``."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    away = nodes[:, None] - start
    part = np.clip((away * along).sum(axis=2) / (along**2).sum(axis=1), 0, 1)
    return float(np.hypot(*(away - part[:, :, None] * along).transpose(2, 0, 1)).min())


@pytest.mark.parametrize(
    "given",
    [
        pytest.param(case(), id="equal", marks=pytest.mark.slow),
        pytest.param(unequal(0, 30, 71, ring=PADS), id="unequal", marks=pytest.mark.slow),
    ],
)
def test_flanks_of_the_deck_touch(given, tmp_path):
    """Flanks that are to touch do so in the deck, before it is loaded: in each mesh one pair within 0.1 um."""
    deck = tmp_path / "set.inp"
    written = gf.write_set_inp(deck, solved(given), 0, per_width=3.0)
    surface, pairs = surfaces(deck)
    least = {}
    for names in pairs:
        bodies = tuple(sorted(name.split("T")[0] for name in names))
        one, two = (surface[name] for name in names)
        least[bodies] = min(least.get(bodies, 1.0), apart(one[:, 0], two))
    assert len(least) == 6
    assert max(least.values()) < 1e-4
    with pytest.raises(RuntimeError, match="run 'ccx -i NAME'"):  # a result of CalculiX that is not there
        written.forces(tmp_path / "set.dat")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (lambda: case(ring=gf.RimBed(1e4, 1e4)), "neither held nor on rigid pads"),
        (lambda: case(ring=gf.RimSupports(6, 4.8, radial=1e5)), "neither held nor on rigid pads"),
        (lambda: case(flanks={"sun": gf.Flank(tip_relief=0.01, tip_start_diameter=44.5)}), "modified flanks"),
    ],
)
def test_sets_that_are_not_meshed_gear_by_gear_are_refused(given, message, tmp_path):
    found = solved(given())
    for make in (lambda: gf.plot_planetary_set(found), lambda: gf.write_set_inp(tmp_path / "set.inp", found, 0)):
        with pytest.raises(ValueError, match=message):
            make()
    assert not list(tmp_path.iterdir())


def test_a_planet_without_load_has_no_place_in_a_deck(tmp_path):
    found = solved(unequal(0, 35, 70, errors=[(0, -0.1), (0, 0), (0, 0)]).with_(force=50.0))
    with pytest.raises(ValueError, match="planet 2 is unloaded"):
        gf.write_set_inp(tmp_path / "set.inp", found, 0)
    ((shapes, _),) = loaded_shapes(found, [0])
    assert not all(carry := (found.force[0, 0] > 0).tolist())
    assert [bool(np.abs(one.moved).max() > 1e-6) for one in shapes[1:-1]] == carry
