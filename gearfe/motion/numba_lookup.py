"""What the loops compiled by numba share: tables looked up at a time, and products along memory."""

from importlib.util import find_spec

import numpy as np

if find_spec("numba"):
    from numba import njit
else:

    def njit(**options):
        """Leave the loops as they are: the same numbers, slowly (`gearfe.simulate` then uses `gearfe.motion.numpy_loop`)."""
        return lambda function: function


@njit(cache=True, error_model="numpy")
def _cubic(cells, place, count, at):
    cell = min(int(at), count - 1)
    u, row = at - cell, place + cell
    return cells[row, 0] + u * (cells[row, 1] + u * (cells[row, 2] + u * cells[row, 3]))


@njit(cache=True, error_model="numpy", inline="always")
def lookup(flat, t, now):
    """Fill in what acts at time t: stiffnesses, errors and their rates, weights of friction rows, loads."""
    k, e, rate, weight, load = now
    for i in range(k.size):
        e[i] = rate[i] = 0.0
        if flat.twin[i] == i:
            phase = flat.phase[i] + flat.frequency[i] * t
            k[i] = _cubic(flat.cells, flat.place[i], flat.count[i], (phase - np.floor(phase)) * flat.count[i])
    for j in range(flat.change_mesh.size):
        i = flat.change_mesh[j]
        if flat.twin[i] != i:
            continue
        z, own = flat.change[j, 0], flat.phase[i] + flat.frequency[i] * t - flat.change[j, 1] - flat.change[j, 2]
        own = (own - z * np.floor(own / z)) / flat.change[j, 3]
        if own < flat.change_count[j]:
            k[i] += _cubic(flat.cells, flat.change_place[j], flat.change_count[j], own)
    if flat.change_mesh.size:
        for i in range(k.size):
            k[i] = max(k[i], 0.0)
    for i in range(k.size):
        k[i] = k[flat.twin[i]]
    for j in range(flat.error_mesh.size):
        turn = flat.error[j, 1] * t + flat.error[j, 2]
        e[flat.error_mesh[j]] += flat.error[j, 0] * np.sin(turn)
        rate[flat.error_mesh[j]] += flat.error[j, 0] * flat.error[j, 1] * np.cos(turn)
    for j in range(flat.rub_mesh.size):
        i = flat.rub_mesh[j]
        phase = flat.phase[i] + flat.frequency[i] * t
        weight[j] = _cubic(flat.cells, flat.rub_place[j], flat.rub_count[j], (phase - np.floor(phase)) * flat.rub_count[j])
    for j in range(load.size):
        low, high = flat.knot_place[j], flat.knot_place[j + 1]
        load[j] = np.interp(t, flat.knots[low:high, 0], flat.knots[low:high, 1])


@njit(cache=True, error_model="numpy")
def add_columns(out, columns, x):
    """``out += columns.T @ x``, four columns at a time, along memory."""
    n, whole = out.size, x.size // 4 * 4
    for j in range(0, whole, 4):
        a, b, c, d = x[j], x[j + 1], x[j + 2], x[j + 3]
        one, two, three, four = columns[j], columns[j + 1], columns[j + 2], columns[j + 3]
        for i in range(n):
            out[i] += one[i] * a + two[i] * b + three[i] * c + four[i] * d
    for j in range(whole, x.size):
        value, one = x[j], columns[j]
        for i in range(n):
            out[i] += one[i] * value
