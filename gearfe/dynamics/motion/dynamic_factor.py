"""Dynamic factor: the largest mesh force of a run divided by the force under the static load."""

import numpy as np

from ..machine.contact_law import force
from .response import Response

LOOKS = 200  # number of times at which variable loads are evaluated


def dynamic_factors(response: Response) -> dict[str, float]:
    """Compute the dynamic factor K_v of every mesh: its largest force divided by its largest static force under the loads.

    In ISO 6336-1, K_v is the largest force over the nominal one at constant load, and K_A is the effect of variable loads. With
    variable loads, the static force here is the largest over time. Forces are those of the integrator (`Response.raw`), not
    filtered. Choose a rate that resolves the peaks. Start after the transient (``initial`` of a first run), because the
    transient is otherwise included.

    Parameters
    ----------
    response : Response

    Returns
    -------
    dict of str to float
        Dynamic factor by mesh, without unit; meshes without static load, such as separate back flanks, have none.

    Raises
    ------
    ValueError
        If no mesh has a static load.

    References
    ----------
    ISO 6336-1:2019, section 6: internal dynamic factor.

    Examples
    --------
    A load put at once on a mass on a constant mesh stiffness without damping doubles the force:

    >>> import gearfe as gf
    >>> machine = gf.single_mesh(1.0, 1e8, 500.0, force=1000.0)
    >>> run = gf.simulate(machine, 0.002, initial=([0.0], [0.0]), rate=2e5)
    >>> round(dynamic_factors(run)["mesh"], 4)
    2.0
    """
    machine = response.machine
    times = (
        response.time[:: max(1, len(response.time) // LOOKS)]
        if any(load.changes for load in machine.loads)
        else response.time[:1]
    )
    zero = np.zeros(len(machine.meshes))
    still = []
    for t in times:
        x = machine.compressions(machine.rest(float(t)))
        still.append(force(x, zero, machine._mean_at(x)[0], machine.law))
    most = np.max(np.abs(still), axis=0)
    largest = np.abs(response.raw.mesh()).max(axis=0)
    loads = [(m.name, float(dynamic), float(static)) for m, dynamic, static in zip(machine.meshes, largest, most, strict=True)]
    factors = {name: dynamic / static for name, dynamic, static in loads if static > 1e-9 * max(most.max(), 1e-30)}
    if not factors:
        names = ", ".join(name for name, *_ in loads) or "of no machine"
        raise ValueError(f"mesh {names} is unloaded at rest and has no dynamic factor; give its load")
    return factors
