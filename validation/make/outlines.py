"""Whole outlines of gears against gearfe's contact geometry: rigid gaps of random pairs, and pairs pressed together."""

from ..shared.arbiter.kept import reference

__all__ = ["reference"]
