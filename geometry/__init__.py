"""What a gear tooth looks like: curves, pairs, gmsh meshes. No loads, no material."""

from .pair.gear_pair import GearPair
from .tooth.gear import Gear

__all__ = ["Gear", "GearPair"]
