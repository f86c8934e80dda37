"""Second-order elements that fold, where CalculiX stops: found, and tets bent less."""

import math
from dataclasses import replace

import numpy as np
import pytest
from usual import STEEL

import gearfe as gf
from gearfe.decks.solid_deck import element_lines, holed_part, part_of
from gearfe.flexibility.finite_elements.folds import check_folds, jacobians, unfolded
from gearfe.flexibility.finite_elements.hexahedron import TWENTY
from gearfe.flexibility.finite_elements.tetrahedron import EDGES
from gearfe.geometry.mesh.holed_drawing import on_outline
from gearfe.geometry.mesh.holes import Holed, holed_sector
from gearfe.geometry.mesh.solid import solid
from gearfe.geometry.tooth.profile import cartesian, fillet_length, flank, root_curve
from validation.shared import outsider

GEAR = outsider.pinion()


def place(radius, angle, z):
    return np.array([*cartesian(radius, angle + GEAR.twist_rate * z), z])


def across_the_form_circle():
    """One tet with a face on the fillet and one on the flank above, nearly in one plane, as gmsh made it in a whole gear."""
    s = np.linspace(0.0, fillet_length(GEAR), 2000)
    radius, angle = root_curve(GEAR, s)
    low = np.abs(radius - 12.26207342).argmin()
    at_form = [place(*flank(GEAR, GEAR.roll_f), z) for z in (2.88539088, 0.0)]
    below = place(radius[low], angle[low], 1.43559562)
    above = place(*flank(GEAR, math.sqrt(13.09385656**2 - GEAR.r_b**2)), 1.43872938)
    points = np.array([*at_form, below, above]).T
    cells = np.arange(4)[:, None]
    if np.linalg.det((points[:, 1:] - points[:, :1]).T) < 0:
        cells = cells[[1, 0, 2, 3]]
    faces = {"flank 0": np.array([[0], [1], [3]]), "held": np.zeros((3, 0), dtype=int)}
    return Holed(GEAR, points, cells, np.array([-1]), faces, (0.0, 0.0, 0.0))


def test_a_tet_that_would_fold_is_bent_less():
    mesh = across_the_form_circle()
    part = holed_part(mesh)
    assert jacobians(part.points, part.cells).min() > 0
    assert np.allclose(part.points[:, :4], mesh.points, atol=1e-5)  # vertices stay where they are


def test_the_flank_stays_where_it_is_to_touch():
    mesh = across_the_form_circle()
    x, y, z = mesh.points[:, [0, 3]].mean(axis=1)
    flat = cartesian(math.hypot(x, y), math.atan2(x, y) - GEAR.twist_rate * z)
    with pytest.raises(RuntimeError, match="cannot follow the flank"):
        holed_part(mesh, [(np.array([*flat, z])[:, None], 0.1, 0.05)])


def test_tets_follow_the_whole_outline():
    """Middle nodes on fillets, tips and roots lie on these: chords across the fillets made a pair 1.4 % too stiff."""
    mesh = holed_sector(GEAR, sizes={"far": 1.4, "tooth": 0.7, "fillet": 0.25})
    part = holed_part(mesh)
    ends = np.sort(part.cells[np.array(EDGES).T].reshape(2, -1), axis=0)
    middle = {(a, b): node for a, b, node in zip(*ends.tolist(), part.cells[4:].ravel().tolist(), strict=True)}
    faces = part.faces["outline"]
    edges = np.sort(np.hstack([faces[[0, 1]], faces[[1, 2]], faces[[0, 2]]]), axis=0).T.tolist()
    x, y, z = part.points[:, sorted({middle[a, b] for a, b in edges})]
    radius, angle = np.hypot(x, y), np.arctan2(x, y) - GEAR.twist_rate * z
    away = np.hypot(*(cartesian(radius, angle) - cartesian(*on_outline(GEAR, radius, angle))))
    print(f"{away.size} middle nodes, {(away > 1e-4).sum()} off the outline, by up to {away.max():.3f} mm")
    assert (away < 1e-4 * GEAR.m_n).mean() > 0.95, "all but those whose tets would fold"


def bent(amount):
    """Two unit tets with a common face; the middle of an edge of the first one only is pushed inwards."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float).T
    corners = np.array([[0, 1, 2, 3], [1, 2, 3, 4]]).T
    nodes, cells = [*points.T], [[], []]
    known = {}
    for tet in (0, 1):
        for a, b in EDGES:
            key = tuple(sorted((corners[a, tet], corners[b, tet])))
            if key not in known:
                known[key] = len(nodes)
                nodes.append(points[:, key].mean(axis=1))
            cells[tet].append(known[key])
    nodes = np.array(nodes).T
    nodes[:, known[0, 1]] += [0.0, amount, amount]
    return nodes, np.vstack([corners, np.array(cells).T]), known[0, 1]


def test_only_what_folds_is_moved():
    for amount in (0.1, 0.3, 2.0):
        nodes, cells, middle = bent(amount)
        found = unfolded(nodes, cells)
        moved = np.flatnonzero((found != nodes).any(axis=0))
        assert moved.tolist() == ([] if amount < 0.2 else [middle])
        assert (jacobians(found, cells) > 0).all()
        assert found[1, middle] >= 0


def test_the_jacobian_of_straight_elements_is_their_size():
    nodes, cells, _ = bent(0.0)
    np.testing.assert_allclose(jacobians(nodes, cells), [1.0, 2.0], rtol=1e-12)  # six times the volumes 1/6 and 1/3
    made = part_of(solid(replace(GEAR, beta=0.0), layer=3.0, refine=0.4))
    assert len(made.cells) == len(TWENTY)
    assert jacobians(made.points, made.cells).min() > 0


def test_a_deck_with_folded_elements_is_not_written():
    tets = bent(2.0)[:2]
    with pytest.raises(RuntimeError, match="1 of 2 elements of this mesh fold"):
        check_folds(*tets)
    bricks = part_of(solid(GEAR, layer=3.0, refine=0.4))
    points = bricks.points.copy()
    points[:, bricks.cells[0, 0]] = points[:, bricks.cells[6, 0]]  # a corner at the opposite one
    with pytest.raises(RuntimeError, match="elements of this mesh fold"):
        element_lines(replace(bricks, points=points), 1, 0, 0, STEEL)


@pytest.mark.slow
def test_decks_with_pits_do_not_fold(tmp_path):
    """At refine 1.7, with longer tets, CalculiX stopped at one across the form circle of an undamaged tooth."""
    pair, damage = outsider.pair_of(15.0), {"pinion": outsider.pits()}
    options = {"face": "helical", "damage": damage, "pits": "filled", "per_width": 1.0, "refine": 1.7}
    deck = gf.write_contact_inp(tmp_path / "p.inp", pair, 0.45, 0.016, 300.0, (STEEL, STEEL), **options)
    assert all(jacobians(part.points, part.cells).min() > 0 for part in deck.parts)
