"""Forces of the meshes in `gearfe.dynamics.motion.loop`, by the contact laws of `machine.contact_law`, compiled."""

from ..machine.contact_law import LAWS, mesh_force, touch
from .loop_parts import compiled, secant


def _chain(first):
    """Return a compiled force function that selects the row ``law.kind`` of `LAWS`, for rows from `first` on."""
    force = compiled(LAWS[first].force)
    if first + 1 == len(LAWS):
        return force
    others = _chain(first + 1)

    def pushed(depth, rate, k, c, law):
        if law.kind == first:
            return force(depth, rate, k, c, law)
        return others(depth, rate, k, c, law)

    return compiled(pushed)


_force = compiled(mesh_force(compiled(touch), _chain(0)))


@compiled
def forces(g, first, x, now, row, laws, parts, table):
    """Write a fifth of the nonlinear forces of meshes and friction, and of variable loads, into ``g[first:]``.

    Whole forces and stiffnesses of the meshes go into their records (the former where they are needed). `parts` are those of the
    `table` of laws of several loads: of the meshes, with the meshes of friction rows after them, and of damaged teeth.
    """
    m, rubs = laws.size, laws[0].rubs if laws.size > 0 else 0
    for j in range(m + rubs, g.size // 5):
        g[first + j] = now[row, 2 * m + j]
    if m > 0 and laws[0].affine:  # Every mesh stays closed, so no search for the loaded flanks is required.
        for i in range(m):
            law, k, e, rate = laws[i], now[row, i], now[row, m + i], now[row, 2 * m + i]
            g[first + i] = (k - law.k_linear) * x[i] - k * e - (law.damping + law.damping_per_stiffness * k) * rate
            law.stiff = k
        return
    at = now.shape[1] - 2 * (parts.size - rubs)
    for i in range(m):
        law, v = laws[i], x[m + i] if x.size > m else 0.0
        k, e, rate = now[row, i], now[row, m + i], now[row, 2 * m + i]
        if law.lawful:
            deep = max(x[i] - e, 0.0) + max(-law.backlash - (x[i] - e), 0.0)
            k = secant(table, parts[i], now[row, at + 2 * i], now[row, at + 2 * i + 1], deep)
            for j in range(m + rubs, parts.size):
                column = at + 2 * (j - rubs)
                if parts[j].mesh == i and now[row, column] >= 0:
                    k += secant(table, parts[j], now[row, column], now[row, column + 1], deep)
            k = max(k, 0.0)
        whole = _force(x[i] - e, v - rate, k, law)
        g[first + i] = whole - law.k_linear * x[i] - law.c_linear * v
        law.total, law.stiff = whole, k
    for j in range(rubs):
        g[first + m + j] = now[row, 3 * m + j] * laws[parts[m + j].mesh].total


@compiled
def note(acting, step, g, now, row, laws):
    """Write varying forces, stiffnesses and, if there is room, errors into a row of `acting`."""
    m, f = laws.size, g.size // 5
    for i in range(f):
        acting[step, i] = g[i]
    for i in range(m):
        acting[step, f + i] = laws[i].stiff
    for i in range(acting.shape[1] - f - m):
        acting[step, f + m + i] = now[row, m + i]


@compiled
def _side(own, backlash):
    """Return 1 where the front flanks touch, -1 where the back flanks touch, otherwise 0."""
    return 1.0 if own > 0 else (-1.0 if own < -backlash else 0.0)


@compiled
def changed(side, x, now, row, laws):
    """Return whether a mesh that can open is not on the given side."""
    m = side.size
    for i in range(m):  # noqa: SIM110 (numba has no generators here)
        if laws[i].backlash > 0 and side[i] != _side(x[i] - now[row, m + i], laws[i].backlash):
            return True
    return False


@compiled
def losses(side, x, now, row, laws):
    """Update the side of contact of each mesh, and return the number of meshes that have lost contact."""
    m, lost = side.size, 0
    for i in range(m):
        seen = _side(x[i] - now[row, m + i], laws[i].backlash)
        lost += laws[i].backlash > 0 and side[i] != 0.0 and seen == 0.0
        side[i] = seen
    return lost


@compiled
def loads(g, now, row, m, rubs):
    """Write variable loads into the first forces of a step, because loads may jump."""
    for j in range(m + rubs, g.size // 5):
        g[j] = now[row, 2 * m + j]
