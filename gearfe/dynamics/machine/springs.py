"""`Spring`: a linear spring and damper of a machine."""

from dataclasses import dataclass

from ...core.record import settle_numbers, settle_row
from ...geometry.aliases import Floats


@dataclass(frozen=True, slots=True)
class Spring:
    """Linear spring and damper along a row. Its force is ``-(k row @ q + c row @ v)`` along the row [N/m, N s/m or per rad]."""

    name: str
    row: Floats
    k: float
    c: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError unless the row is finite, and stiffness and damping are finite and not negative."""
        settle_row(self, "spring")
        settle_numbers(self, f"spring {self.name}", "k c", least=0.0)
