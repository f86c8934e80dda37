"""Gear mesh stiffness with its error: finite elements beside energy methods.

Everything public is a name of this package. Inside, a room imports only from floors below its own. From the ground: `geometry`;
`material`, `files`, `units`, `steps`, `threads`; `supports`; `flexibility`, `signal`, `scene`, `pictures`, `store`; `elements`,
`energy`; `contact`; `stiffness`; `machine`; `motion`, `stress`; `studies`; `surrogates`, `sweeps`; `datasets`; `reports`;
`app`; `cli`.
"""

import importlib

_HOME = {
    "Body": "gearfe.machine.layout",
    "Crack": "geometry.damage.crack",
    "Dataset": "gearfe.datasets.opened",
    "Flank": "geometry.tooth.modified",
    "FrontIntensity": "gearfe.elements.crack_front",
    "Gear": "geometry.tooth.gear",
    "GearMesh": "gearfe.machine.gear_mesh",
    "GearPair": "geometry.pair.gear_pair",
    "IsoRootStress": "gearfe.studies.root_iso",
    "Layout": "gearfe.machine.layout",
    "Load": "gearfe.machine.tables",
    "Machine": "gearfe.machine.tables",
    "Material": "gearfe.material",
    "Member": "gearfe.machine.member",
    "Misalignment": "geometry.pair.flanks",
    "OwnFlexibility": "gearfe.stiffness.own_flexibility",
    "PairModel": "gearfe.studies.own_model",
    "Pit": "geometry.damage.pit",
    "PlanetarySet": "geometry.pair.planetary",
    "Response": "gearfe.motion.response",
    "RootStress": "gearfe.elements.root_stress",
    "Samples": "gearfe.machine.gear_mesh",
    "Shaft": "gearfe.supports.shaft",
    "Signal": "gearfe.signal.series",
    "Spring": "gearfe.machine.tables",
    "Stage": "gearfe.machine.tables",
    "StiffnessCurve": "gearfe.stiffness.curve",
    "Support": "gearfe.supports.support",
    "Surrogate": "gearfe.surrogates.surrogate",
    "ToothDamage": "gearfe.machine.gear_mesh",
    "batch": "gearfe.studies.batches",
    "cepstrum": "gearfe.signal.time_frequency",
    "compare": "gearfe.studies.by_zone",
    "curve_bands": "gearfe.sweeps.effects",
    "demodulate": "gearfe.signal.demodulation",
    "contact_pattern": "gearfe.stiffness.pattern",
    "decimate": "gearfe.signal.series",
    "envelope": "gearfe.signal.series",
    "build_machine": "gearfe.machine.of_scene",
    "compound_planetary": "gearfe.machine.compound_planetary",
    "dataset": "gearfe.datasets.make",
    "disc": "gearfe.machine.member",
    "error_map": "gearfe.studies.errormap",
    "gear_pair": "gearfe.machine.gear_pair",
    "gear_indicator_table": "gearfe.signal.gear_indicators",
    "gear_indicators": "gearfe.signal.gear_indicators",
    "herringbone_planetary": "gearfe.machine.herringbone_planetary",
    "natural_frequencies": "gearfe.machine.modes",
    "mesh_excitation": "gearfe.machine.mesh_excitation",
    "simulate": "gearfe.motion.simulate",
    "single_mesh": "gearfe.machine.single_mesh",
    "force_law": "gearfe.machine.force_law",
    "ForceLaw": "gearfe.machine.force_law",
    "LawError": "gearfe.machine.law_error",
    "law_error": "gearfe.machine.law_error",
    "stage_phases": "gearfe.machine.planetary",
    "steady_state": "gearfe.motion.steady",
    "with_tachometer": "gearfe.signal.tachometer",
    "with_errors": "gearfe.machine.mesh_errors",
    "Speed": "gearfe.machine.speed",
    "with_speed": "gearfe.machine.speed",
    "expected_lines": "gearfe.signal.spectral_lines",
    "fit_surrogate": "gearfe.surrogates.fit",
    "export_mesh": "gearfe.elements.mesh_file",
    "face_load": "gearfe.studies.pattern",
    "fast_kurtogram": "gearfe.signal.kurtogram",
    "find_lines": "gearfe.signal.spectral_lines",
    "housing_signal": "gearfe.signal.housing",
    "ring_window": "gearfe.signal.housing",
    "stage_lines": "gearfe.signal.stage_lines",
    "indicator_table": "gearfe.signal.indicators",
    "integrate": "gearfe.signal.series",
    "iso_root_stress": "gearfe.studies.root_iso",
    "load_scene": "gearfe.scene.load",
    "main_effects": "gearfe.sweeps.effects",
    "mesh_stiffness": "gearfe.stiffness.solve",
    "new_scene": "gearfe.scene.new",
    "open_dataset": "gearfe.datasets.opened",
    "order_spectrum": "gearfe.signal.orders",
    "phase_portrait": "gearfe.motion.portrait",
    "pitted_helical": "gearfe.machine.helical_pair",
    "pitted_planetary": "gearfe.machine.pitted_planetary",
    "planetary": "gearfe.machine.planetary",
    "plot_contact": "gearfe.pictures.contact_plot",
    "plot_kurtogram": "gearfe.pictures.vibration_plots",
    "plot_pair": "gearfe.pictures.pair_plot",
    "plot_phase": "gearfe.pictures.vibration_plots",
    "plot_spectrogram": "gearfe.pictures.vibration_plots",
    "plot_spectra": "gearfe.pictures.vibration_plots",
    "poincare_section": "gearfe.motion.portrait",
    "power_spectral_density": "gearfe.signal.spectra",
    "pulses": "gearfe.machine.tables",
    "random_pitch": "geometry.tooth.pitch",
    "read_model": "gearfe.studies.model_file",
    "read_topography": "gearfe.stiffness.topography_file",
    "read_signal": "gearfe.signal.signal_file",
    "read_signals": "gearfe.signal.signal_file",
    "render_mesh": "gearfe.stress.mesh_picture",
    "render_stress": "gearfe.stress.render",
    "Runs": "gearfe.sweeps.runs",
    "open_runs": "gearfe.sweeps.runs",
    "plan_sweep": "gearfe.sweeps.plan",
    "report": "gearfe.reports.page",
    "residual_signal": "gearfe.signal.orders",
    "root_stress": "gearfe.elements.loaded_tooth",
    "spectrogram": "gearfe.signal.time_frequency",
    "root_stress_along_width": "gearfe.elements.root_stress",
    "root_stress_of_contact": "gearfe.stress.root_of_contact",
    "spectral_kurtosis": "gearfe.signal.kurtogram",
    "TransmissionError": "gearfe.stiffness.transmission_error",
    "transmission_error": "gearfe.stiffness.transmission_error",
    "sobol_indices": "gearfe.sweeps.effects",
    "spectrum": "gearfe.signal.spectra",
    "told_apart": "gearfe.sweeps.effects",
    "squared_envelope_spectrum": "gearfe.signal.spectra",
    "stress_intensity": "gearfe.elements.fracture",
    "stress_intensity_along_front": "gearfe.elements.crack_front",
    "sweep": "gearfe.sweeps.run",
    "sweep_report": "gearfe.reports.sweep_page",
    "synchronous_average": "gearfe.signal.orders",
    "tooth_flexibility": "gearfe.elements.loaded_tooth",
    "bearing_lines": "gearfe.signal.bearing_lines",
    "Campbell": "gearfe.machine.campbell",
    "campbell": "gearfe.machine.campbell",
    "plot_campbell": "gearfe.pictures.campbell_plot",
    "deconvolve": "gearfe.signal.deconvolution",
    "dynamic_factors": "gearfe.motion.dynamic_factor",
    "frequency_response": "gearfe.machine.frequency_response",
    "mesh_modulation": "gearfe.signal.mesh_modulation",
    "modal_energy": "gearfe.machine.modal_energy",
    "with_own_speed": "gearfe.signal.own_speed",
    "write_contact_inp": "gearfe.elements.contact_inp",
    "write_inp": "gearfe.elements.deck",
    "write_line_inp": "gearfe.elements.line_deck",
}
__all__ = sorted(_HOME)


def __getattr__(name):
    """Load the public names on first use, so that ``gearfe --help`` stays quick."""
    if name == "__version__":
        from importlib.metadata import version

        return version("gearfe")
    if name not in _HOME:
        raise AttributeError(f"gearfe has no {name!r}; it has {', '.join(__all__)}")
    from .threads import loading

    with loading:
        value = getattr(importlib.import_module(_HOME[name]), name)
    globals()[name] = value
    return value


def __dir__():
    """Public names."""
    return __all__
