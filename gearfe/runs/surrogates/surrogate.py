"""`Surrogate`: stiffness curves of `ritz` by polynomials within stated ranges, with an error from further cases."""

import json
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from ...core.file_readers import read_npz
from ...core.files import Content, check_output, save_as
from ...core.record import check_keys
from ...geometry.aliases import Floats, StrPath
from ...geometry.pair.gear_pair import GearPair
from ...geometry.tooth.gear import Gear
from ...stiffness.curve import StiffnessCurve
from ...stiffness.phases import phase_array
from .space import Space, space_of
from .zoned import DEGREE, at, piece_of

TITLE = "gearfe surrogate, version 1"
ERRORS = ("mean", "worst", "cases")  # entries printed by `repr`


@dataclass(frozen=True, slots=True)
class Surrogate:
    """Fitted surrogate of `mesh_stiffness` by ``ritz``, made by `fit_surrogate`.

    ::

        ln k(phase; p) = sum_n c_n(p) T_n(u),   c_n(p) = sum_a w_na P_a1(p_1) ... P_ad(p_d)

    u is the place within a piece of the mesh cycle, whose ends are polynomials of the inputs p as well; T are Chebyshev's, P
    Legendre's polynomials, on the range of each input.

    Attributes
    ----------
    space : Space
        Pair, ranges of the inputs, and fixed inputs.
    powers : ndarray of int, shape (terms, d)
        Degrees of the products of Legendre polynomials.
    weights : ndarray, shape (terms, breaks + pieces * (DEGREE + 1))
        Weights of the breaks of the mesh cycle, then of the coefficients of ln k.
    error : dict of str to float
        Relative differences of k from `ritz` on cases that had no part in the fit: ``mean`` over all their phases, ``worst`` of
        any phase, ``worst mean k`` of the mean of a case, and the number of ``cases`` and ``phases``. The discretisation error of
        `ritz` itself (`mesh_stiffness` with ``error=True``) is not included.
    worst : ndarray, shape (pieces,)
        Largest relative difference by piece of the mesh cycle.
    meta : dict
        Cases, degrees, seconds, material, versions: all that is needed to repeat it.
    """

    space: Space
    powers: NDArray[np.int64]
    weights: Floats
    error: dict[str, float]
    worst: Floats
    meta: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ValueError if an error is missing."""
        check_keys("Surrogate: error", self.error, ERRORS)

    def __repr__(self):
        """Return one line with the ranges and the error."""
        ranges = ", ".join(f"{name} {low:g} to {high:g}" for name, (low, high) in self.space.ranges.items())
        mean, worst = (100 * self.error[name] for name in ("mean", "worst"))
        accuracy = f"on {self.error['cases']} fresh cases off by {mean:.2g} % on average, {worst:.2g} % at worst"
        return f"<Surrogate of ritz: {ranges}; {accuracy}>"

    def k(self, phase: ArrayLike, **point: float) -> Floats:
        """Return the secant stiffness [N/m] at phases of any shape, in a few microseconds each, for models of dynamics.

        Parameters
        ----------
        phase : float or ndarray
            Mesh phases. Without a crack any, continued periodically; with one those of the tooth's engagement and a little before
            and after it.
        **point : float
            A value for each of the ranges, in their units (N, rad).

        Raises
        ------
        ValueError
            If a value is missing or outside its range, or a phase outside the engagement.
        """
        breaks, series = self._parts(self.space.point(point))
        return np.exp(at(self._within(phase, breaks), breaks, series))

    def curve(self, phases: int | ArrayLike = 64, **point: float) -> StiffnessCurve:
        """Return the curve of the surrogate at a point as a `StiffnessCurve`, for machines, tables and files.

        Parameters
        ----------
        phases : int or array
            Number per mesh cycle, or the phases themselves. With a crack a number spans the tooth's engagement, as
            ``span="tooth"`` does.
        **point : float
            As for `k`.

        Returns
        -------
        StiffnessCurve
            ``k``, ``deflection`` and ``error``, the worst difference found in that zone of the mesh cycle; its `zones` give mean
            and zone values. Load shares, pressures and tangent are not fitted: nan.
        """
        values = self.space.point(point)
        breaks, series = self._parts(values)
        phase = self._phases(phases, breaks)
        inside = self._within(phase, breaks)
        k = np.exp(at(inside, breaks, series))
        inputs = self.space.held | dict(zip(self.space.ranges, values, strict=True))
        none, width = np.full((phase.size, 1), np.nan), self.space.pair.b_w
        meta = self.meta["curve"] | {
            "method": "surrogate of ritz", "inputs": inputs, "force_N": inputs["force"], "width_mm": width, "error": self.error,
            "eps_alpha": float(int(self.meta["pairs"]) + 1 + 2 * breaks[0]),  # The first break is half the zone with fewer pairs.
        }  # fmt: skip
        return StiffnessCurve(
            phase=phase, k=k, k_tangent=none[:, 0], deflection=inputs["force"] / k,
            order=np.array([0]), force=none, pressure=none,
            error=k * self.worst[piece_of(inside, breaks)], meta=meta,
        )  # fmt: skip

    def _parts(self, values):
        """Return breaks and coefficients at a point."""
        basis = legendre.legvander(self.space.scaled(values), int(self.powers.max()))
        terms = basis[np.arange(len(values)), self.powers].prod(axis=1)
        out = terms @ self.weights
        count = self.worst.size + 1
        return out[:count], out[count:].reshape(-1, DEGREE + 1)

    def _within(self, phase, breaks):
        phase = np.asarray(phase, dtype=float)
        if not self.space.cracked:
            return breaks[0] + (phase - breaks[0]) % 1.0
        if phase.size and not (breaks[0] <= phase.min() and phase.max() <= breaks[-1]):
            raise ValueError(
                f"phases from {phase.min():g} to {phase.max():g}, but the curve of the cracked tooth covers {breaks[0]:.4g} to "
                f"{breaks[-1]:.4g}: other phases belong to other teeth"
            )
        return phase

    def _phases(self, phases, breaks):
        if np.ndim(phases) or not self.space.cracked:
            return phase_array(phases, "cycle", self.space.pair)
        count = phase_array(phases, "cycle", self.space.pair).size
        return np.arange(np.ceil(breaks[0] * count), np.floor(breaks[-1] * count) + 1) / count

    def save(self, path: StrPath) -> None:
        """Write to a numpy archive (``.npz``), plain arrays and JSON.

        Raises
        ------
        ValueError
            If the suffix is another, or the file cannot be written.
        """
        check_output(path, "surrogate")
        gears = {f"gear_{i + 1}": asdict(gear) for i, gear in enumerate(self.space.pair.gears)}
        inputs = {**self.space.ranges, **self.space.held}
        meta = {"title": TITLE, "gears": gears, "a": self.space.pair.a, "inputs": inputs, "error": self.error, "meta": self.meta}
        arrays = {"powers": self.powers, "weights": self.weights, "worst": self.worst}
        save_as(".npz", path, Content(TITLE, {}, arrays, meta, {"worst": "-"}))

    @classmethod
    def load(cls, path: StrPath) -> "Surrogate":
        """Read a file written by `save`. Nothing is unpickled.

        Raises
        ------
        ValueError
            If the file is no such archive.
        """
        archive = read_npz(path)
        try:
            meta = json.loads(str(archive["meta"]))
            if meta["title"] != TITLE:
                raise ValueError(f"its title is {meta['title']!r}")
            gears = [Gear(**meta["gears"][name]) for name in ("gear_1", "gear_2")]
            inputs = {name: tuple(value) if isinstance(value, list) else value for name, value in meta["inputs"].items()}
            space = space_of(GearPair(gears[0], gears[1], meta["a"]), inputs)
            out = cls(space, archive["powers"], archive["weights"], meta["error"], archive["worst"], meta["meta"])
            _check_shapes(out)
        except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
            raise ValueError(f"{path} is no surrogate written by gearfe: {error}") from error
        return out


def _check_shapes(surrogate):
    terms, inputs = surrogate.powers.shape
    pieces = surrogate.worst.size
    if inputs != len(surrogate.space.ranges) or surrogate.weights.shape != (terms, pieces + 1 + pieces * (DEGREE + 1)):
        raise ValueError(f"{terms} terms of {inputs} inputs do not match weights of shape {surrogate.weights.shape}")
    if surrogate.powers.dtype.kind != "i" or not np.isfinite(surrogate.weights).all() or not np.isfinite(surrogate.worst).all():
        raise ValueError("its powers are no whole numbers, or its weights not finite")
