"""File contents for the curves of a planetary set. The formats are those of `gearfe.core.files`."""

from typing import Any

import numpy as np

from ..core.files import Content
from ..stiffness.provenance import versions

TITLE = "gearfe curves of a planetary set, version 1"
MESHES = ("sun-planet", "planet-ring")
PER_MESH = {"force": "N", "k": "N/m", "k_alone": "N/m", "rim": "m"}
UNITS = PER_MESH | {"position": "pitches of the sun", "te": "m", "orbit": "m", "pair_force": "N", "tooth": "-", "order": "-"}
UNITS |= {"ring_angle": "rad", "ring_moved": "m"}


def content(curves: Any) -> Content:
    """Return the `Content` of `SetCurves`. Text tables have a column per mesh, other formats contain the arrays."""
    columns = {"position [pitches]": curves.position, "te [m]": curves.te}
    columns |= {f"orbit {axis} [m]": curves.orbit[:, k] for k, axis in enumerate("xy")}
    for name, unit in PER_MESH.items():
        for k, kind in enumerate(MESHES):
            for planet in range(curves.force.shape[2]):
                columns[f"{name} {kind} {planet + 1} [{unit}]"] = getattr(curves, name)[k, :, planet]
    seconds = {name: value for name, value in curves.meta.items() if name.startswith("seconds")}
    meta = {"case": repr(curves.meta["case"]), "K_gamma": curves.K_gamma, **seconds, "versions": versions()}
    meta["estimated_error"] = {name: np.asarray(value).tolist() for name, value in curves.meta.get("error", {}).items()}
    return Content(TITLE, columns, {name: getattr(curves, name) for name in UNITS}, meta, UNITS)
