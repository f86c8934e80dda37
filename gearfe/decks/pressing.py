"""`Pressing`: mesh size of a pair in contact for CalculiX, and the rotation of its gears."""

from dataclasses import dataclass

from ..core.checks import one_of

PINION = {"mean": 0.5, "pinion": 1.0, "wheel": 0.0}  # share of the pinion in the approach
PITS = ("cut", "lost", "filled")


@dataclass(frozen=True, slots=True)
class Pressing:
    """Options of `gearfe.decks.contact_inp.write_contact_inp`, where they are described."""

    pits: str = "cut"
    pose: str = "mean"
    per_width: float | None = None
    layers: int = 3
    penalty: float = 500.0
    refine: float = 1.0

    def __post_init__(self) -> None:
        """Raise ValueError for an unknown pose or treatment of pits."""
        for name, known in (("pose", PINION), ("pits", PITS)):
            one_of(name, getattr(self, name), known)

    def turned(self, pair, approach):
        """Angles [rad] by which the bores of pinion and wheel rotate for an approach [mm]."""
        part = PINION[self.pose]
        return part * approach / pair.gear_1.r_b, pair.outward * (1 - part) * approach / pair.gear_2.r_b
