"""`mesh_stiffness`: from a gear pair to its stiffness curve, by finite elements or by an energy method."""

import math
import time
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from . import fe
from .contact import Mesh, Solved
from .curve import StiffnessCurve
from .energy import published, textbook
from .hertz import linear_hertz
from .material import Material, check_state

METHODS = ("fe", "textbook", "published")
VERSIONS = ("gearfe", "numpy", "scipy", "scikit-fem", "gmsh")


def mesh_stiffness(pair, force, material, *, method="fe", phases=64, extended=True, state="plane strain", refine=1.0, teeth=None):
    """Mesh stiffness of a gear pair over one mesh cycle.

    ``k = F / delta``: F the force along the line of action, delta the loaded minus the unloaded transmission error as a
    length on it, bores held. Spur gears; of helical gears the transverse section is taken (as a spur gear of the same
    width).

    Parameters
    ----------
    pair : GearPair
    force : float or sequence of float
        Force along the line of action over the whole width [N]. Several loads share one flexibility and give a list.
    material : Material or (Material, Material)
        Of both gears, or of pinion and wheel.
    method : {"fe", "textbook", "published"}
        ``fe``: finite elements with line contact, neighbour coupling and load sharing (`gearfe.fe`). ``textbook``,
        ``published``: beam energies, linear contact, plain sum of the pairs (`gearfe.energy`).
    phases : int or array
        Number of equidistant phases from 0 (1 excluded), or the phases themselves.
    extended : bool
        Let tip corners touch before the start and after the end of the path of contact (``fe`` only; the energy methods
        know no contact there).
    state : {"plane strain", "plane stress"}
        For ``fe``; the beams of the energy methods use E as their sources do.
    refine : float
        Resolution of ``fe``: divides its edge lengths.
    teeth : int, optional
        For ``fe``: only so many teeth on a plain rim; default all.

    Returns
    -------
    StiffnessCurve, or a list of them if `force` is a sequence

    Raises
    ------
    ValueError
        If an input is impossible; the message says which.
    """
    if method not in METHODS:
        raise ValueError(f"method = {method!r}, but it must be one of {', '.join(METHODS)}")
    forces = np.atleast_1d(np.asarray(force, dtype=float))
    for value in forces:
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"force = {value} N, but a mesh is pressed together: give a finite force > 0")
    materials = _materials(material)
    check_state(state)
    phase = _phases(phases)
    if method == "fe":
        solve, details = _fe(pair, materials, phase, extended, state, refine, teeth)
    else:
        solve, details = _plain_sum(pair, materials, phase, {"textbook": textbook, "published": published}[method])
    options = {"extended": bool(extended), "state": state, "refine": float(refine), "teeth": teeth} if method == "fe" else {}
    curves = [
        _curve(pair, phase, value, solve, _meta(pair, value, materials, method, options | details)) for value in forces.tolist()
    ]
    return curves if np.ndim(force) else curves[0]


def _materials(material):
    materials = (material, material) if isinstance(material, Material) else tuple(material)
    if len(materials) != 2 or not all(isinstance(m, Material) for m in materials):
        raise ValueError(f"material = {material!r}, but give one Material or a pair (pinion, wheel)")
    return materials


def _phases(phases):
    if np.ndim(phases) == 0:
        if phases != int(phases) or phases < 1:
            raise ValueError(f"phases = {phases}, but give a number of phases >= 1, or an array of phases")
        return np.arange(int(phases)) / int(phases)
    phases = np.asarray(phases, dtype=float)
    if phases.size == 0 or not np.isfinite(phases).all():
        raise ValueError("phases must be a non-empty array of finite numbers")
    return phases


def _fe(pair, materials, phase, extended, state, refine, teeth):
    started = time.perf_counter()
    neighbours = math.ceil(pair.eps_alpha)
    flexible = [
        fe.flexibility(gear, material, neighbours=neighbours, state=state, refine=refine, teeth=teeth)
        for gear, material in zip((pair.gear_1, pair.gear_2), materials, strict=True)
    ]
    mesh = Mesh(pair, materials, flexible, phase, extended=extended, state=state)
    return mesh.solve, {"dofs": [f.dofs for f in flexible], "seconds_flexibility": time.perf_counter() - started}


def _plain_sum(pair, materials, phase, formulas):
    """Sum of the pairs on the path of contact, each a chain of two teeth and a linear contact: independent of load."""
    found = pair.contacts(phase, extended=False)
    touch = np.isfinite(found.gap)
    local = published.contact(materials) if formulas is published else linear_hertz(materials)
    flexibility = np.full(found.gap.shape, np.inf)
    flexibility[touch] = local
    for gear, material, roll in ((pair.gear_1, materials[0], found.roll_1), (pair.gear_2, materials[1], found.roll_2)):
        flexibility[touch] += formulas.components(gear, material, roll[touch]).total
    stiffness = (1 / flexibility).sum(axis=1)

    def solve(line_load):
        line = line_load / flexibility / stiffness[:, None]
        return Solved(found.order, line_load / stiffness, stiffness, line, np.full(line.shape, np.nan))

    return solve, {}


def _curve(pair, phase, force, solve, meta):
    """To SI, in one place: widths and millimetres become newtons and metres here."""
    started = time.perf_counter()
    width = min(pair.gear_1.b, pair.gear_2.b)
    solved = solve(force / width)
    meta = meta | {"seconds_contact": time.perf_counter() - started}
    used = solved.line_load.max(axis=0) > 0
    return StiffnessCurve(
        phase=phase,
        k=force / (solved.approach * 1e-3),
        k_tangent=solved.tangent * width * 1e3,
        lte=solved.approach * 1e-3,
        order=solved.order[used],
        force=solved.line_load[:, used] * width,
        pressure=solved.pressure[:, used] * 1e6,
        meta=meta,
    )


def _meta(pair, force, materials, method, options):
    gears = {name: asdict(gear) for name, gear in (("gear_1", pair.gear_1), ("gear_2", pair.gear_2))}
    return {
        "method": method,
        "force_N": force,
        "width_mm": min(pair.gear_1.b, pair.gear_2.b),
        **gears,
        "a_mm": pair.a,
        "eps_alpha": pair.eps_alpha,
        "materials": [asdict(m) for m in materials],
        "stiffness": "secant F / (loaded - unloaded transmission error), along the line of action, bores held",
        **options,
        "versions": {name: _version(name) for name in VERSIONS},
    }


def _version(name):
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
