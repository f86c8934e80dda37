"""`SetCurves`: mesh stiffness, loads and motions of a planetary set over its positions, in SI units."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.files import save
from ..core.record import check_keys
from ..core.units import NEWTON_PER_UM
from ..figures.set_plot import draw_curves
from ..geometry.aliases import Floats, StrPath
from .rim import rim_angles, rim_moved
from .set_file import MESHES, content

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class SetCurves:
    """Result of `planetary_stiffness`: a planetary set over p positions.

    The first axis of length 2 is the kind of mesh: 0 sun and planet, 1 planet and ring.

    Attributes
    ----------
    position : ndarray, shape (p,)
        Rotation of the sun in its pitches.
    force : ndarray, shape (2, p, planets)
        Load of each mesh along its line of action [N].
    k : ndarray, shape (2, p, planets)
        Stiffness of each mesh in the set [N/m]: its force divided by the approach after the first touch, due to the rotations and
        shifts of its two gears. It includes the deflection `rim` of the ring and its supports. It is 0 for an unloaded mesh.
    k_alone : ndarray, shape (2, p, planets)
        Stiffness of the isolated pair under the mean force, both gears held at their bore or rim [N/m].
    rim : ndarray, shape (2, p, planets)
        Deflection of the ring's supports in each mesh, along the line of action [m]; 0 for meshes of the sun and a held ring.
    gap : ndarray, shape (2, p, planets)
        Unloaded gap of each mesh by modified flanks and pin position errors [m].
    te : ndarray, shape (p,)
        Loaded transmission error of the set [m]: the rotation of the sun ahead of a fixed carrier and ring, times its base
        radius.
    orbit : ndarray, shape (p, 2)
        Displacement x, y of the sun's axis [m]; 0 of a sun that is held.
    pair_force : ndarray, shape (2, p, planets, pairs)
        Load of each pair of teeth [N]; `order` numbers the pairs.
    tooth : ndarray of int, shape (2, p, planets, pairs)
        Tooth number of each pair, counted clockwise: of the sun in meshes with the sun, of the planet in meshes with the ring.
        -1 if there is no pair.
    order : ndarray of int, shape (pairs,)
        Number of base pitches by which a pair of teeth is ahead of the pair that came into contact last.
    ring_angle : ndarray, shape (n,)
        Angles of nodes on the ring's outer edge, clockwise from its tooth 0 [rad]; empty unless the ring is on pads.
    ring_moved : ndarray, shape (p, n, 2)
        Displacements of these nodes, outwards and clockwise [m].
    meta : dict
        ``"case"``: the `PlanetaryCase`. ``"error"``: the relative errors that `set_error` estimates, if asked for. ``"left_out"``
        ``(2, planets)``: relative uncertainty of k by the contact model where tips touch off the path of contact. ``"shut"``:
        positions at which faces of a crack touch. ``"seconds_flexibility"``, ``"seconds_contact"``: time taken [s].
    """

    position: Floats
    force: Floats
    k: Floats
    k_alone: Floats
    rim: Floats
    gap: Floats
    te: Floats
    orbit: Floats
    pair_force: Floats
    tooth: NDArray[np.int64]
    order: NDArray[np.int64]
    ring_angle: Floats
    ring_moved: Floats
    meta: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ValueError if the case is missing."""
        check_keys("SetCurves: meta", self.meta, ("case",))

    def __repr__(self):
        """Return one line with planets, positions, stiffness of both kinds of mesh, and load factor."""
        mean = [one[one > 0].mean() / NEWTON_PER_UM for one in self.k]
        told = ", ".join(f"k {name} {value:.4g} N/um" for name, value in zip(MESHES, mean, strict=True))
        return f"<SetCurves: {self.force.shape[2]} planets, {self.position.size} positions, {told}, K_gamma {self.K_gamma:.4g}>"

    @property
    def share(self) -> Floats:
        """Load of each mesh relative to the mean of its kind ``(2, p, planets)``, 1 for equal load sharing."""
        return self.force / self.force.mean(axis=2, keepdims=True)

    @property
    def K_gamma(self) -> float:  # noqa: N802  # the symbol of ISO 6336-1
        """Mesh load factor K_gamma of ISO 6336-1: the largest load share of any mesh at any position."""
        return float(self.share.max())

    @property
    def k_without_rim(self) -> Floats:
        """Return `k` without the deflection `rim` [N/m], for machines in which the ring is a body on separate springs."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.k > 0, self.force / (self.force / self.k - self.rim), 0.0)

    def save(self, path: StrPath) -> None:
        """Write to `path`. Its suffix selects the format: ``.csv``, ``.npz``, ``.mat`` or ``.json``."""
        save(path, "curve", content(self))

    def plot(self, path: StrPath | None = None, *, dpi: int = 120) -> "Figure":
        """Draw stiffness and load of every mesh and the transmission error. Save to `path` if given."""
        return draw_curves(self, path, dpi=dpi)

    @classmethod
    def of(cls, of: Any, meshes: Any, position: Floats, found: list[Any], meta: dict[str, Any]) -> "SetCurves":
        """Build the curves from solved positions (`gearfe.planetary_sets.assembly.Position`)."""
        case, p = of.case, len(found)
        width, n = case.width, case.planets
        loads, closing, rim, gap = (
            np.array([getattr(one, name) for one in found]).transpose(1, 0, 2) for name in ("loads", "closing", "rim", "gap")
        )
        even = case.force / width
        alone, left_out = np.array(
            [[[meshes.alone(i, k, j, even) for j in range(n)] for i in range(p)] for k in (0, 1)]
        ).transpose(3, 0, 1, 2)
        orders = np.array(sorted({pair[2] for one in found for pair in one.pairs}))
        pair_force, tooth = np.zeros((2, p, n, orders.size)), np.full((2, p, n, orders.size), -1)
        teeth = case.gears.sun.z, case.gears.planet.z
        for i, one in enumerate(found):
            for inner, planet, order, number, load in one.pairs:
                at = inner, i, planet, int(np.searchsorted(orders, order))
                pair_force[at], tooth[at] = load * width, number % teeth[inner]
        carries = loads > 0
        k = np.where(carries, loads * width / np.where(carries, closing * 1e-3, 1.0), 0.0)
        angle, moved = _rim_of(of, found)
        marks = {"shut": [at for at, one in zip(position.tolist(), found, strict=True) if one.shut]}
        return cls(
            position, loads * width, k, even * width / (alone * 1e-3), rim * 1e-3, gap * 1e-3,
            np.array([one.turn for one in found]) * 1e-3, np.array([one.orbit for one in found]) * 1e-3,
            pair_force, tooth, orders, angle, moved * 1e-3, {"case": case, "left_out": left_out.max(axis=1)} | marks | meta,
        )  # fmt: skip


def _rim_of(of, found):
    """Return angles and displacements [mm] of the rim of a ring on supports."""
    rim = of.bodies.rim
    if rim.pads is None:
        return np.zeros(0), np.zeros((len(found), 0, 2))
    moved, faces, p = [], of.bodies.faces.get("ring"), rim.reaction.shape[0]
    for one in found:
        if of.case.ring.pushes:
            tractions, whole = one.lugs, one.whole
        else:
            tractions, whole = (np.einsum("pta,ta->p", values, one.on_ring) for values in (rim.reaction, rim.moves))
            if faces:
                gripped = rim.grip @ (faces.pads @ one.opened)
                tractions, whole = tractions + gripped[:p], whole + gripped[p:]
        by_cracks = (faces.edge @ one.opened).reshape(-1, 2) if faces else 0.0
        moved.append(rim_moved(rim, one.on_ring, tractions, whole) + by_cracks)
    return rim_angles(rim.whole), np.array(moved)
