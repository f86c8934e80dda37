"""A stiffness model as a text file with stated units: a table of any program, or a curve that gearfe wrote."""

import math
import re
import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.file_readers import read_text
from ..geometry.aliases import Floats, StrPath
from ..geometry.pair.gear_pair import GearPair
from ..stiffness.curve import StiffnessCurve
from ..stiffness.curve_file import FIRST_LINE
from .model_units import ABSCISSAE, ANGLES, RADII, abscissa_of, name_and_unit, stiffness_of, stiffness_unit

COARSEST = 1 / 20  # longest step between rows, relative to the mesh cycle or the active flank
SNAP = 1e-4  # tolerance for rounded angles and phases [mesh cycles]
EXACT = 1e-9  # tolerance for requested phases [mesh cycles]
DECIMAL_COMMA = re.compile(r"^([-+]?\d*),(\d+(?:e[-+]?\d+)?)$", re.IGNORECASE)
STEEP = 0.1  # increase of k between rows, relative to its mean, that indicates an entering tooth pair


@dataclass(frozen=True, slots=True, eq=False)
class ModelFile:
    """A table from a file, see `read_model`.

    Attributes
    ----------
    path : str
    abscissa : {"phase", "angle", "radius"}
        Quantity of `x`: mesh phase [-], pinion angle [rad] or pinion radius of a contact [mm].
    x, k : ndarray, shape (n,)
        Rising abscissa; stiffness [N/m], of the whole mesh or (``radius``) of one tooth pair.
    per_width : bool
        True if k is per width [N/m per m].
    phase_offset : float
        Mesh phase at which the file's abscissa is zero.
    meta : dict
        Metadata of a curve written by gearfe.
    """

    path: str
    abscissa: str
    x: Floats
    k: Floats
    per_width: bool = False
    phase_offset: float = 0.0
    meta: dict[str, Any] = field(default_factory=dict)

    def total(self, pair: GearPair, phase: ArrayLike) -> Floats:
        """Return the mesh stiffness of the file at mesh phases: [N/m], or [N/m per m] if `per_width`.

        Values between rows are interpolated linearly, but not across the phases at which a pair enters or leaves: there the
        nearest row on the same side is used. Rows of one mesh cycle are repeated. Rows of several cycles are used at their own
        phases, as required for the engagement of a damaged tooth. ValueError if the rows do not cover the requested phases, or
        are more than `COARSEST` apart.
        """
        cycle = 2 * math.pi / pair.gear_1.z if self.abscissa == "angle" else 1.0
        asked, x, k = np.asarray(phase, dtype=float), self.x / cycle, self.k
        self._check_cycle(x, cycle)
        if x[-1] - x[0] > 1 + np.diff(x).max() + SNAP:
            rows = x + self.phase_offset
            if not (rows[0] - SNAP <= asked.min() and asked.max() <= rows[-1] + SNAP):
                raise ValueError(
                    f"{self.path}: phases {rows[0]:.4g} to {rows[-1]:.4g}, but {asked.min():.4g} to {asked.max():.4g} are "
                    "needed; give them all, or keep the rows of one mesh cycle"
                )
        else:
            once = x < x[0] + 1 - SNAP
            self._check_origin(x[once] + self.phase_offset, k[once])
            cycles = np.arange(math.floor(asked.min() - EXACT) - 1, math.floor(asked.max()) + 2)[:, None]
            rows = ((x[once] + self.phase_offset + SNAP) % 1.0 - SNAP + cycles).ravel()
            k = np.tile(k[once], cycles.size)
        return self._between(rows, k, asked, pair.eps_alpha % 1.0)

    def _between(self, rows, k, asked, leaves):
        """Interpolate the stiffness between rows that have the same pairs in contact."""
        out, order = np.empty(asked.shape), np.argsort(rows)
        at, of_row = asked + EXACT, rows[order] + SNAP
        zone, zone_of_row = (2 * np.floor(x) + (x % 1.0 > leaves + 2 * slack) for x, slack in ((at, EXACT), (of_row, SNAP)))
        for one in np.unique(zone):
            row, inside = zone_of_row == one, zone == one
            if not row.any():
                low, high = (leaves, 1.0) if one % 2 else (0.0, leaves)
                raise ValueError(
                    f"{self.path}: no row from phase {low:.4g} to {high:.4g}, where another number of pairs is in contact; "
                    "give rows there"
                )
            out[inside] = np.interp(asked[inside], rows[order][row], k[order][row])
        return out

    def _check_cycle(self, x, cycle):
        span, step = x[-1] - x[0], np.diff(x).max()
        unit, scale = (" deg", 180 / math.pi) if self.abscissa == "angle" else ("", 1.0)
        start, stop, whole = scale * self.x[0], scale * self.x[-1], scale * cycle
        coverage = f"{self.path}: {self.abscissa}s {start:.6g} to {stop:.6g}{unit} cover {span:.4g} mesh cycles"
        if span + step < 1 - SNAP:
            raise ValueError(f"{coverage}, but one is needed: {start:.6g} to {start + whole:.6g}{unit}")
        if step > COARSEST + SNAP:
            finer = f"sample every {COARSEST * cycle * scale:.4g}{unit} or finer"
            raise ValueError(f"{self.path}: rows are up to {step:.4g} of a mesh cycle apart; {finer}")

    def _check_origin(self, phase, k):
        """Warn if k rises steeply where no tooth pair enters. The usual cause is another origin of the phase."""
        rise = np.diff(np.append(k, k[0]))
        top = int(np.argmax(rise))
        after = np.append(phase, phase[0] + 1)[top + 1]
        if rise[top] > STEEP * k.mean() and abs((after + 0.5) % 1.0 - 0.5) > COARSEST:
            warnings.warn(
                f"{self.path}: k rises most steeply at phase {after % 1.0:.4g}, but a pair enters at phase 0: if the file "
                f"counts from elsewhere, write '# phase_offset = {(self.phase_offset - after) % 1.0:.4g}' into it",
                stacklevel=5,
            )

    def single(self, pair: GearPair, radius: ArrayLike) -> Floats:
        """Stiffness of one tooth pair in contact at `radius` on the pinion [mm], interpolated linearly. Units as in `total`.

        ValueError if the rows do not cover the path of contact, or if two neighbours are more than `COARSEST` of its length
        apart.
        """
        low, high = np.hypot(pair.gear_1.r_b, pair.path)
        if self.x[0] > low + 1e-3 or self.x[-1] < high - 1e-3:
            raise ValueError(
                f"{self.path}: radii {self.x[0]:.6g} to {self.x[-1]:.6g} mm do not cover the active flank of the pinion, "
                f"{low:.6g} to {high:.6g} mm; give k over all of it"
            )
        step = np.diff(self.x).max()
        if step > COARSEST * (high - low):
            raise ValueError(
                f"{self.path}: rows are up to {step:.4g} mm apart; sample every {COARSEST * (high - low):.4g} mm or finer"
            )
        return np.interp(np.asarray(radius, dtype=float), self.x, self.k)


def read_model(path: StrPath, *, phase_offset: float | None = None) -> ModelFile:
    """Read a stiffness curve of any program, or one that gearfe wrote.

    A text file has two columns separated by comma, semicolon or tab. Numbers have a decimal point, or with another separator a
    decimal comma. Units are stated by a header line or by a comment line (# or %) above the numbers, in brackets or, as MATLAB's
    variable names need it, as an ending. A MATLAB file (``.mat``) has two vectors of such names:

    - first column ``phase``, ``angle [deg]``, ``angle [rad]``, ``radius [mm]``, or ``angle_deg``, ``theta_rad``, ``radius_mm``
    - second column, of any name, in N/m, N/mm, N/um (or kN, MN, GN), or per width in N/(mm um), N/(m um), which is multiplied
      by the scene's width: ``k [N/um]``, ``k_N_per_um``, ``c [N/(mm um)]``, ``c_N_per_mm_um``

    Phase and angle give the total mesh stiffness over one mesh cycle, 1 or ``2 pi / z_1``. That of a damaged pair may cover the
    whole engagement of the damaged tooth instead. Radius gives the stiffness of one tooth pair over the pinion's active flank.
    At phase 0 a pair enters at the start of the path of contact. A file with another origin states the mesh phase of its zero:
    ``# phase_offset = 0.25``.

    Parameters
    ----------
    path : path
    phase_offset : float, optional
        The same as in the file; mesh cycles, also for angles.

    Returns
    -------
    ModelFile

    Raises
    ------
    ValueError
        Naming file and line, if a unit is missing or unknown, a number is not finite, k not positive, or the abscissa not rising.
    """
    if str(path).lower().endswith(".mat"):
        return _of_matlab(path, phase_offset)
    lines = read_text(path)
    if lines[:1] == [FIRST_LINE]:
        curve = StiffnessCurve.from_csv(path)
        return ModelFile(str(path), "phase", curve.phase, curve.k, phase_offset=_finite(path, phase_offset or 0), meta=curve.meta)
    numbered = [(i, line.strip()) for i, line in enumerate(lines, 1) if line.strip()]
    comments = [line.lstrip("#% ") for _, line in numbered if line[0] in "#%"]
    rows = [(i, _cells(line)) for i, line in numbered if line[0] not in "#%"]
    if not rows:
        raise ValueError(f"{path}: no rows of numbers")
    header = rows.pop(0)[1] if not _is_number(rows[0][1][0]) else _header_comment(path, comments, rows[0][1])
    if len(header) != 2:
        raise ValueError(
            f"{path}: {len(header)} columns ({', '.join(header)}), but give two, separated by comma, semicolon or tab"
        )
    return _model(path, header, rows, _offset(path, comments, phase_offset))


def _of_matlab(path, phase_offset):
    """Return the `ModelFile` of the two vectors of a MATLAB file that state an abscissa and a stiffness."""
    from ..signal.signal_file import channels

    found = channels(path)
    units = {name: found.units.get(name, "").strip("-") for name in found.vectors}
    names = {name: f"{name} [{unit}]" if unit else name for name, unit in units.items()}
    first = next((name for name, told in names.items() if name_and_unit(told)[0] in ("phase", *ANGLES, *RADII)), None)
    second = next((name for name, told in names.items() if stiffness_unit(told)), None)
    if first is None or second is None:
        raise ValueError(f"{path}: vectors {', '.join(names)}, but it must hold {ABSCISSAE} and a stiffness such as k_N_per_m")
    rows = enumerate(zip(map(repr, found.vectors[first].tolist()), map(repr, found.vectors[second].tolist()), strict=True), 1)
    return _model(path, (names[first], names[second]), rows, None if phase_offset is None else _finite(path, phase_offset))


def _model(path, header, rows, offset):
    """Return the `ModelFile` of a table with two columns and a header of two names with units."""
    (abscissa, scale), (unit, per_width) = abscissa_of(path, header[0]), stiffness_of(path, header[1])
    x, k = _numbers(path, rows)
    if offset is not None and abscissa == "radius":
        raise ValueError(f"{path}: phase_offset = {offset:g}, but a table over the radius has no phase; leave it out")
    return ModelFile(str(path), abscissa, scale * x, unit * k, per_width, offset or 0.0)


def _cells(line):
    separator = next((s for s in ";\t," if s in line), ",")
    cells = [cell.strip().strip('"').strip() for cell in line.split(separator)]
    return cells if separator == "," else [DECIMAL_COMMA.sub(r"\1.\2", cell) for cell in cells]


def _is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _header_comment(path, comments, first):
    """Return the last comment that states a stiffness unit in its second column."""
    for comment in reversed(comments):
        cells = _cells(comment)
        if len(cells) == 2 and stiffness_unit(cells[1]):
            return cells
    raise ValueError(
        f"{path}: no header with units above the numbers {', '.join(first)!r}; write one, for example 'phase,k [N/m]' or "
        "'angle [deg],k [N/(mm um)]'"
    )


def _numbers(path, rows):
    """Convert the rows to two columns, and check them."""
    table = []
    for line, cells in rows:
        if len(cells) != 2 or not all(map(_is_number, cells)):
            hint = "; separate columns by ; if numbers have a decimal comma" if len(cells) > 2 else ""
            raise ValueError(f"{path}, line {line}: {'; '.join(cells)!r} is not a row of two numbers{hint}")
        x, k = map(float, cells)
        if not math.isfinite(x) or not (math.isfinite(k) and k > 0):
            raise ValueError(f"{path}, line {line}: {cells[0]}, {cells[1]}: both must be finite and k positive")
        if table and x <= table[-1][0]:
            raise ValueError(f"{path}, line {line}: the first column must rise, but {x:g} follows {table[-1][0]:g}")
        table.append((x, k))
    if len(table) < 2:
        raise ValueError(f"{path}: {len(table)} rows of numbers, but a stiffness curve needs at least two")
    return np.array(table).T


def _offset(path, comments, given):
    stated = [match[1] for c in comments if (match := re.fullmatch(r"(?:phase[ _])?offset\s*[:=](.*)", c, re.I))]
    values = [*stated, *([given] if given is not None else [])]
    if len(values) > 1:
        raise ValueError(f"{path}: phase_offset is given {len(values)} times ({', '.join(map(str, values))}); give it once")
    return _finite(path, values[0]) if values else None


def _finite(path, value):
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{path}: phase_offset = {str(value).strip()!r}, but give a finite number of mesh cycles")
    return number
