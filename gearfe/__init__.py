"""Gear mesh stiffness with its error: finite elements beside energy methods."""

import importlib

_HOME = {
    "Crack": "geometry.damage",
    "Gear": "geometry.gear",
    "GearPair": "geometry.pair",
    "Material": "gearfe.material",
    "PairModel": "gearfe.own_model",
    "Pit": "geometry.pit",
    "PlanetarySet": "geometry.planetary",
    "Signal": "gearfe.signals",
    "StiffnessCurve": "gearfe.curve",
    "batch": "gearfe.batches",
    "compare": "gearfe.comparison",
    "demodulate": "gearfe.demodulation",
    "envelope": "gearfe.signals",
    "build_machine": "gearfe.scene_machine",
    "error_map": "gearfe.errormap",
    "natural_frequencies": "gearfe.machine",
    "simulate": "gearfe.dynamics",
    "steady_state": "gearfe.steady",
    "expected_lines": "gearfe.spectral_lines",
    "fast_kurtogram": "gearfe.kurtogram",
    "find_lines": "gearfe.spectral_lines",
    "indicator_table": "gearfe.indicators",
    "integrate": "gearfe.signals",
    "load_scene": "gearfe.scene",
    "mesh_stiffness": "gearfe.stiffness",
    "order_spectrum": "gearfe.orders",
    "phase_portrait": "gearfe.portrait",
    "plot_contact": "gearfe.plots",
    "plot_kurtogram": "gearfe.vibration_plots",
    "plot_phase": "gearfe.vibration_plots",
    "plot_spectra": "gearfe.vibration_plots",
    "poincare_section": "gearfe.portrait",
    "power_spectral_density": "gearfe.signals",
    "read_model": "gearfe.model_file",
    "read_signal": "gearfe.signal_file",
    "render_stress": "gearfe.render",
    "residual_signal": "gearfe.orders",
    "root_stress": "gearfe.loaded_tooth",
    "spectral_kurtosis": "gearfe.kurtogram",
    "spectrum": "gearfe.signals",
    "squared_envelope_spectrum": "gearfe.signals",
    "stress_intensity": "gearfe.fracture",
    "synchronous_average": "gearfe.orders",
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
