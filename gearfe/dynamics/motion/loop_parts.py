"""Parts of `motion.loop` that numba compiles: tables looked up, and products along memory; and how they are compiled."""

import contextlib
import warnings
from functools import cache
from hashlib import sha256
from pathlib import Path

import numpy as np
from numba import njit
from numba.core import event

compiled = njit(error_model="numpy")  # at the first call


def kept(function):
    """Compile at the first call; the result is kept on the disk where numba finds a folder in which it may write.

    The result contains the functions it calls, in other files and contact laws too: any edit of these files compiles it anew.
    """
    try:
        dispatcher = njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # no such folder: it is compiled by each process
        return compiled(function)
    if dispatcher is function:
        return _not_compiled
    dispatcher._cache._cache_file._source_stamp = _stamp()  # numba itself looks at the function's own file alone
    return dispatcher


def _not_compiled(*_):
    raise RuntimeError("NUMBA_DISABLE_JIT is set, but the integrator needs compiled code: unset it")


@cache
def _stamp():
    """Digest of all files whose functions are compiled together."""
    home = Path(__file__).parent
    files = *home.glob("loop*.py"), home / "../machine/contact_law.py", *home.glob("../machine/laws/*.py")
    return sha256(b"".join(file.read_bytes() for file in sorted(files))).hexdigest()


class _Announcer(event.Listener):
    """Reports once that something is being compiled."""

    def __init__(self, tell):
        self.tell = tell

    def on_start(self, event):
        if self.tell:
            tell, self.tell = self.tell, None
            tell("compiling the integrator of vibration, which takes about 10 s once; the result is kept on the disk")

    def on_end(self, event):
        pass


@contextlib.contextmanager
def announced(tell=None):
    """In the block, `tell` gets a line if something has to be compiled; by default it is a warning."""
    with event.install_listener("numba:compile", _Announcer(tell or warnings.warn)):
        yield


@compiled
def _cubic(cells, place, count, at):
    cell = min(int(at), count - 1)
    u, row = at - cell, place + cell
    return cells[row, 0] + u * (cells[row, 1] + u * (cells[row, 2] + u * cells[row, 3]))


@compiled
def _slope(cells, place, count, at):
    """Derivative of `_cubic` by the place in the cells."""
    cell = min(int(at), count - 1)
    u, row = at - cell, place + cell
    return cells[row, 1] + u * (2 * cells[row, 2] + 3 * u * cells[row, 3])


@compiled
def _load(knots, low, high, t):
    """Straight between knots ``low <= i < high``, constant before and after them; a knot twice is a jump, and its end counts."""
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
    """Turned time at time `t`, and the speed over the nominal one; both from the knots of `machine.speed.Speed`."""
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
    """Write into ``now[row, at:at + 2]`` the row at `place` of table `which`, and the place in that row; -1 if not `inside`."""
    if not inside:
        now[row, at] = -1.0
        return
    i = min(max(int(place + 0.5), 1), int(shape[which, 1]) - 2)
    now[row, at], now[row, at + 1] = shape[which, 0] + i, place + 0.5 - i


@compiled
def secant(table, one, place, u, depth):
    """Stiffness from a part of the tables at a place that `_row` gives, and a depth [m]; as `machine.force_law.Secant`.

    The rows of a column lie one after the other, so that what the next step asks for is near at hand.
    """
    last, over = one.columns - 1, depth * one.per_depth  # of the deepest
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
def _shifted(flat, now, row, turned, fast):
    """Add what teeth off their places open, and its rate, to the errors in a row of `now`."""
    m = flat.frequency.size
    for j in range(flat.shift_mesh.size):
        i, z, first = flat.shift_mesh[j], flat.shift[j, 0], flat.shift[j, 1]
        start, width = flat.shift[j, 2], flat.shift[j, 3]
        place = flat.phase[i] + flat.frequency[i] * turned - first - start
        place = (place - z * np.floor(place / z)) / width
        if place < flat.shift_count[j]:
            now[row, m + i] += _cubic(flat.cells, flat.shift_place[j], flat.shift_count[j], place)
            steep = _slope(flat.cells, flat.shift_place[j], flat.shift_count[j], place) / width
            now[row, 2 * m + i] += steep * flat.frequency[i] * fast


@compiled
def lookup(flat, now, first, last, origin, h, low, share):
    """Fill in rows ``first <= i < last`` of `now`: what acts at the times ``origin + h (low + share (i - first))``.

    A row holds the stiffnesses, errors and rates of the errors of the meshes, then the weights of the friction rows, then the
    loads, then, of machines with laws of force, the places in the meshes' and damaged teeth's tables by `_row`, -1 where there is
    none or the tooth is out of mesh. Many times at once, for a compiled function takes its time to find the tables.
    """
    cells, frequency, phases, place, count = flat.cells, flat.frequency, flat.phase, flat.place, flat.count
    change_mesh, change, change_place, change_count = flat.change_mesh, flat.change, flat.change_place, flat.change_count
    error_mesh, error, twin, knots, knot_place = flat.error_mesh, flat.error, flat.twin, flat.knots, flat.knot_place
    rub_mesh, rub_place, rub_count, pace = flat.rub_mesh, flat.rub_place, flat.rub_count, flat.pace
    m, rub, changes, loads = frequency.size, rub_mesh.size, change_mesh.size, knot_place.size - 1
    shape, lawful, at = flat.shape, flat.secant.size > 0, 3 * frequency.size + rub_mesh.size + knot_place.size - 1
    for row in range(first, last):
        t = origin + h * (low + share * (row - first))
        turned, fast = t, 1.0
        if pace.shape[0] > 0:
            turned, fast = _paced(pace, t)
        for i in range(m):
            now[row, m + i] = now[row, 2 * m + i] = 0.0
            if twin[i] == i:
                phase = phases[i] + frequency[i] * turned
                now[row, i] = _cubic(cells, place[i], count[i], (phase - np.floor(phase)) * count[i])
                if lawful:
                    _row(now, row, at + 2 * i, shape, i, 1 + (phase - np.floor(phase)) * (shape[i, 1] - 3), shape[i, 1] > 0)
        for j in range(changes):
            i = change_mesh[j]
            z, tooth_phase = change[j, 0], phases[i] + frequency[i] * turned - change[j, 1] - change[j, 2]
            tooth_phase = (tooth_phase - z * np.floor(tooth_phase / z)) / change[j, 3]
            if twin[i] == i and tooth_phase < change_count[j]:
                now[row, i] += _cubic(cells, change_place[j], change_count[j], tooth_phase)
            if lawful:
                _row(now, row, at + 2 * (m + j), shape, m + j, tooth_phase + 1, tooth_phase < shape[m + j, 1] - 3)
        for i in range(m):
            now[row, i] = now[row, twin[i]]
            if lawful:
                now[row, at + 2 * i], now[row, at + 2 * i + 1] = now[row, at + 2 * twin[i]], now[row, at + 2 * twin[i] + 1]
            if changes:
                now[row, i] = max(now[row, i], 0.0)
        for j in range(error_mesh.size):
            i, turn = error_mesh[j], error[j, 1] * turned + error[j, 2]
            now[row, m + i] += error[j, 0] * np.sin(turn)
            now[row, 2 * m + i] += error[j, 0] * error[j, 1] * fast * np.cos(turn)
        _shifted(flat, now, row, turned, fast)
        for j in range(rub):
            i = rub_mesh[j]
            phase = phases[i] + frequency[i] * turned
            now[row, 3 * m + j] = _cubic(cells, rub_place[j], rub_count[j], (phase - np.floor(phase)) * rub_count[j])
        for j in range(loads):
            now[row, 3 * m + rub + j] = _load(knots, knot_place[j], knot_place[j + 1], t)


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
