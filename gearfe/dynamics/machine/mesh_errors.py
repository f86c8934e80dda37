"""Mesh errors of a machine: profile errors as sinusoids or tables, eccentric bodies, pin position errors."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from .mesh_excitation import harmonics
from .tables import Machine


def with_errors(
    machine: Machine,
    *,
    profile: Any = 0.0,
    runout: Mapping[str, tuple[float, float, float]] | None = None,
    place: Mapping[str, tuple[float, float]] | None = None,
) -> Machine:
    """Return the machine with profile errors, run-out and misplaced bodies in its meshes, as in the herringbone article.

    A displacement s of a body's teeth closes a mesh by ``row s``, with the translational entries of the mesh row. Hence
    ``e = -row s``.

    Parameters
    ----------
    machine : Machine
    profile : float, array or Samples, or a dict of them by mesh name
        Manufacturing error [m]: the amplitude of a sine at mesh frequency; or the error over the mesh phase, as samples over one
        cycle or as `Samples` over several, for example of a revolution (`gearfe.mesh_excitation` makes them from a curve). Its
        phase is that of the mesh. Positive: it opens the mesh.
    runout : dict, optional
        Eccentric bodies: ``{"sunL": (amplitude [m], frequency [Hz], start [rad])}``: the axis of the teeth turns about that of
        the body at `frequency` (relative to the carrier; counter-clockwise if positive) from angle `start`.
    place : dict, optional
        Misplaced bodies: ``{"planet1L": (dx, dy)}`` [m], a constant error.

    Raises
    ------
    ValueError
        If there is no such body or mesh, or a profile error has none of these forms.
    """
    runout, place, named = runout or {}, place or {}, isinstance(profile, Mapping)
    bodies = {dof.partition(".")[0] for dof in machine.dofs}
    _check_known("mesh", profile if named else (), [mesh.name for mesh in machine.meshes])
    _check_known("body", (*runout, *place), sorted(bodies))
    meshes = []
    for mesh in machine.meshes:
        errors = harmonics(profile.get(mesh.name, 0.0) if named else profile, mesh.frequency, mesh.phase)
        for name, (amplitude, frequency, start) in runout.items():
            dx, dy = (_entry(machine, mesh, f"{name}.{axis}") for axis in "xy")
            size, angle = math.hypot(dx, dy), math.atan2(dy, dx)
            if size and amplitude:  # -cos(turn - angle) is written as a sine.
                errors.append((amplitude * size, frequency, start - angle - math.pi / 2))
        for name, (sx, sy) in place.items():
            shift = _entry(machine, mesh, f"{name}.x") * sx + _entry(machine, mesh, f"{name}.y") * sy
            if shift:
                errors.append((-shift, 0.0, math.pi / 2))
        meshes.append(replace(mesh, error=(*mesh.error, *errors)))
    return replace(machine, meshes=tuple(meshes))


def _check_known(what, names, known):
    for name in names:
        if name not in known:
            raise ValueError(f"no {what} {name!r}; there are {', '.join(known)}")


def _entry(machine, mesh, dof):
    return float(mesh.row[machine.dofs.index(dof)]) if dof in machine.dofs else 0.0
