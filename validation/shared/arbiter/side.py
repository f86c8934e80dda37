"""Loaded side of a tooth as one curve from root to tip: points by arc length, normals, and opposite points."""

import numpy as np

SAMPLES = 801  # samples per segment for its arc length
STEP = 1e-5  # step for the tangent of a segment
TRIES, FINER = 400, 17  # sample points in the search for a crossing, then in its refinement


class Side:
    """Loaded side of the teeth of an `Outline`: arc length s [mm] from the root circle, ``joints`` between its curves.

    Angles are counted from the tooth's centre-line towards the loaded side, without pitch deviation.
    """

    def __init__(self, outline):
        self.outline, self.sign = outline, outline.outward
        self._t, self._s, at = [], [], 0.0
        for low, high, place in outline.pieces:
            t = np.linspace(low, high, SAMPLES)
            radius, angle = place(t)
            arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff([radius * np.sin(angle), radius * np.cos(angle)])))])
            self._t.append(t)
            self._s.append(at + arc)
            at += arc[-1]
        self.joints = np.array([s[0] for s in self._s] + [at])

    def at_radius(self, radius):
        """Return arc lengths of radii on fillet, flank and tip edge."""
        last = len(self._s) - 1
        radii = np.concatenate([place(t)[0] for (_, _, place), t in zip(self.outline.pieces[:last], self._t, strict=False)])
        s, sign = np.concatenate(self._s[:last]), self.sign
        return np.interp(sign * np.asarray(radius), sign * radii, s)

    def piece(self, s):
        """Return the number of the curve that contains arc lengths `s`."""
        return np.clip(np.searchsorted(self.joints, s, side="right") - 1, 0, len(self._s) - 1)

    def parameter(self, s):
        """Return the index of the piece of the outline and its parameter at arc lengths `s` [mm]."""
        s = np.asarray(s, dtype=float)
        piece, t = self.piece(s), np.empty(s.shape)
        for number in np.unique(piece):
            at = piece == number
            t[at] = self._along(number, s[at], self._s, self._t)
        return piece, t

    def arc(self, piece, t):
        """Return the arc length of a parameter of a curve."""
        return self._along(piece, np.asarray(t, dtype=float), self._t, self._s)

    def _along(self, number, x, given, wanted):
        rising = given[number][-1] > given[number][0]
        order = slice(None) if rising else slice(None, None, -1)
        return np.interp(x, given[number][order], wanted[number][order])

    def place(self, s):
        """Return radius and angle at `s`."""
        s = np.asarray(s, dtype=float)
        radius, angle = np.empty(s.shape), np.empty(s.shape)
        piece, t = self.parameter(s)
        for number in np.unique(piece):
            at = piece == number
            radius[at], angle[at] = self.outline.pieces[number][2](t[at])
        return radius, angle

    def normal(self, s):
        """Return the outward normal at `s` as an angle from the tooth centre-line, clockwise positive."""
        s = np.asarray(s, dtype=float)
        out = np.empty(s.shape)
        piece, t = self.parameter(s)
        for number in np.unique(piece):
            low, high, place = self.outline.pieces[number]
            at, step = piece == number, STEP * (high - low)
            middle = np.clip(t[at], *sorted((low + step, high - step)))
            (r_0, a_0), (r_1, a_1) = place(middle - step), place(middle + step)
            dx, dy = r_1 * np.sin(a_1) - r_0 * np.sin(a_0), r_1 * np.cos(a_1) - r_0 * np.cos(a_0)
            out[at] = np.arctan2(self.sign * dy, -self.sign * dx)
        return out


class Posed:
    """A `Side` of one tooth in the plane: rotation, height of its centre, sense of angles, and elastic shift (x, y)."""

    def __init__(self, side, turn, centre, mirror, behind=0.0, shift=(0.0, 0.0)):
        self.side, self.turn, self.centre, self.mirror, self.behind, self.shift = side, turn, centre, mirror, behind, shift

    def points(self, s):
        """Coordinates x, y ``(2, n)`` [mm] of the outline at the parameters `s`."""
        radius, angle = self.side.place(s)
        turned = self.turn + self.mirror * (angle - self.behind)
        return np.array([radius * np.sin(turned) + self.shift[0], radius * np.cos(turned) + self.centre + self.shift[1]])

    def normals(self, s):
        """Outward unit normals ``(2, n)``."""
        turned = self.turn + self.mirror * (self.side.normal(s) - self.behind)
        return np.array([np.sin(turned), np.cos(turned)])

    def opposite(self, points, normals, near, reach):
        """Return gaps and places s at which lines through `points` along `normals` cross this curve near `near` (else nan)."""
        low, high = max(near - reach, 0.0), min(near + reach, self.side.joints[-1])
        # Samples are dense at `near`, and joints of segments are samples.
        part = np.linspace(-1, 1, TRIES)
        s = near + reach * np.sign(part) * np.abs(part) ** 3
        inside = self.side.joints[(self.side.joints > low) & (self.side.joints < high)]
        s = np.unique(np.concatenate([s[(s > low) & (s < high)], [low, high], inside - 1e-9, inside + 1e-9]))
        tangents = np.array([normals[1], -normals[0]])
        first, last = self._crossing(points, tangents, normals, np.broadcast_to(s, (points.shape[1], s.size)))
        for _ in range(3):
            grid = first[:, None] + (last - first)[:, None] * np.linspace(0, 1, FINER)
            first, last = self._crossing(points, tangents, normals, grid)
        ends = np.array([first, last])
        off = self.points(ends.ravel()).reshape(2, 2, -1) - points[:, None, :]
        across = (off * tangents[:, None, :]).sum(axis=0)
        part = np.clip(across[0] / np.where(across[0] == across[1], 1.0, across[0] - across[1]), 0.0, 1.0)
        at = first + part * (last - first)
        gap = ((off[:, 0] + part * (off[:, 1] - off[:, 0])) * normals).sum(axis=0)
        return gap, at

    def _crossing(self, points, tangents, normals, grid):
        """Return the ends of the interval of each row of `grid` in which its line crosses the curve nearest to its point."""
        flat = np.where(np.isfinite(grid), grid, 0.0)
        x, y = self.points(flat.ravel()).reshape(2, *grid.shape) - points[:, :, None]
        across = np.where(np.isfinite(grid), x * tangents[0][:, None] + y * tangents[1][:, None], np.nan)
        along = np.abs(x * normals[0][:, None] + y * normals[1][:, None])
        crosses = across[:, :-1] * across[:, 1:] <= 0
        distance = np.where(crosses, along[:, :-1], np.inf)
        best, rows = np.argmin(distance, axis=1), np.arange(grid.shape[0])
        none = ~crosses.any(axis=1)
        return np.where(none, np.nan, grid[rows, best]), np.where(none, np.nan, grid[rows, best + 1])
