"""Stress intensity of a growing crack under loads on its tooth and the neighbours, by `fe` or by `ritz`."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import nnls
from scipy.sparse import csc_matrix, hstack

from ..flexibility.energy.ritz.join import join
from ..flexibility.energy.ritz.panel import SectionModel, panel
from ..flexibility.energy.ritz.plane import PLACES, carry, loaded_places, loaded_sector
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES, face_columns
from ..flexibility.finite_elements.one_tooth import edge_lengths, narrow_load
from ..flexibility.tip import face_factor
from ..geometry.aliases import Floats
from ..geometry.damage.crack import check_sector
from ..geometry.mesh.outline import stations
from ..geometry.mesh.section_mesh import section
from ..geometry.mesh.sector import sector
from ..geometry.tooth.profile import arc_at
from .fracture import ring, tip_reads

FE_PLACES = 9  # number of load positions on a flank; `fe` interpolates between them by a cubic spline
MIDDLE = 0.8  # part of the sector in which a crack tip of `ritz` may lie; at 0.82, K had an error of 2 %
WIDE = 0.12  # half-width of a load of `fe` [m_n]


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
        """Return opening, K_I and K_II ``(phases, k + 2)`` with faces free to overlap.

        `loads` are roll lengths [mm] and line loads [N/mm] by tooth.
        """
        return np.array([load[:, None] * self.under[tooth](roll) for tooth, (roll, load) in loads.items()]).sum(axis=0)

    def in_contact(self, free: Floats) -> Floats:
        """K_I and K_II ``(2,)`` at one phase, with the faces kept from overlapping.

        Pressures p solve ``opening + apart p >= 0, p >= 0``, complementary, as nonnegative least squares of the Cholesky factor.
        """
        opening, intensity = free[:-2], free[-2:]
        if (opening >= 0).all():
            return intensity
        root = np.linalg.cholesky(self.apart[:-2])
        pressure, _ = nnls(root.T, -np.linalg.solve(root, opening))
        return intensity + self.apart[-2:] @ pressure


def ritz_response(gear, material, crack, teeth, refine):
    """`TipResponse` by the energy model. ValueError if the crack leaves its sector."""
    check_sector(gear, crack, MIDDLE)
    model = SectionModel(gear, material, refine=float(refine))
    healthy = loaded_sector(model, ())
    places = loaded_places(gear)
    cracked = panel(model, sector(gear, (crack,), refine=model.refine), places, intensity=True)
    panels = {tooth % gear.z: cracked if tooth == 0 else healthy for tooth in teeth}
    opening = join(gear, panels, healthy)[1]

    def under(values):
        return lambda roll: carry(gear, arc_at(gear, np.clip(roll, *sorted(places[[0, -1]])))) @ values.T

    return TipResponse({t: under(opening[t % gear.z][:, :PLACES]) for t in teeth}, opening["influence"][:, :-2])


def fe_response(gear, material, crack, teeth, refine, carried, held=None):
    """`TipResponse` by finite elements, for roll lengths within `carried` [mm] and a bore held over the arcs `held` [rad]."""
    edge = edge_lengths(gear, EDGES, refine)
    edge["fillet"] /= 2
    roll = stations(gear, edge["flank"])
    mesh = section(
        gear, dict.fromkeys(teeth, roll), fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"], cracks=[crack]
    )
    body = HeldSection(mesh.mesh if held is None else _on_arcs(mesh.mesh, held), material)
    low, high = sorted((gear.roll_f, gear.roll_a))
    # A single position becomes a short range.
    carried = max(carried[0] - 0.02 * gear.m_n, low), min(carried[1] + 0.02 * gear.m_n, high)
    places = np.linspace(*carried, FE_PLACES)
    units = [narrow_load(mesh, tooth, float(arc_at(gear, place)), WIDE * gear.m_n) for tooth in teeth for place in places]
    faces, seam = face_columns(mesh), mesh.seams[0].faces
    columns = hstack([*units, faces, csc_matrix(tip_reads(body, seam).T)])
    between, n = body.between(columns), len(units)
    under, apart = between[n:, :n].copy(), between[n:, n:-2]
    _, place, q = ring(mesh.mesh, seam)
    at = seam[0, :-2]
    apart[-2] += face_factor(np.hypot(*place[:, at]), q[at])

    def fitted(values):
        curve = CubicSpline(places, values.T)
        return lambda roll: curve(np.clip(roll, *carried))

    split = under.reshape(under.shape[0], len(teeth), FE_PLACES)
    return TipResponse({tooth: fitted(split[:, i]) for i, tooth in enumerate(teeth)}, apart)


def _on_arcs(mesh, arcs):
    """Return the mesh held only where the middle of an edge lies on one of the `arcs` [rad]."""
    edges = mesh.boundaries["held"]
    angle = np.arctan2(*mesh.doflocs[:, mesh.nvertices + edges])
    kept = np.zeros(edges.size, dtype=bool)
    for start, stop in arcs:
        kept |= (angle - start) % (2 * math.pi) <= stop - start
    if kept.sum() < 2:
        raise ValueError(f"held = {arcs} rad: fewer than two edges of the held circle lie there, so that the gear can move")
    return mesh.with_boundaries({"held": edges[kept], "free": edges[~kept]})
