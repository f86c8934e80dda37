"""Expected cost of a mesh in three dimensions, before it is made."""

from ...core.cost import Cost, check_cost
from .solver import plan

# memory [bytes] and time [s] of a node of a mesh that is only written, measured at refine 0.5 to 2
BYTES, SECONDS = 600.0, 2.5e-6


def check_hexahedra(gear, refine, density, *, solved=True):
    """Reject a whole gear in hexahedra above the limits of time and memory, and announce slow work.

    `density` is the number of nodes for each tooth and module of width at refine 1. The number grows with ``refine**2`` at least.
    The system is `solved` (20-node hexahedra, one factorisation), or the mesh is only written.

    ValueError or, if a system does not fit into memory, RuntimeError, with the numbers.
    """
    check_mesh(density * gear.z * max(gear.b / gear.m_n, 1.0) * refine**2, refine, solved=solved)


def check_mesh(nodes, refine, *, solved=True):
    """Reject a mesh in three dimensions with so many nodes, and announce slow work, as `check_hexahedra` does."""
    system = plan(3 * nodes) if solved else None
    cost = Cost(system.seconds, system.memory) if system else Cost(SECONDS * nodes, BYTES * nodes)
    check_cost(f"refine = {refine:g}: a mesh of {nodes:.2g} nodes", cost, "give a smaller refine")
