"""Forces of a gear mesh: elastic with backlash, the impact function, Coulomb friction; and Hertz's coefficient.

Everything takes arrays. The compression `x` of a mesh is positive when the driving flanks press on each other; its backlash is
the play behind them, so that the back flanks touch at ``x = -backlash``.
"""

import math

import numpy as np

from ..flexibility.hertz import contact_modulus

LAW = ("power", "damping", "beta", "per_depth", "backlash", "film", "push")  # in the order `contact_force` takes them
STRAIGHT, HERTZ, BENT = range(3)  # exponents of all meshes: 1, 3/2, others


def step(x, x0, h0, x1, h1):
    """Cubic step of multibody programs: `h0` up to `x0`, `h1` from `x1` on, ``3 u**2 - 2 u**3`` between.

    >>> float(step(0.05, 0.0, 0.0, 0.1, 1.0))
    0.5
    """
    u = np.clip((np.asarray(x, dtype=float) - x0) / (x1 - x0), 0.0, 1.0)
    return h0 + (h1 - h0) * u * u * (3 - 2 * u)


def hertz_coefficient(radius_1, radius_2, materials):
    """Coefficient K of ``F = K delta**1.5`` from Hertz's theory, ``4/3 sqrt(R) E*`` [N/mm^1.5].

    Parameters
    ----------
    radius_1, radius_2 : float
        Radii of curvature of the flanks at the contact [mm], the second negative in an internal gear.
    materials : (Material, Material)

    References
    ----------
    K. L. Johnson, Contact Mechanics, 1985, eq. 4.23; the law of the articles on pitted planetary and helical gears.

    Examples
    --------
    At the pitch point of the 21/31 pair of module 2 the articles print 3.0459e5:

    >>> from gearfe.material import Material
    >>> half = math.sin(math.radians(20))
    >>> round(hertz_coefficient(21 * half, 31 * half, (Material(E=207e3, nu=0.25),) * 2) / 1e5, 3)
    3.046
    """
    return 4 / 3 / math.sqrt(1 / radius_1 + 1 / radius_2) * contact_modulus(materials)


def friction_coefficient(slip, *, static, dynamic, v_static, v_dynamic):
    """Coulomb friction as multibody programs smooth it, with the sign of the slip velocity.

    0 without slip, `static` at a slip of `v_static`, `dynamic` from `v_dynamic` on, `step` between (odd in the slip).

    Parameters
    ----------
    slip : ndarray
        Slip velocity [m/s].
    static, dynamic : float
        Coefficients of friction.
    v_static, v_dynamic : float
        Transition velocities [m/s].
    """
    if not 0 < v_static < v_dynamic:
        raise ValueError(f"v_static = {v_static}, v_dynamic = {v_dynamic} m/s, but they must rise from above 0")
    size = np.abs(slip)
    stick = step(size, -v_static, -static, v_static, static)
    return np.sign(slip) * np.where(size < v_static, stick, step(size, v_static, static, v_dynamic, dynamic))


def contact_force(x, v, k, power, damping, beta, per_depth, backlash, film, push, bent, stepped, pushing):
    """Force of a mesh, of numbers or of arrays; see `force`.

    Written so that numpy takes arrays through it and numba compiles it for numbers. `bent`: `STRAIGHT` where all powers are 1,
    `HERTZ` where all are 3/2, for which a square root is ten times faster, `BENT` otherwise; `stepped`, `pushing`: whether any
    damping grows with depth, any flank only pushes. Where the flanks are apart both depths are zero, and with them the spring.
    """
    front, rear = np.maximum(x, 0.0), np.maximum(-backlash - x, 0.0)
    ahead, behind = front > 0, rear > 0
    inside = ahead | behind
    full = 1.0
    if stepped:
        u = np.minimum((front + rear) * per_depth, 1.0)
        full = u * u * (3 - 2 * u) + (per_depth == 0)
    share = film + inside * (full - film)
    if bent == STRAIGHT:
        spring = front - rear
    elif bent == HERTZ:
        spring = front * np.sqrt(front) - rear * np.sqrt(rear)
    else:
        spring = front**power - rear**power
    out = k * spring + (damping + beta * k) * share * v
    if pushing:
        return push * (ahead * np.maximum(out, 0.0) + behind * np.minimum(out, 0.0)) + (1 - push) * out
    return out


def branches(law):
    """Which parts of `contact_force` a law needs: ``bent, stepped, pushing``."""
    power = law["power"]
    bent = STRAIGHT if (power == 1).all() else HERTZ if (power == 1.5).all() else BENT
    return bent, bool((law["per_depth"] != 0).any()), bool(law["push"].any())


def force(x, v, k, law):
    """Force of each mesh along its line of action [N], positive when it pushes.

    ``k delta**power + c step(delta / depth) delta'`` on either flank, delta the depth of penetration. The damping is
    ``c = damping + beta k``; where no flank touches a part `film` of it stays. With `push` a flank never pulls, as the
    impact function of multibody programs has it.

    Parameters
    ----------
    x, v : ndarray, shape (..., m)
        Compression [m] and its rate [m/s].
    k : ndarray, shape (..., m)
        Stiffness [N/m^power].
    law : dict of ndarray, shape (m,)
        `LAW` (see `gearfe.machine.gear_mesh.GearMesh`; ``per_depth`` is one over its depth, or 0).
    """
    return contact_force(x, v, k, *(law[key] for key in LAW), *branches(law))


def sides(x, law):
    """On which flanks each mesh touches at compressions `x` ``(..., m)``: 1 the front ones, -1 the back ones, 0 none."""
    return (x > 0).astype(np.int8) - (x < -law["backlash"])


def sided_force(x, v, k, law, side):
    """`force` of meshes that stay on the flanks `side` says, whatever x: smooth where `force` has its kinks.

    An integrator that steps up to the time at which a flank is left sees a smooth law on all its way. (Flanks that only push,
    `push`, keep the kink at which their force reaches zero.)
    """
    depth = np.where(side == 0, 0.0, np.where(side < 0, x + law["backlash"], x))
    depth = np.where(law["push"], np.where(side < 0, np.minimum(depth, 0.0), np.maximum(depth, 0.0)), depth)
    return force(depth, v, k, law | {"backlash": np.zeros_like(law["backlash"])})


def depth(x, law):
    """How far the flanks of each mesh are pressed, front or back ones, at compressions `x` ``(..., m)``; 0 where none touch."""
    return np.maximum(x, 0.0) + np.maximum(-law["backlash"] - x, 0.0)


def slopes(x, v, k, law, bend=0.0):
    """Derivatives of `force` by x and v, of the branch the state is on (shapes as there).

    `bend` is that of k by the depth, of a `gearfe.machine.force_law.ForceLaw` [N/m2].
    """
    back = x < -law["backlash"]
    delta = np.where(back, -law["backlash"] - x, np.maximum(x, 0.0))
    inside = back | (x > 0)
    full = law["damping"] + law["beta"] * k
    u = np.minimum(delta * law["per_depth"], 1.0)
    stepped = law["per_depth"] > 0
    share = np.where(inside, np.where(stepped, u * u * (3 - 2 * u), 1.0), law["film"])
    rise = np.where(stepped & inside, 6 * u * (1 - u) * law["per_depth"], 0.0) * np.where(back, -1.0, 1.0)
    spring = np.where(inside, k * law["power"] * np.where(law["power"] == 1.0, 1.0, delta ** (law["power"] - 1)), 0.0)
    side = np.where(back, -1.0, 1.0)
    spring = spring + np.where(inside, bend * (delta + side * law["beta"] * share * v), 0.0)
    pulls = law["push"] & (force(x, v, k, law) == 0.0)
    return np.where(pulls, 0.0, spring + full * rise * v), np.where(pulls, 0.0, full * share)
