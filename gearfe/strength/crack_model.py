"""`CrackModel`: method, loads, support, slots and criterion of crack growth."""

import math
from dataclasses import dataclass

from ..core.checks import number, one_of
from ..geometry.tooth.slot import Slot
from .kink import CRITERIA

LOADINGS = ("engagement", "single")
METHODS = ("auto", "ritz", "fe")


@dataclass(frozen=True, slots=True)
class CrackModel:
    """Method, loads, support and criterion of crack growth.

    Parameters
    ----------
    method : {"auto", "ritz", "fe"}
        ``"auto"``: ``ritz`` while the crack lies in the middle 80 % of the sector of its tooth, then ``fe``.
    loading : {"engagement", "single"}
        ``"engagement"``: the loads of the healthy pair pass over the tooth and both neighbours. ``"single"``: the whole load
        stands at the highest point of single contact, and falls to zero.
    criterion : {"tangential", "energy", "shear"}
        Largest tangential stress (Erdogan and Sih 1963), largest energy release rate, or no K_II behind the tip (Amestoy and
        Leblond 1992).
    held : sequence of (float, float), optional
        Arcs of the bore (of a ring its outside) that are held [rad], from the centre-line of the cracked tooth, positive towards
        its loaded flank. Default: all around. `fe` rounds their ends to the edges of its mesh.
    slots : sequence of Slot, optional
        Slots in web or rim, with angles as those of `held`. `fe` cuts them out. `ritz` fills them with a material that is softer
        by a factor of 1e9.

    Raises
    ------
    ValueError
        If an option is unknown or an arc does not end after its start.
    TypeError
        If a slot is not a `Slot`.
    """

    method: str = "auto"
    loading: str = "engagement"
    criterion: str = "tangential"
    held: tuple[tuple[float, float], ...] | None = None
    slots: tuple[Slot, ...] = ()

    def __post_init__(self) -> None:
        """Check the options."""
        for name, known in (("method", METHODS), ("loading", LOADINGS), ("criterion", CRITERIA)):
            one_of(name, getattr(self, name), known)
        object.__setattr__(self, "slots", tuple(self.slots))
        if not all(isinstance(slot, Slot) for slot in self.slots):
            raise TypeError(f"slots = {self.slots!r}, but give a sequence of Slot")
        if self.held is None:
            return
        arcs = tuple((number("held", start), number("held", stop)) for start, stop in self.held)
        if not arcs or any(not 0 < stop - start <= 2 * math.pi for start, stop in arcs):
            raise ValueError(f"held = {self.held} rad, but each arc must end after its start and be at most a full circle")
        object.__setattr__(self, "held", arcs)
