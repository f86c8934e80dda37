"""Gear mesh stiffness with its error: finite elements beside energy methods."""

import importlib

_HOME = {
    "Crack": "geometry.damage",
    "Gear": "geometry.gear",
    "GearPair": "geometry.pair",
    "PairModel": "gearfe.own_model",
    "Pit": "geometry.pit",
    "PlanetarySet": "geometry.planetary",
    "Material": "gearfe.material",
    "StiffnessCurve": "gearfe.curve",
    "batch": "gearfe.batches",
    "compare": "gearfe.comparison",
    "error_map": "gearfe.errormap",
    "load_scene": "gearfe.scene",
    "mesh_stiffness": "gearfe.stiffness",
    "read_model": "gearfe.model_file",
    "render_stress": "gearfe.render",
    "root_stress": "gearfe.loaded_tooth",
    "stress_intensity": "gearfe.fracture",
    "tooth_flexibility": "gearfe.loaded_tooth",
    "write_contact_inp": "gearfe.contact_deck",
    "write_inp": "gearfe.deck",
}
__all__ = sorted(_HOME)


def __getattr__(name):
    """Load the public names on first use, so that ``gearfe --help`` stays quick."""
    if name not in _HOME:
        raise AttributeError(f"gearfe has no {name!r}; it has {', '.join(__all__)}")
    value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__():
    """Public names."""
    return __all__
