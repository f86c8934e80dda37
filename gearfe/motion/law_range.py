"""Whether a motion stays within the loads that the force of its meshes was solved for."""

import warnings
from dataclasses import replace

import numpy as np

from ..machine.force_law import ForceLaw
from ..stiffness.curve import StiffnessCurve

LOOKS = 2000  # times of a run at which its mesh forces are compared with the loads of their laws
OTHER = 0.1  # of the load of a stiffness curve: a mean force further off is told


def compared(response):
    """The response, with ``stats["loads"]`` where mesh forces leave the loads they were solved for; warns of those above a law.

    Looked at at `LOOKS` times of the run.
    """
    machine = response.machine
    if not any(isinstance(mesh.stiffness, (ForceLaw, StiffnessCurve)) for mesh in machine.meshes):
        return response
    some = response.raw.part(slice(None, None, max(1, len(response.time) // LOOKS)))
    told = {"above": [], "other": []}
    for mesh, own in zip(machine.meshes, np.abs(some.mesh()).T, strict=True):
        given, most, mean = mesh.stiffness, float(own.max()), float(own.mean())
        if isinstance(given, ForceLaw) and most > given.load[-1]:
            told["above"].append(f"{mesh.name} {most:.4g} N, its law of force up to {given.load[-1]:.4g} N")
        stated = given.meta.get("force_N") if isinstance(given, StiffnessCurve) else None
        if stated is not None and abs(mean / stated - 1) > OTHER:
            told["other"].append(f"{mesh.name} {mean:.4g} N on average, its stiffness is that of {stated:.4g} N")
    if told["above"]:
        warnings.warn(
            f"forces above the loads solved: {'; '.join(told['above'])}. Beyond them a law goes on with its tangent: give it "
            "larger loads (gf.force_law, or loads= of gf.build_machine)",
            stacklevel=4,
        )
    found = [*told["above"], *told["other"]]
    return replace(response, stats=response.stats | {"loads": found}) if found else response
