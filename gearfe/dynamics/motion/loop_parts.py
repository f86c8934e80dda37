"""Parts of `motion.loop` that numba compiles: table lookup, and products along consecutive memory.

The module also states how they are compiled.
"""

import contextlib
import warnings
from functools import cache
from hashlib import sha256
from pathlib import Path

import numpy as np
from numba import njit
from numba.core import event

compiled = njit(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)  # compiled at the first call


def kept(function):
    """Compile a function at its first call. The result is stored on disk if numba finds a writable folder.

    The result contains all functions that it calls, including contact laws. Any edit of their files causes a new compilation.
    """
    try:
        dispatcher = njit(cache=True, error_model="numpy", no_cfunc_wrapper=True)(function)
    except RuntimeError:  # Without a cache folder each process compiles.
        return njit(error_model="numpy")(function)
    if dispatcher is function:
        return _not_compiled
    dispatcher._cache._cache_file._source_stamp = _stamp()  # numba checks only the file of the function itself.
    return dispatcher


def _not_compiled(*_):
    raise RuntimeError("NUMBA_DISABLE_JIT is set, but the integrator needs compiled code: unset it")


@cache
def _stamp():
    """Return the digest of all files whose functions are compiled together."""
    home = Path(__file__).parent
    files = *home.glob("loop*.py"), home / "../machine/contact_law.py", *home.glob("../machine/laws/*.py")
    return sha256(b"".join(file.read_bytes() for file in sorted(files))).hexdigest()


class _Announcer(event.TimingListener):
    """Reports the compilation once, and measures its duration."""

    def __init__(self, tell):
        super().__init__()
        self.tell = tell

    def on_start(self, event):
        super().on_start(event)
        if self.tell:
            tell, self.tell = self.tell, None
            tell("compiling the integrator, 6 to 20 s once; the result is stored on disk")

    @property
    def seconds(self):
        """Return the seconds of compilation."""
        return self.duration if self.done else 0.0


@contextlib.contextmanager
def announced(tell=None):
    """Report to `tell` if the block compiles anything.

    The default report is a warning. The block receives the `_Announcer`.
    """
    with event.install_listener("numba:compile", _Announcer(tell or warnings.warn)) as announcer:
        yield announcer


@compiled
def _place(table, phase):
    """Return the position in the intervals of a table at a running phase. At `size` or more, the tooth is out of mesh."""
    on = phase - table.first - table.start
    return (on - table.period * np.floor(on / table.period)) / table.width


@compiled
def _cubic(cells, table, at):
    cell = min(int(at), table.size - 1)
    u, row = at - cell, table.place + cell
    return cells[row, 0] + u * (cells[row, 1] + u * (cells[row, 2] + u * cells[row, 3]))


@compiled
def _slope(cells, table, at):
    """Return the derivative of `_cubic` by the phase."""
    cell = min(int(at), table.size - 1)
    u, row = at - cell, table.place + cell
    return (cells[row, 1] + u * (2 * cells[row, 2] + 3 * u * cells[row, 3])) / table.width


@compiled
def _load(knots, low, high, t):
    """Return the load at time `t`, linear between the knots ``low <= i < high`` and constant before and after them.

    Two knots of the same time are a jump, at which the load has the later value.
    """
    if t >= knots[high - 1, 0]:
        return knots[high - 1, 1]
    if t < knots[low, 0]:
        return knots[low, 1]
    while high - low > 1:
        middle = (low + high) // 2
        if knots[middle, 0] <= t:
            low = middle
        else:
            high = middle
    return knots[low, 1] + (t - knots[low, 0]) * (knots[low + 1, 1] - knots[low, 1]) / (knots[low + 1, 0] - knots[low, 0])


@compiled
def _paced(pace, t):
    """Return the rotation (as equivalent time) and relative speed at time `t`, from the knots of `machine.speed.Speed`."""
    last = pace.shape[0] - 1
    if t <= pace[0, 0] or last == 0:
        return pace[0, 2] + pace[0, 1] * (t - pace[0, 0]), pace[0, 1]
    if t >= pace[last, 0]:
        return pace[last, 2] + pace[last, 1] * (t - pace[last, 0]), pace[last, 1]
    low, high = 0, last
    while high - low > 1:
        middle = (low + high) // 2
        if pace[middle, 0] <= t:
            low = middle
        else:
            high = middle
    elapsed = t - pace[low, 0]
    factor = pace[low, 1] + elapsed * (pace[high, 1] - pace[low, 1]) / (pace[high, 0] - pace[low, 0])
    return pace[low, 2] + elapsed * (pace[low, 1] + factor) / 2, factor


@compiled
def _row(now, row, at, shape, which, place, inside):
    """Write the row at `place` of table `which`, and the position in that row, into ``now[row, at:at + 2]``. Outside: -1."""
    if not inside:
        now[row, at] = -1.0
        return
    i = min(max(int(place + 0.5), 1), int(shape[which, 1]) - 2)
    now[row, at], now[row, at + 1] = shape[which, 0] + i, place + 0.5 - i


@compiled
def secant(table, one, place, u, depth):
    """Return the stiffness at a position from `_row` in a part of the tables, and at a depth [m].

    See `machine.secant.Secant`.

    The rows of a column are contiguous in memory, so that the data of the next step are near.
    """
    last, over = one.columns - 1, depth * one.per_depth  # index of the deepest column
    at = last * np.sqrt(over)
    j = int(min(at, last - 1))
    here = int(place + j * one.rows)
    there = here + int(one.rows)
    a, b, c = (1 - u) * (1 - u) / 2, 0.5 + u * (1 - u), u * u / 2
    left = a * table[here - 1] + b * table[here] + c * table[here + 1]
    right = a * table[there - 1] + b * table[there] + c * table[there + 1]
    if at > last:
        before = (1 - 1 / last) ** 2
        slope = (right - left * before) / (1 - before)
        return slope + (right - slope) / over
    return left + (at - j) * (right - left)


@compiled
def _errors(flat, now, row, turned, fast):
    """Add mesh errors, gaps of misplaced teeth, and their rates to a row of `now`."""
    m, error, shift = flat.frequency.size, flat.error, flat.shift
    for j in range(error.size):
        one = error[j]
        turn = one.omega * turned + one.angle
        now[row, m + one.mesh] += one.amplitude * np.sin(turn)
        now[row, 2 * m + one.mesh] += one.amplitude * one.omega * fast * np.cos(turn)
    for j in range(shift.size):
        i = shift[j].mesh
        place = _place(shift[j], flat.phase[i] + flat.frequency[i] * turned)
        if place < shift[j].size:
            now[row, m + i] += _cubic(flat.cells, shift[j], place)
            now[row, 2 * m + i] += _slope(flat.cells, shift[j], place) * flat.frequency[i] * fast


@compiled
def lookup(flat, now, first, last, origin, h, low, share):
    """Fill the rows ``first <= i < last`` of `now` with the excitation at ``origin + h (low + share (i - first))``.

    A row holds the stiffnesses, errors and error rates of the meshes, then the weights of the friction rows, then the loads.
    In machines with force laws, the places in the tables of meshes and damaged teeth by `_row` follow. A place is -1 without a
    table, or if the tooth is out of mesh. Many times are evaluated at once, because a compiled function takes time to access
    the tables.
    """
    cells, frequency, phases, cycle, change, rub = flat.cells, flat.frequency, flat.phase, flat.cycle, flat.change, flat.rub
    twin, knots, knot_place, pace, shape = flat.twin, flat.knots, flat.knot_place, flat.pace, flat.shape
    m, loads, lawful = frequency.size, knot_place.size - 1, flat.secant.size > 0
    at = 3 * m + rub.size + loads
    for row in range(first, last):
        t = origin + h * (low + share * (row - first))
        turned, fast = t, 1.0
        if pace.shape[0] > 0:
            turned, fast = _paced(pace, t)
        for i in range(m):
            now[row, m + i] = now[row, 2 * m + i] = 0.0
            if twin[i] == i:
                place = _place(cycle[i], phases[i] + frequency[i] * turned)
                now[row, i] = _cubic(cells, cycle[i], place)
                if lawful:
                    _row(now, row, at + 2 * i, shape, i, 1 + place * cycle[i].width * (shape[i, 1] - 3), shape[i, 1] > 0)
        for j in range(change.size):
            i = change[j].mesh
            place = _place(change[j], phases[i] + frequency[i] * turned)
            if twin[i] == i and place < change[j].size:
                now[row, i] += _cubic(cells, change[j], place)
            if lawful:
                _row(now, row, at + 2 * (m + j), shape, m + j, place + 1, place < shape[m + j, 1] - 3)
        for i in range(m):
            now[row, i] = now[row, twin[i]]
            if lawful:
                now[row, at + 2 * i], now[row, at + 2 * i + 1] = now[row, at + 2 * twin[i]], now[row, at + 2 * twin[i] + 1]
            if change.size:
                now[row, i] = max(now[row, i], 0.0)
        _errors(flat, now, row, turned, fast)
        for j in range(rub.size):
            i = rub[j].mesh
            now[row, 3 * m + j] = _cubic(cells, rub[j], _place(rub[j], phases[i] + frequency[i] * turned))
        for j in range(loads):
            now[row, 3 * m + rub.size + j] = _load(knots, knot_place[j], knot_place[j + 1], t)


@compiled
def stage(out, base, at, columns, level, x, first):
    """``out = base[at:] + columns[level].T @ x[first:]``, four columns at a time, along memory."""
    n, last = out.size, first + columns.shape[1]
    for i in range(n):
        out[i] = base[at + i]
    j = 0
    for k in range(first, last - 3, 4):
        a, b, c, d = x[k], x[k + 1], x[k + 2], x[k + 3]
        for i in range(n):
            out[i] += (
                columns[level, j, i] * a
                + columns[level, j + 1, i] * b
                + columns[level, j + 2, i] * c
                + columns[level, j + 3, i] * d
            )
        j += 4
    for k in range(first + j, last):
        a = x[k]
        for i in range(n):
            out[i] += columns[level, j, i] * a
        j += 1
