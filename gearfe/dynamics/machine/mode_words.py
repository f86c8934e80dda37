"""Descriptions of the modes of a machine, and critical speeds, at which an excitation frequency equals a natural frequency."""

from collections.abc import Sequence

import numpy as np

from ...core.table import Column, Table
from .campbell import Campbell, campbell
from .modal_energy import ModalEnergy, modal_energy
from .tables import Machine

KINDS = {"torsion": ("theta",), "bending": ("x", "y", "tilt_x", "tilt_y"), "axial": ("z",)}
LEAST = 0.05  # least part of the modal energy of a member that names the mode
BOTH = 0.02  # least part of the kinetic energy of a body that moves against another one


def mode_words(machine: Machine, energy: ModalEnergy, mode: int) -> str:
    """Return a description of a mode: its kind, the bodies that move most, and the places of the strain energy.

    Parameters
    ----------
    machine : Machine
    energy : ModalEnergy
        Of this machine.
    mode : int
        Number of the mode, from 0.

    Returns
    -------
    str
        Of a torsional mode the two bodies that move most against each other. Rotations count by their sense in the rotation of
        the train as a whole, so that the two gears of a mesh move with each other where they do not press it.

    Examples
    --------
    >>> import gearfe as gf
    >>> layout = gf.Layout([gf.Body("motor", 0.0, 1.0, "theta"), gf.Body("load", 0.0, 3.0, "theta")])
    >>> coupling = gf.Spring("coupling", layout.unit("motor", "theta") - layout.unit("load", "theta"), 1e4)
    >>> machine = gf.Machine(layout.dofs, layout.mass, (coupling,), ())
    >>> energy = gf.modal_energy(machine)
    >>> [mode_words(machine, energy, i) for i in (0, 1)]
    ['rotation of the train as a whole', 'torsion: motor against load; strain energy 100 % in coupling']
    """
    if not -len(energy.frequencies) <= mode < len(energy.frequencies):
        raise ValueError(f"mode = {mode}, but the machine has {len(energy.frequencies)} modes, numbered from 0")
    if energy.frequencies[mode] == 0:
        return "rotation of the train as a whole"
    parts = {dof: energy.kinetic[dof][mode] for dof in machine.dofs}
    sums = {kind: sum(part for dof, part in parts.items() if dof.partition(".")[2] in ends) for kind, ends in KINDS.items()}
    kind = max(sums, key=lambda name: sums[name])
    moving = {dof: part for dof, part in parts.items() if dof.partition(".")[2] in KINDS[kind]}
    first = max(moving, key=lambda dof: moving[dof])
    name = first.partition(".")[0]
    if kind == "torsion" and (other := _against(machine, energy, mode, first, moving)):
        name += f" against {other}"
    members = [f"{100 * part:.0f} % in {member}" for member, part in energy.largest(mode).items() if part >= LEAST]
    return f"{kind}: {name}; strain energy {', '.join(members)}"


def _against(machine, energy, mode, first, moving):
    """Return the body with the largest motion opposite to the body of the degree of freedom `first`, or an empty text.

    The result is empty if none does.
    """
    rigid = np.flatnonzero(energy.frequencies == 0)
    shape = energy.modes[:, mode]
    senses = np.sign(energy.modes[:, rigid[0]].real) if rigid.size else np.ones(len(shape))
    place = {dof: i for i, dof in enumerate(machine.dofs)}
    turned = np.real(shape * np.conj(shape[place[first]])) * senses * senses[place[first]]
    others = {dof: part for dof, part in moving.items() if turned[place[dof]] < 0 and part >= BOTH}
    return max(others, key=lambda dof: others[dof]).partition(".")[0] if others else ""


def modes_table(machine: Machine, top: float) -> Table:
    """Return the table of natural frequencies up to `top` [Hz] with mode shapes. Meshes have their mean stiffness."""
    energy = modal_energy(machine)
    rows = [[i, f, mode_words(machine, energy, i)] for i, f in enumerate(energy.frequencies.tolist()) if f <= top]
    return Table(["mode", Column("natural frequency", "Hz", "{:.5g}"), "shape"], rows, "natural frequencies")


def critical_speeds(machine: Machine, rpm: float, speeds: Sequence[float]) -> tuple[Table, Campbell]:
    """Return the table of critical speeds, at which an excitation frequency equals a natural frequency, and the Campbell diagram.

    Parameters
    ----------
    machine : Machine
    rpm : float
        Speed of the driving shaft [rpm].
    speeds : sequence of float
        Speeds of the diagram over that of the machine, rising.
    """
    found, energy = campbell(machine, speeds), modal_energy(machine)
    rows = [
        [rpm * one.speed, one.order, one.frequency, one.mode, mode_words(machine, energy, one.mode)] for one in found.crossings
    ]
    columns = [
        Column("speed", "rpm", "{:.5g}"),
        "line",
        Column("natural frequency", "Hz", "{:.5g}"),
        "mode",
        "shape at the nominal speed",
    ]
    return Table(columns, rows, "critical speeds"), found
