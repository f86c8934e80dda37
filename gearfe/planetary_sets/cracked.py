"""A gear with cracks as its healthy self with some sectors exchanged: how its teeth and its rim move each other.

A cracked sector differs from a healthy one by D in the stiffness of its sides and held edge, and by what its loads q put there.
With v the unknowns of all sectors, E those that the cracked sectors touch, and K the healthy block-circulant stiffness::

    (K + E D E') v = f    =>    w = E' v = (I + G D)^-1 E' K^-1 f,    v = K^-1 (f - E D w),    G = E' K^-1 E

so that a healthy gear, solved once, and a small matrix give any cracked one exactly. Of a ring that nothing holds, K^-1 is
without the motion of the whole, which D does not resist. The faces of the cracks are taken as free.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..geometry.mesh.periodic_sector import periodic_sector
from .whole_gear import PLACES, WholeGear, in_chain, sector_stiffness


class Cracks(NamedTuple):
    """Cracked teeth of a gear: D ``(c, N, N)`` and q ``(c, N, 2 PLACES)`` of each, N unknowns: a sector's, the next one's side.

    `side` are the places of a side among the unknowns of a sector.
    """

    whole: WholeGear
    teeth: tuple[int, ...]
    softer: NDArray[np.float64]
    loads: NDArray[np.float64]
    side: NDArray[np.int64]


class Cracked(NamedTuple):
    """A cracked gear under unit loads on its teeth ``(z, 2 PLACES)``: n unknowns of all c cracked sectors together.

    `table` ``(z, 2 PLACES, z, 2 PLACES)`` displacements of the loads as of `WholeGear.held`; `reached` ``(n, z, 2 PLACES)`` of
    the cracked sectors; `solve` ``(n, n)`` is ``(I + G D)^-1``.
    """

    cracks: Cracks
    green: NDArray[np.float64]
    table: NDArray[np.float64]
    reached: NDArray[np.float64]
    solve: NDArray[np.float64]


def cracks_of(whole: WholeGear, found: Any, refine: float) -> Cracks:
    """`Cracks` of a gear from a sequence of `Crack`, their teeth counted clockwise."""
    healthy = periodic_sector(whole.gear, refine=refine)
    own, next_, side = in_chain(healthy)
    order = np.concatenate([own, next_])
    plain = sector_stiffness(healthy, whole.material)[0]
    teeth = tuple(sorted({crack.tooth % whole.gear.z for crack in found}))
    softer, loads = [], []
    for tooth in teeth:
        hurt = [crack for crack in found if crack.tooth % whole.gear.z == tooth]
        matrix, push, _ = sector_stiffness(periodic_sector(whole.gear, hurt, refine=refine), whole.material)
        softer.append((matrix - plain)[np.ix_(order, order)])
        loads.append(push[order])
    return Cracks(whole, teeth, np.array(softer), np.array(loads), side)


def cracked(cracks: Cracks, inverse: NDArray[np.complex128]) -> Cracked:
    """`Cracked` from the inverses ``(h, n, n)`` of the healthy gear's harmonics, as what holds its edge makes them."""
    whole, z = cracks.whole, cracks.whole.gear.z
    green = np.fft.irfft(inverse, n=z, axis=0)
    pushed = np.fft.irfft(inverse @ whole.push, n=z, axis=0)
    own = np.fft.irfft(np.conj(whole.push.transpose(0, 2, 1)) @ inverse @ whole.push, n=z, axis=0)
    among = np.block([[_between(green, cracks.side, (a - b) % z) for b in cracks.teeth] for a in cracks.teeth])
    softer, q = _blocks(cracks)
    solve = np.linalg.inv(np.eye(among.shape[0]) + among @ softer)
    reach = _reached(cracks, pushed, np.arange(z))
    reach[:, list(cracks.teeth)] = np.einsum("ij,jtp->itp", among, q)
    after = np.einsum("ij,jtp->itp", solve, reach)
    apart = (np.arange(z)[:, None] - np.arange(z)) % z
    table = own[apart].transpose(0, 2, 1, 3) - np.einsum("itp,ij,juq->tpuq", reach, softer, after, optimize=True)
    rows = np.einsum("itp,iuq->tpuq", q, after, optimize=True)
    table[list(cracks.teeth)] = rows
    table[:, :, list(cracks.teeth)] = rows.transpose(2, 3, 0, 1)
    return Cracked(cracks, green, table, after, solve)


def _between(green, side, d):
    """Displacement ``(N, N)`` of a sector's and its next one's side by forces on those of a sector d before it."""
    z = green.shape[0]
    back, ahead = green[(d - 1) % z][:, side], green[(d + 1) % z][side]
    return np.block([[green[d], back], [ahead, green[d][np.ix_(side, side)]]])


def _reached(cracks, moved, sources):
    """Unknowns of the cracked sectors ``(n, sources, loads)`` in displacements ``(z, n, loads)`` by loads on sector 0."""
    z = cracks.whole.gear.z
    parts = []
    for tooth in cracks.teeth:
        parts += [moved[(tooth - sources) % z], moved[(tooth + 1 - sources) % z][:, cracks.side]]
    return np.concatenate(parts, axis=1).transpose(1, 0, 2)


class OnPads(NamedTuple):
    """What cracks of a ring change of its pads, p of them: added to how they move each other ``(p, p)``, and to `by_teeth`."""

    among: NDArray[np.float64]
    by_teeth: NDArray[np.float64]
    moved: "Moved"


class Moved(NamedTuple):
    """Forces on the n unknowns of cracked sectors of the healthy ring that stand for the cracks, and how its edge moves.

    `teeth` are those whose loads these forces replace; `by_loads` ``(n, z, PLACES)``, `by_pads` ``(n, p)``, and `edge` ``(z, r,
    n)`` the displacement of the edge.
    """

    teeth: tuple[int, ...]
    by_loads: NDArray[np.float64]
    by_pads: NDArray[np.float64]
    edge: NDArray[np.float64]


def on_pads(of: Cracked, inverse: NDArray[np.complex128], load: NDArray[np.float64], before: NDArray[np.float64]) -> OnPads:
    """`OnPads` of nodal forces `load` ``(z, r, p)`` of the pads, which teeth moved by `before` ``(p, z, PLACES)``."""
    whole, cracks, z = of.cracks.whole, of.cracks, of.cracks.whole.gear.z
    r, size = whole.edge, of.solve.shape[0]
    softer, q = _blocks(cracks)
    waves = inverse[:, :, :r] @ np.fft.rfft(load, axis=0)
    field = np.fft.irfft(waves, n=z, axis=0)
    reach = np.concatenate([part for tooth in cracks.teeth for part in (field[tooth], field[(tooth + 1) % z][cracks.side])])
    after = of.solve @ reach
    among = -reach.T @ softer @ after
    teeth = before - np.einsum("ip,ij,jta->pta", reach, softer, of.reached[:, :, :PLACES], optimize=True)
    teeth[:, list(cracks.teeth)] = np.einsum("ica,ip->pca", q[:, :, :PLACES], after)
    by_loads = -np.einsum("ij,jta->ita", softer, of.reached[:, :, :PLACES])
    by_loads[:, list(cracks.teeth)] += q[:, :, :PLACES]
    edge = np.zeros((z, r, size))
    for k, tooth in enumerate(cracks.teeth):
        at, step = k * cracks.loads.shape[1], whole.stiffness.shape[1]
        edge[:, :, at : at + step] = of.green[(np.arange(z) - tooth) % z, :r]
        edge[:, :, at + step : at + cracks.loads.shape[1]] = of.green[(np.arange(z) - tooth - 1) % z, :r][:, :, cracks.side]
    return OnPads((among + among.T) / 2, teeth, Moved(cracks.teeth, by_loads, -softer @ after, edge))


def _blocks(cracks):
    """D ``(n, n)`` and q ``(n, c, 2 PLACES)`` of all cracked sectors together."""
    count, size = cracks.loads.shape[:2]
    softer, q = np.zeros((count * size,) * 2), np.zeros((count * size, count, cracks.loads.shape[2]))
    for k in range(count):
        at = slice(k * size, (k + 1) * size)
        softer[at, at], q[at, k] = cracks.softer[k], cracks.loads[k]
    return softer, q
