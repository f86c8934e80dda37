"""What a gear tooth looks like: curves, pairs, gmsh meshes. No loads, no material."""

from .gear import Gear
from .pair import GearPair

__all__ = ["Gear", "GearPair"]
