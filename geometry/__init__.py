"""Geometry of gear teeth: curves, pairs, gmsh meshes, without loads and materials. Imported as `gearfe.geometry`."""

if __name__ == "geometry":  # Importing `geometry` directly would create a second copy of every class.
    raise ImportError("geometry is a part of gearfe: import gearfe.geometry, or take the names from gearfe")

from .pair.gear_pair import GearPair
from .tooth.gear import Gear

__all__ = ["Gear", "GearPair"]
