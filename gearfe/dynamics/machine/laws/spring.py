"""Spring and damper: the law of a mesh with a stiffness over the phase or a force law."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class SpringLaw:
    """``F = k depth + c rate``."""

    power: float = field(default=1.0, init=False)
    straight: bool = field(default=True, init=False)

    @staticmethod
    def force(depth, rate, k, c, law):
        """Force [N]."""
        return k * depth + c * rate

    @staticmethod
    def slopes(depth, rate, k, c, law):
        """Return the derivatives of the force by depth and rate."""
        return k, c
