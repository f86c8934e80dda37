"""The contact laws of `gearfe.machine.contact_law`, compiled: the force of a mesh whose parameters are a record."""

import numpy as np

from ..machine.contact_law import LAWS, mesh_force, touch
from .loop_parts import compiled


def records(law, **more):
    """Parameters of meshes ``{name: (m,)}`` as an array of records, ``records[i].name``; `more` are further names."""
    law = law | more
    out = np.empty(len(law["kind"]), dtype=np.dtype([(name, values.dtype) for name, values in law.items()], align=True))
    for name, values in law.items():
        out[name] = values
    return out


def _chain(first):
    """Force of the law of a row of `LAWS` from row `first` on."""
    own = compiled(LAWS[first].force)
    if first + 1 == len(LAWS):
        return own
    others = _chain(first + 1)

    def pushed(depth, rate, k, c, law):
        if law.kind == first:
            return own(depth, rate, k, c, law)
        return others(depth, rate, k, c, law)

    return compiled(pushed)


force = compiled(mesh_force(compiled(touch), _chain(0)))
