"""Gear mesh stiffness with its error: finite elements beside energy methods.

Everything public is a name of this package. Inside, a room imports only from floors below its own. From the ground: `geometry`;
`material`, `files`; `flexibility`, `signal`, `scene`, `pictures`; `elements`, `energy`; `contact`; `stiffness`; `machine`;
`motion`, `stress`; `studies`; `cli`.
"""

import importlib

_HOME = {
    "Crack": "geometry.damage.crack",
    "Gear": "geometry.tooth.gear",
    "GearPair": "geometry.pair.gear_pair",
    "Material": "gearfe.material",
    "OwnFlexibility": "gearfe.stiffness.own_flexibility",
    "PairModel": "gearfe.studies.own_model",
    "Pit": "geometry.damage.pit",
    "PlanetarySet": "geometry.pair.planetary",
    "Signal": "gearfe.signal.series",
    "StiffnessCurve": "gearfe.stiffness.curve",
    "batch": "gearfe.studies.batches",
    "compare": "gearfe.studies.by_zone",
    "demodulate": "gearfe.signal.demodulation",
    "envelope": "gearfe.signal.series",
    "build_machine": "gearfe.machine.of_scene",
    "error_map": "gearfe.studies.errormap",
    "natural_frequencies": "gearfe.machine.tables",
    "simulate": "gearfe.motion.simulate",
    "steady_state": "gearfe.motion.steady",
    "expected_lines": "gearfe.signal.spectral_lines",
    "fast_kurtogram": "gearfe.signal.kurtogram",
    "find_lines": "gearfe.signal.spectral_lines",
    "indicator_table": "gearfe.signal.indicators",
    "integrate": "gearfe.signal.series",
    "load_scene": "gearfe.scene.load",
    "mesh_stiffness": "gearfe.stiffness.solve",
    "order_spectrum": "gearfe.signal.orders",
    "phase_portrait": "gearfe.motion.portrait",
    "plot_contact": "gearfe.pictures.stiffness_plots",
    "plot_kurtogram": "gearfe.pictures.vibration_plots",
    "plot_phase": "gearfe.pictures.vibration_plots",
    "plot_spectra": "gearfe.pictures.vibration_plots",
    "poincare_section": "gearfe.motion.portrait",
    "power_spectral_density": "gearfe.signal.spectra",
    "read_model": "gearfe.studies.model_file",
    "read_signal": "gearfe.signal.signal_file",
    "render_stress": "gearfe.stress.render",
    "residual_signal": "gearfe.signal.orders",
    "root_stress": "gearfe.elements.loaded_tooth",
    "spectral_kurtosis": "gearfe.signal.kurtogram",
    "spectrum": "gearfe.signal.spectra",
    "squared_envelope_spectrum": "gearfe.signal.spectra",
    "stress_intensity": "gearfe.elements.fracture",
    "synchronous_average": "gearfe.signal.orders",
    "tooth_flexibility": "gearfe.elements.loaded_tooth",
    "write_contact_inp": "gearfe.elements.contact_deck",
    "write_inp": "gearfe.elements.deck",
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
