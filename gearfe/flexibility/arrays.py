"""Flexibilities to and from named arrays of numbers, which is all of them that a file holds.

Names are paths: ``near/0/x`` and ``near/0/c`` are the breakpoints and coefficients of the spline of tooth 0. What is read back is
the same to the last bit. The gear is not written: who reads names the gear it asks for.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BivariateSpline, CubicSpline

from ..geometry.tooth.gear import Gear
from .plane import Flexibility, SeamFaces
from .solid import PLACES, Faces, Flexibility3D

CUBIC = 3  # degree of all splines


def plane_arrays(found: Flexibility) -> dict[str, NDArray]:
    """Arrays of a `Flexibility` by name, those of the healthy gear in it under ``healthy/``."""
    out = {name: np.array(getattr(found, name), dtype=float) for name in ("limits", "fine")}
    out["dofs"] = np.array(found.dofs, dtype=np.int64)
    for tooth, spline in found.near.items():
        out |= {f"near/{tooth}/x": spline.x, f"near/{tooth}/c": spline.c}
    surfaces = {f"far/{first}/{second}": spline for (first, second), spline in found.far.items()}
    for at, spline in surfaces.items():
        x, y = spline.get_knots()
        out |= {f"{at}/x": x, f"{at}/y": y, f"{at}/c": spline.get_coeffs()}
    out |= {f"own/{tooth}/b": values for tooth, values in found.own.items()}
    out |= {"basis/x": found.basis.x, "basis/c": found.basis.c}
    out |= {f"leans/{tooth}/b": value for tooth, value in found.leans.items()}
    if found.seam is not None:
        out |= {"seam/influence": found.seam.influence, "seam/stiffness": found.seam.stiffness}
        for tooth, spline in found.seam.opening.items():
            out |= {f"seam/opening/{tooth}/x": spline.x, f"seam/opening/{tooth}/c": spline.c}
    return out | _healthy(found, plane_arrays)


def plane_from(gear: Gear, arrays: dict[str, NDArray]) -> Flexibility:
    """`Flexibility` of `gear` from what `plane_arrays` gave.

    Raises
    ------
    ValueError or KeyError
        If arrays are missing, left over or do not fit together.
    """
    tree = _Tree(arrays)
    near = {tooth: _curve(part) for (tooth,), part in tree.parts("near", 1)}
    far = {key: _surface(part) for key, part in tree.parts("far", 2)}
    within, basis = {tooth: part.take("b", 2) for (tooth,), part in tree.parts("own", 1)}, _curve(tree.below("basis"))
    _check(all(values.shape == basis.c.shape[2:] * 2 for values in within.values()), "a tooth's own")
    leans = {tooth: part.take("b", 2) for (tooth,), part in tree.parts("leans", 1)}
    _check(all(value.shape == (3, 4) for value in leans.values()), "leaning loads")
    seam = None
    if tree.has("seam"):
        opening = {tooth: _curve(part) for (tooth,), part in tree.parts("seam/opening", 1)}
        influence, stiffness = (tree.take(f"seam/{name}", 2) for name in ("influence", "stiffness"))
        _check(opening and influence.shape == stiffness.shape == (len(influence),) * 2, "faces of cracks")
        _check(all(spline.c.shape[2:] == (len(influence),) for spline in opening.values()), "faces of cracks")
        seam = SeamFaces(opening, influence, stiffness)
    limits = tuple(tree.take("limits", 1))
    _check(len(limits) == 2 and limits[0] < limits[1] and near and near.keys() == within.keys(), "teeth")
    healthy, fine = tree.healthy(gear, plane_from), float(tree.take("fine", 0))
    flexible = Flexibility(gear, near, far, within, limits, fine, tree.whole("dofs"), healthy, seam, basis, leans)
    return _all_used(flexible, arrays, plane_arrays)


def solid_arrays(found: Flexibility3D) -> dict[str, NDArray]:
    """Arrays of a `Flexibility3D` by name, those of the healthy gear in it under ``healthy/``."""
    out = {name: np.array(getattr(found, name), dtype=float) for name in ("kernel", "edge")}
    out |= {name: np.array(getattr(found, name), dtype=np.int64) for name in ("degree", "unknowns")}
    out |= {f"near/{tooth}/b": value for tooth, value in found.near.items()}
    out |= {f"far/{first}/{second}/b": value for (first, second), value in found.far.items()}
    if found.seam is not None:
        out |= {"seam/influence": found.seam.influence}
        out |= {f"seam/opening/{tooth}/b": value for tooth, value in found.seam.opening.items()}
    return out | _healthy(found, solid_arrays)


def solid_from(gear: Gear, arrays: dict[str, NDArray]) -> Flexibility3D:
    """`Flexibility3D` of `gear` from what `solid_arrays` gave; raises as `plane_from`."""
    tree = _Tree(arrays)
    near = {tooth: part.take("b", 2) for (tooth,), part in tree.parts("near", 1)}
    far = {key: part.take("b", 2) for key, part in tree.parts("far", 2)}
    seam = None
    if tree.has("seam"):
        opening = {tooth: part.take("b", 2) for (tooth,), part in tree.parts("seam/opening", 1)}
        influence = tree.take("seam/influence", 2)
        _check(all(value.shape[0] == influence.shape[0] == influence.shape[1] for value in opening.values()), "faces of cracks")
        seam = Faces(opening, influence)
    degree = tree.whole("degree")
    size = next(iter(near.values())).shape if near else (0, 0)
    _check(size == (PLACES * (degree + 1),) * 2, "the degree along the width")
    _check(all(value.shape == size for value in (*near.values(), *far.values())), "teeth")
    kernel, edge = (float(tree.take(name, 0)) for name in ("kernel", "edge"))
    healthy = tree.healthy(gear, solid_from)
    flexible = Flexibility3D(gear, degree, kernel, near, far, tree.whole("unknowns"), healthy, seam, edge)
    return _all_used(flexible, arrays, solid_arrays)


def _healthy(found, arrays_of):
    """Arrays of the healthy gear in a damaged one, which holds no further one."""
    return {f"healthy/{name}": value for name, value in arrays_of(found.healthy).items()} if found.healthy is not None else {}


def _all_used(found, arrays, arrays_of):
    _check(arrays_of(found).keys() == arrays.keys(), "the list of arrays")
    return found


class _Tree:
    """Arrays by path, each to be taken with the number of dimensions it must have."""

    def __init__(self, arrays):
        self.arrays = arrays

    def has(self, head):
        return any(name.startswith(f"{head}/") for name in self.arrays)

    def below(self, head):
        return _Tree({name[len(head) + 1 :]: value for name, value in self.arrays.items() if name.startswith(f"{head}/")})

    def parts(self, head, depth):
        """(numbers, `_Tree`) of everything below ``head/number/.../``."""
        below = self.below(head).arrays
        keys = dict.fromkeys(tuple(name.split("/")[:depth]) for name in below)
        return [(tuple(int(part) for part in key), self.below("/".join((head, *key)))) for key in keys]

    def take(self, name, dimensions):
        """An array of finite numbers."""
        value = self.arrays[name]
        _check(value.dtype == np.float64 and value.ndim == dimensions and np.isfinite(value).all(), name)
        return value

    def whole(self, name):
        """A whole number >= 0."""
        value = self.arrays[name]
        _check(value.dtype == np.int64 and value.ndim == 0 and value >= 0, name)
        return int(value)

    def healthy(self, gear, made_from):
        below = self.below("healthy")
        _check(not below.has("healthy"), "healthy")
        return made_from(gear, below.arrays) if below.arrays else None


def _check(fits, name):
    if not fits:
        raise ValueError(f"stored flexibility: {name} does not fit")


def _curve(part):
    x, c = part.take("x", 1), part.arrays["c"]
    _check(c.dtype == np.float64 and c.ndim in (2, 3) and np.isfinite(c).all(), "a spline")
    _check(c.shape[:2] == (CUBIC + 1, x.size - 1) and (np.diff(x) > 0).all(), "a spline")
    return CubicSpline.construct_fast(c, x, extrapolate=True)


def _surface(part):
    x, y, c = (part.take(name, 1) for name in ("x", "y", "c"))
    knots = (x.size - CUBIC - 1, y.size - CUBIC - 1)
    _check(min(knots) > CUBIC and c.size == knots[0] * knots[1], "a spline")
    _check((np.diff(x) >= 0).all() and (np.diff(y) >= 0).all() and x[0] < x[-1] and y[0] < y[-1], "a spline")
    spline = BivariateSpline()
    spline.tck, spline.degrees = (x, y, c), (CUBIC, CUBIC)
    return spline
