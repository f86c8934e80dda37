"""Stress intensity of a growing crack under loads on its tooth and the neighbours, by `fe` or by `ritz`."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.polynomial import chebyshev
from scipy.sparse import csc_matrix, hstack

from ..flexibility.energy.ritz.join import join
from ..flexibility.energy.ritz.panel import SectionModel, panel
from ..flexibility.energy.ritz.plane import loaded_places
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES, face_columns
from ..flexibility.finite_elements.one_tooth import edge_lengths, narrow_load
from ..flexibility.tip import face_factor
from ..geometry.aliases import Floats
from ..geometry.damage.crack import check_sector
from ..geometry.kept import keeping
from ..geometry.mesh.outline import stations
from ..geometry.mesh.section_mesh import section
from ..geometry.mesh.sector import sector
from ..geometry.mesh.sector_outline import CUT
from ..geometry.mesh.slotted_sector import check_sides, near_slots, relative_slots, side_radii
from ..geometry.tooth.profile import arc_at
from .fracture import ring, tip_reads

PLACES = 24  # number of load positions on a flank, between which K is a polynomial of the roll length
MIDDLE = 0.8  # part of the sector in which a crack tip of `ritz` may lie; at 0.82, K had an error of 2 %
WIDE = 0.05  # half-width of a load of `fe` [m_n]; at 0.12, K of a tip 0.6 m_n below the load had an error of 1.3 %


@dataclass(frozen=True, slots=True)
class TipResponse:
    """Opening of the faces of a crack and stress intensity at its tip, under line loads.

    Attributes
    ----------
    under : dict of int to callable
        By tooth: from roll lengths (n,) [mm] to the opening of k facing nodes, K_I and K_II ``(n, k + 2)`` under 1 N/mm.
    apart : ndarray, shape (k + 2, k)
        The same under unit forces that push facing nodes apart.
    """

    under: dict[int, Callable[[Floats], Floats]]
    apart: Floats

    def free(self, loads: dict[int, tuple[Floats, Floats]]) -> Floats:
        """Return opening, K_I and K_II ``(phases, k + 2)`` for crack faces that may overlap.

        `loads` are roll lengths [mm] and line loads [N/mm] by tooth.
        """
        return np.array([load[:, None] * self.under[tooth](roll) for tooth, (roll, load) in loads.items()]).sum(axis=0)

    def in_contact(self, free: Floats) -> Floats:
        """Return K_I and K_II ``(2,)`` at one phase for crack faces in unilateral contact.

        Pressures p solve ``opening + apart p >= 0, p >= 0``, complementary, as nonnegative least squares of the Cholesky factor.
        """
        opening, intensity = free[:-2], free[-2:]
        if (opening >= 0).all():
            return intensity
        root = np.linalg.cholesky(self.apart[:-2])
        pressure, _ = scipy.optimize.nnls(root.T, -np.linalg.solve(root, opening))
        return intensity + self.apart[-2:] @ pressure


def ritz_response(gear, material, crack, teeth, refine, held=None, slots=()):
    """Return the `TipResponse` by the energy model, for a bore held over the arcs `held` [rad] and a body with `slots`.

    ValueError if a crack leaves its sector, or an end of a slot nearly touches the side of one.
    """
    check_sector(gear, crack, MIDDLE)
    model, ends = SectionModel(gear, material, refine=float(refine)), sorted(loaded_places(gear)[[0, -1]])
    check_sides(gear, slots)
    radii, differ = side_radii(gear, slots), bool(held or slots)
    turns = (2 * math.pi * tooth / gear.z for tooth in range(gear.z if differ else 1))
    near = [near_slots(relative_slots(slots, turn), math.pi / gear.z) for turn in turns]
    parts = [(*_held_parts(gear, held, tooth), own, radii) for tooth, own in enumerate(near)]
    if held and not any(any(on) for _, on, *_ in parts):
        raise ValueError(f"held = {held} rad: no part of the held circle lies there, so that the gear can move")
    loaded = {tooth % gear.z for tooth in teeth}
    panels = {t: _support(model, parts[t if differ else 0], t in loaded) for t in (range(gear.z) if differ else loaded)}
    cuts, on, own, _ = parts[0]
    made = sector(gear, (crack,), refine=model.refine, cuts=cuts, slots=own, radii=radii)
    panels[0] = panel(model, made, _places(*ends), intensity=True, fixed=_fixed(made, cuts, on))
    opening = join(gear, panels, _support(model, parts[0], False))[1]
    under = {tooth: _between(*ends, opening[tooth % gear.z]) for tooth in teeth}
    return TipResponse(under, opening["influence"][:, :-2])


def _held_parts(gear, held, tooth):
    """Return angles [rad] that divide the held edge of a sector, and which parts are held (None: all)."""
    pitch = math.pi / gear.z
    if held is None:
        return (), None
    ends = (np.ravel(held) - 2 * pitch * tooth + math.pi) % (2 * math.pi) - math.pi
    cuts = np.unique(ends[np.abs(ends) < (1 - CUT) * pitch].round(9))
    middles = np.convolve([-pitch, *cuts, pitch], [0.5, 0.5], "valid") + 2 * pitch * tooth
    return tuple(cuts.tolist()), tuple(_on_arcs(middles, held).tolist())


def _fixed(made, cuts, on):
    """Return a mask of the held edges of a sector, or None if all are held."""
    if on is None:
        return None
    angle = np.arctan2(*made.points[:, made.held])
    return np.array(on)[np.searchsorted(cuts, (angle[1:] + angle[:-1]) / 2)]


@keeping(256)
def _support(model, parts, loaded):
    """Return the `Panel` of a healthy sector: `parts` are cuts and held parts of its edge, its slots, and radii at its sides."""
    cuts, on, slots, radii = parts
    gear, made = model.gear, sector(model.gear, refine=model.refine, cuts=cuts, slots=slots, radii=radii)
    places = _places(*sorted(loaded_places(gear)[[0, -1]])) if loaded else np.zeros(0)
    return panel(model, made, places, fixed=_fixed(made, cuts, on))


def _places(low, high):
    """Roll lengths [mm] of the loads: Chebyshev points."""
    return (low + high) / 2 + (high - low) / 2 * chebyshev.chebpts2(PLACES)


def _between(low, high, values):
    """Return the function from roll lengths (n,) [mm] to ``(n, k)`` that interpolates `values` ``(k, PLACES)`` at `_places`."""
    factors = np.linalg.solve(chebyshev.chebvander(chebyshev.chebpts2(PLACES), PLACES - 1), values.T)
    return lambda roll: chebyshev.chebvander((2 * np.clip(roll, low, high) - low - high) / (high - low), PLACES - 1) @ factors


def fe_response(gear, material, crack, teeth, refine, carried, held=None, slots=()):
    """Return the `TipResponse` by finite elements, as `ritz_response`, for roll lengths within `carried` [mm]."""
    edge = edge_lengths(gear, EDGES, refine)
    edge["fillet"] /= 2
    roll = stations(gear, edge["flank"])
    mesh = section(
        gear, dict.fromkeys(teeth, roll), fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"], cracks=[crack],
        slots=slots,
    )  # fmt: skip
    body = HeldSection(mesh.mesh if held is None else _partly_held(mesh.mesh, held), material)
    low, high = gear.flank_rolls
    # A single position becomes a short range.
    carried = max(carried[0] - 0.02 * gear.m_n, low), min(carried[1] + 0.02 * gear.m_n, high)
    places = _places(*carried)
    units = [narrow_load(mesh, tooth, float(arc_at(gear, place)), WIDE * gear.m_n) for tooth in teeth for place in places]
    faces, seam = face_columns(mesh), mesh.seams[0].faces
    columns = hstack([*units, faces, csc_matrix(tip_reads(body, seam).T)])
    between, n = body.between(columns), len(units)
    under, apart = between[n:, :n].copy(), between[n:, n:-2]
    _, place, q = ring(mesh.mesh, seam)
    at = seam[0, :-2]
    apart[-2] += face_factor(np.hypot(*place[:, at]), q[at])

    split = under.reshape(under.shape[0], len(teeth), PLACES)
    return TipResponse({tooth: _between(*carried, split[:, i]) for i, tooth in enumerate(teeth)}, apart)


def _partly_held(mesh, arcs):
    """Return the mesh with the held edge restricted to edges whose middle lies on one of the `arcs` [rad]."""
    edges = mesh.boundaries["held"]
    kept = _on_arcs(np.arctan2(*mesh.doflocs[:, mesh.nvertices + edges]), arcs)
    if kept.sum() < 2:
        raise ValueError(f"held = {arcs} rad: fewer than two edges of the held circle lie there, so that the gear can move")
    return mesh.with_boundaries({"held": edges[kept], "free": edges[~kept]})


def _on_arcs(angle, arcs):
    """Return a mask of the angles [rad] that lie on one of the `arcs` [rad]."""
    return np.any([(angle - start) % (2 * math.pi) <= stop - start for start, stop in arcs], axis=0)
