"""`StiffnessCurve`: mesh stiffness over one mesh cycle in SI units, with all data to repeat the computation."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.extras import missing
from ..core.files import save, save_as
from ..core.record import check_rows
from ..core.units import NEWTON_PER_UM
from ..figures.inline import line_svg
from ..figures.stiffness_plots import plot_curves
from ..flexibility.section_contact import MARKS
from ..geometry.aliases import Floats, StrPath
from ..geometry.renamed import renamed
from .curve_file import content, read_fields

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@renamed(lte="deflection", lte_supports="support_deflection")
@dataclass(frozen=True, slots=True)
class StiffnessCurve:
    """Time-varying mesh stiffness (TVMS) along the line of action.

    Attributes
    ----------
    phase : ndarray, shape (n,)
        Mesh phase: 0 when a pair enters at the start of the path of contact, 1 one transverse base pitch later.
    k : ndarray, shape (n,)
        Secant stiffness [N/m]: force divided by `deflection`.
    k_tangent : ndarray, shape (n,)
        Tangent stiffness dF/dx [N/m]; nan of a surrogate.
    deflection : ndarray, shape (n,)
        Loaded minus unloaded transmission error, as a length on the line of action [m]; ``k = force / deflection``, also if a
        light load leaves pairs open.
    order : ndarray, shape (pairs,)
        Numbers of the tooth pairs in the columns below: pair k is k base pitches ahead of the newest.
    force : ndarray, shape (n, pairs)
        Force of each pair [N]; nan if a model gives only the total stiffness.
    pressure : ndarray, shape (n, pairs)
        Largest contact pressure of each pair [Pa]; nan for methods without one.
    error : ndarray, shape (n,) or None
        Estimated discretisation error of k [N/m], if requested.
    unloaded : ndarray, shape (n,) or None
        Unloaded transmission error [m]: 0 for involutes, otherwise where the first pair of modified flanks touches.
    support_deflection : ndarray, shape (n,) or None
        Part of `deflection` by shafts and springs under the hubs [m], its mean weighted with the contact loads; None for rigid
        bores.
    meta : dict
        Gears, centre distance, load, materials, method, resolution, versions: all that is needed to repeat it.
    """

    phase: Floats
    k: Floats
    k_tangent: Floats
    deflection: Floats
    order: NDArray[np.int64]
    force: Floats
    pressure: Floats
    error: Floats | None = None
    meta: dict[str, Any] = field(default_factory=dict)
    unloaded: Floats | None = None
    support_deflection: Floats | None = None

    def __post_init__(self) -> None:
        """Check that there is a row for each phase."""
        check_rows(self, "phase k k_tangent deflection force pressure error unloaded support_deflection")

    def __repr__(self):
        """Return one line with method, phases, load and the range of k."""
        meta = self.meta
        load = f", {meta['force_N']:g} N on {meta['width_mm']:g} mm" if {"force_N", "width_mm"} <= meta.keys() else ""
        k = self.k / NEWTON_PER_UM
        text = f"{k.min():.4g} to {k.max():.4g} N/um, mean {k.mean():.4g}"
        phases = f"{self.phase.size} phase{'s' if self.phase.size > 1 else ''} from {self.phase[0]:.3g} to {self.phase[-1]:.3g}"
        return f"<StiffnessCurve by {meta.get('method', '?')}: {phases}{load}, k {text}>"

    def _repr_html_(self) -> str:
        """Return the same line with a small picture of k, which notebooks display."""
        return f"<p>{escape(repr(self))}</p>{line_svg(self.phase, self.k / NEWTON_PER_UM, 'phase', 'k [N/um]')}"

    def to_pandas(self) -> Any:
        """Return the curve as a `pandas.DataFrame`, one row for each phase.

        Columns have units in their names, as in the CSV table; the index is ``phase [-]``; ``attrs`` holds `meta`. RuntimeError
        if pandas is missing; the message names what to install.
        """
        try:
            import pandas
        except ImportError as error:
            raise missing("pandas", error) from error
        columns = dict(content(self).columns)
        index = pandas.Index(columns.pop("phase [-]"), name="phase [-]")
        table = pandas.DataFrame(columns, index=index)
        table.attrs = dict(self.meta)
        return table

    def to_xarray(self) -> Any:
        """Return the curve as an `xarray.Dataset` with named axes ``phase`` and ``order`` (the tooth pair), units in ``attrs``.

        ``k``, ``k_tangent``, ``deflection`` and, if there is one, ``error`` over ``phase``; ``force`` and ``pressure`` over both.
        RuntimeError if xarray is missing; the message names what to install.
        """
        try:
            import xarray
        except ImportError as error:
            raise missing("xarray", error) from error
        table = content(self)
        names = [name for name in table.arrays if name not in ("phase", "order")]
        axes = {1: ("phase",), 2: ("phase", "order")}
        values = {n: (axes[table.arrays[n].ndim], table.arrays[n], {"units": table.units[n]}) for n in names}
        return xarray.Dataset(values, coords={"phase": self.phase, "order": self.order}, attrs=dict(self.meta))

    def __call__(self, phase: ArrayLike) -> NDArray:
        """Return the secant stiffness [N/m] at phases of any shape for dynamic models, by linear interpolation.

        Phases that cover whole mesh cycles are continued periodically. The phases of a damaged tooth's engagement
        (``span="tooth"``) are not, because another tooth is in mesh before and after them. There, a ValueError is raised.
        """
        phases = np.asarray(phase)
        if phases.dtype.kind not in "iuf" or not np.isfinite(phases).all():
            raise ValueError(f"phase = {phase!r}, but give finite numbers")
        order = np.argsort(self.phase)
        known, k = self.phase[order], self.k[order]
        steps = np.diff(known)
        if known.size > 1 and 0 < known[0] + 1 - known[-1] <= 1.5 * steps.max():
            return np.interp(phases, known, k, period=1.0)
        if phases.size and (phases.min() < known[0] or phases.max() > known[-1]):
            raise ValueError(
                f"phase from {phases.min():g} to {phases.max():g}, but this curve covers {known[0]:g} to {known[-1]:g}, not a "
                "whole mesh cycle: compute one with span='cycle' for a healthy pair"
            )
        return np.interp(phases, known, k)

    @property
    def te(self) -> Floats:
        """Loaded transmission error (LTE) ``(n,)`` [m], including the unloaded part, as a length on the line of action."""
        return self.deflection if self.unloaded is None else self.deflection + self.unloaded

    def without_supports(self) -> "StiffnessCurve":
        """Return the curve without the compliance of the supports. The load distribution still contains their effect.

        It is for models with separate shafts and bearings. The tangent stiffness is computed with the secant compliance of the
        shafts, which is exact for hubs that do not tilt.
        """
        if self.support_deflection is None:
            return self
        added = -self.support_deflection / self.meta["force_N"]
        return replace(self.with_compliance(added), support_deflection=None)

    def with_compliance(self, added: ArrayLike) -> "StiffnessCurve":
        """Return the curve in series with an additional compliance, such as that of other gears of a planetary set.

        Parameters
        ----------
        added : float or ndarray, shape (n,)
            Compliance at the phases [m/N].

        Returns
        -------
        StiffnessCurve
        """
        added = np.asarray(added, dtype=float)
        deflection = self.deflection + self.meta["force_N"] * added
        error = None if self.error is None else self.error * (self.deflection / deflection) ** 2
        k, k_tangent = self.meta["force_N"] / deflection, 1 / (1 / self.k_tangent + added)
        return replace(self, k=k, k_tangent=k_tangent, deflection=deflection, error=error)

    @property
    def share(self) -> Floats:
        """Load sharing ratio of each pair ``(n, pairs)``. Rows sum to 1."""
        return self.force / self.force.sum(axis=1, keepdims=True)

    def zones(self) -> dict[str, float]:
        """Return the mean stiffness [N/m] by zone: ``single``, ``double`` (or more pairs), ``mean``, ``max``.

        Zones that contain none of the phases are omitted. Helical teeth have no zones ``single`` and ``double``.
        """
        out = {name: float(self.k[rows].mean()) for name, rows in self._rows().items()}
        return out | {"mean": float(self.k.mean()), "max": float(self.k.max())}

    def zone_errors(self) -> dict[str, float]:
        """Relative error estimates of the values of `zones`.

        The result is empty if no estimate was requested.
        """
        if self.error is None:
            return {}
        means = {"mean": slice(None), **self._rows()}
        out = {name: float(self.error[rows].mean() / self.k[rows].mean()) for name, rows in means.items()}
        return out | {"max": float((self.error / self.k)[np.argmax(self.k)])}

    def _rows(self):
        if self.meta.get("face") in ("helical", "herringbone"):
            return {}  # Contact lines with different numbers of pairs have no zones.
        inside = (self.phase + 1e-9) % 1.0 <= self.meta["eps_alpha"] % 1.0 + 2e-9
        low = int(self.meta["eps_alpha"])
        names = {1: "single", 2: "double", 3: "triple"}
        zones = {names.get(pairs, f"{pairs} pairs"): rows for pairs, rows in ((low, ~inside), (low + 1, inside))}
        return {name: rows for name, rows in zones.items() if rows.any()}

    def save(self, path: StrPath) -> None:
        """Write to `path`. Its suffix selects the format: ``.csv``, ``.npz``, ``.mat`` or ``.json``."""
        save(path, "curve", content(self))

    def to_csv(self, path: StrPath) -> None:
        """Write a CSV table with a header of units and meta data.

        `from_csv` reads it back exactly if the phases rise.
        """
        save_as(".csv", path, content(self))

    @classmethod
    def from_csv(cls, path: StrPath) -> "StiffnessCurve":
        """Read a table of `to_csv`. Raises ValueError if the file is not such a table, or its phases do not rise."""
        return cls(**read_fields(path))

    def plot(self, path: StrPath | None = None, title: str | None = None) -> "Figure":
        """Draw the curve under a `title` (default: teeth, damage and load). Save to `path` if given.

        The figure's ``axes`` are two: the stiffness, and below it the load shares. A notebook shows it.
        """
        return plot_curves({self.meta.get("method", "k"): self}, path, title)


def joined(curves: Sequence[StiffnessCurve]) -> StiffnessCurve:
    """Join consecutive curves of the same gears and load. Columns are ordered by the number of the tooth pair."""
    order = np.unique(np.concatenate([curve.order for curve in curves]))

    def rows(name: str) -> Floats:
        out = [np.zeros((curve.phase.size, order.size)) for curve in curves]
        for part, source in zip(out, curves, strict=True):
            part[:, np.searchsorted(order, source.order)] = getattr(source, name)
        return np.concatenate(out)

    def row(name: str) -> Floats | None:
        parts = [getattr(curve, name) for curve in curves]
        if all(part is None for part in parts):
            return None
        return np.concatenate([np.zeros(c.phase.size) if part is None else part for c, part in zip(curves, parts, strict=True)])

    whole = {
        name: np.concatenate([getattr(curve, name) for curve in curves]) for name in ("phase", "k", "k_tangent", "deflection")
    }
    return StiffnessCurve(
        **whole,
        order=order,
        force=rows("force"),
        pressure=rows("pressure"),
        error=row("error"),
        meta=_meta_of(curves),
        unloaded=row("unloaded"),
        support_deflection=row("support_deflection"),
    )


def _meta_of(curves: Sequence[StiffnessCurve]) -> dict[str, Any]:
    """Return `meta` of the first curve, with the marked phases of all curves."""
    marked = [name for name in MARKS if any(name in curve.meta for curve in curves)]
    return curves[0].meta | {name: [at for curve in curves for at in curve.meta.get(name, ())] for name in marked}
