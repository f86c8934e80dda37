"""Valid arguments of every public function and record, small enough to be called thousands of times."""

import dataclasses
import inspect
from functools import cache

import numpy as np
from comparison.test_machine_fit import DAMPING
from dynamics.test_models import PAIRS
from objects import (
    STUDY,
    average,
    contact,
    curve,
    file,
    healthy_record,
    helical,
    law,
    machine,
    meshes,
    pair,
    response,
    rexs,
    runs,
    scene,
    set_curves,
    signal,
    stage,
    train,
    written,
)
from planetary_sets.sets import STEEL, gears
from planetary_sets.sets import case as set_case
from runs.datasets.test_dataset_plan import SMALL

import gearfe as gf


@cache
def machine_fit():
    return gf.fit_machine(**called(CALLS["fit_machine"]))


def fields(record):
    """Arguments that make this record."""
    return {field.name: getattr(record, field.name) for field in dataclasses.fields(record) if field.init}


def called(arguments):
    """Arguments with functions without parameters called."""
    made = {name: inspect.isfunction(value) or hasattr(value, "cache_info") for name, value in arguments.items()}
    return {name: value() if made[name] else value for name, value in arguments.items()}


def arguments_of(name):
    """Valid arguments of a public function or record; those not stated have their defaults."""
    stated = CALLS[name]
    stated = called(stated() if inspect.isfunction(stated) else stated)
    parameters = inspect.signature(getattr(gf, name)).parameters.values()
    default = {one.name: one.default for one in parameters if one.default is not one.empty}
    return {key: value for key, value in default.items() if "FACTORY" not in type(value).__name__} | stated


def call(name, arguments):
    """Call a public function or record."""
    function = getattr(gf, name)
    parameters = inspect.signature(function).parameters.values()
    places = [one.name for one in parameters if one.kind is one.POSITIONAL_ONLY]
    named = {key: value for key, value in arguments.items() if key not in places}
    return function(*[arguments[key] for key in places], **named)


@cache
def surrogate():
    return gf.fit_surrogate(**called(FIT))


CASE = {"pair": pair, "force": 2000.0, "material": STEEL}
QUICK = {"method": "textbook", "phases": [0.5]}
LOADED = {"gear": lambda: pair().gear_1, "radius": 21.0, "line_load": 100.0, "material": STEEL, "refine": 0.4}
BODIES = (gf.Body("one", 1.0, 1e-3), gf.Body("two", 2.0, 4e-3))
ROW = np.ones(1)
MEMBER = gf.Member(1.0, 1e-3, 1e8, 0.03)
CRACK = gf.Crack(level=0.3)
OPTIONS = QUICK | {
    "span": "cycle",
    "extended": True,
    "state": "plane strain",
    "refine": 1.0,
    "order": None,
    "teeth": None,
    "variants": None,
    "error": False,
    "cache": False,
    "tell": None,
    "pose": "mean",
}
OTHER = {"damage": None, "flanks": None, "misalignment": None, "supports": None, "face": None, "groove": 0.0}
FIT = {"pair": pair, "material": STEEL, "inputs": {"force": (500.0, 2000.0)}, "cases": 16, "held_back": 8, "workers": 1}
SOLVE = lambda: gf.Solve(**QUICK)  # noqa: E731
MESH = {
    "damping": 10.0,
    "damping_per_stiffness": 1e-6,
    "zeta": 0.0,
    "power": 1.0,
    "depth": 0.0,
    "push": False,
    "backlash": 1e-6,
    "film": 1.0,
    "gap": 0.0,
}

# fmt: off
CALLS = {  # values that are functions without arguments are called, so that nothing is computed before it is needed
    "BackFlanks": {"start": 0.1, "stiffness": 1e8},
    "Body": {"name": "one", "mass": 1.0, "inertia": 1e-3, "across": 1e-3},
    "Campbell": lambda: fields(gf.campbell(machine(), (0.5, 2.0))),
    "Case": CASE | OTHER,
    "Chip": {"depth": 1.0},
    "Convergence": lambda: fields(gf.convergence(gf.Case(**called(CASE)), gf.Solve("ritz", phases=[0.5]), refines=(0.5, 1.0))),
    "Crack": {"level": 0.3},
    "CrackModel": {},
    "Dataset": lambda: {name: getattr(gf.dataset(SMALL, file("set"), workers=1), name) for name in ("folder", "about")},
    "Fault": {"gear": "sun", "tooth": 0, "what": "pit", "frequency": 1.0, "turning": 2.0},
    "Flank": {},
    "ForceLaw": {name: lambda name=name: getattr(law(), name) for name in ("phase", "load", "depth", "tangent", "pairs",
        "force")},
    "FrontIntensity": dict.fromkeys(("z", "depth", "K_I", "K_II", "K_III"), np.ones(3)) | {"unknowns": 100},
    "Gear": {"z": 21, "m_n": 2.0, "alpha_n": 0.35, "b": 20.0, "r_bore": 7.4},
    "GearMesh": {"name": "m", "row": ROW, "stiffness": 1e8, "frequency": 100.0} | MESH,
    "GearPair": {"gear_1": lambda: pair().gear_1, "gear_2": lambda: pair().gear_2, "a": 52.0},
    "Growth": {"cracks": (CRACK,), **dict.fromkeys(("length", "K_I", "K_II", "K_min", "cycles"), np.ones(1)),
        "outcome": "steps", "why": ""},
    "IsoRootStress": {"stress": 100.0, "Y_F": 1.0, "Y_S": 2.0, "radius": 1.0},
    "LawError": {"loads": 0.1, "phases": 0.1, "loads_rms": 0.1, "phases_rms": 0.1},
    "Layout": {"bodies": BODIES},
    "Load": {"name": "l", "row": ROW, "value": 1.0},
    "Machine": {"dofs": ("one.x",), "mass": np.ones(1), "springs": (gf.Spring("s", ROW, 1e6),), "meshes": (), "spin": 0.0},
    "MachineFit": lambda: fields(machine_fit()),
    "Material": {"E": 2e5, "nu": 0.3},
    "Member": {"mass": 1.0, "inertia": 1e-3, "bearing": 1e8, "r_b": 0.03, "torsion": 1.0},
    "MeshCycle": lambda: fields(gf.mesh_cycle(gf.Case(**called(CASE | {"damage": {"pinion": [CRACK]}})), gf.Solve("textbook",
        phases=8))),
    "Misalignment": {},
    "MissingTooth": {"tooth": 0},
    "OwnFlexibility": {"pinion": lambda: lambda radius, line_load: 1e-6 * np.ones((len(radius),) * 2)},
    "PairModel": {"function": lambda: lambda phase: 1e8 * np.ones_like(phase)},
    "ParisLaw": {"C": 1e-13, "m": 3.0},
    "Pit": {"radius": 21.0, "z": 10.0, "axes": (1.0, 1.0), "depth": 0.1},
    "PlanetaryCase": {"gears": gears, "force": 2000.0, "material": STEEL},
    "PlanetarySet": {"sun": lambda: gears().sun, "planet": lambda: gears().planet, "ring": lambda: gears().ring, "n_planets": 3},
    "Response": lambda: fields(response()),
    "RimBed": {"radial": 1e3, "tangential": 1e3},
    "RimSupports": {"count": 6, "width": 5.0, "radial": 1e5, "tangential": 1e5},
    "RootStress": dict.fromkeys(("z", "stress", "radius"), np.ones(3)) | {"unknowns": 100},
    "Runs": lambda: fields(runs()),
    "Samples": {"phase": np.arange(3.0) / 3, "k": np.full(3, 1e8)},
    "SetCurves": lambda: fields(set_curves()),
    "Shaft": {"segments": [(100.0, 30.0)], "bearings": (0.0, 100.0), "gear": 40.0, "material": STEEL, "torque": None},
    "Signal": {"values": np.ones(10), "rate": 100.0, "unit": "m/s^2", "shaft_frequency": 10.0},
    "Solve": OPTIONS,
    "Spall": {"radius": 21.0, "z": 10.0, "sides": (1.0, 1.0), "depth": 0.1},
    "Speed": {"times": (0.0, 1.0), "factors": (0.5, 1.0)},
    "Spring": {"name": "s", "row": ROW, "k": 1e6, "c": 1.0},
    "Stage": {"name": "one", "driver": ("a",), "follower": ("b",), "mesh": 100.0, "turning": 5.0},
    "StiffnessCurve": {name: lambda name=name: getattr(curve(), name) for name in ("phase", "k", "k_tangent", "deflection",
        "order", "force", "pressure", "error", "meta")},
    "Support": {"radial": 1e5, "tilt": 1e8, "torsion": 1e8, "axial": 1e5},
    "Surrogate": lambda: fields(surrogate()),
    "ToothDamage": {"body": 0, "tooth": 0, "curve": curve},
    "TransmissionError": lambda: fields(gf.transmission_error(pair(), 2000.0, STEEL, method="textbook")),
    "animate_planetary_set": {"curves": set_curves, "path": lambda: file("set.gif")},
    "back_phase": {"pair": pair},
    "batch": {"cases": lambda: [gf.Case(**called(CASE))], "work": lambda: lambda case: gf.solve(case, SOLVE()), "workers": 1},
    "bearing_lines": {"turns": 10.0, "rollers": 8, "roller": 5.0, "pitch": 30.0},
    "build_machine": {"scene": scene, "method": "ritz", "phases": 8},
    "build_set": {"scene": lambda: scene("planetary_pitting")},
    "campbell": {"machine": machine, "speeds": (0.5, 2.0)},
    "cepstrum": {"signal": signal},
    "compare": CASE | {"phases": [0.5]},
    "compound_planetary": {"stiffness": dict.fromkeys(PAIRS, 1e9), "pairs": PAIRS},
    "contact_pattern": CASE | {"phases": [0.5]},
    "converged_force_law": {"pair": pair, "smallest": 500.0, "largest": 1000.0, "material": STEEL, "method": "textbook",
        "error": 0.1},
    "convergence": {"case": lambda: gf.Case(**called(CASE)), "how": lambda: gf.Solve("ritz", phases=[0.5]), "refines": (0.5,
        1.0)},
    "critical_speeds": {"machine": machine, "rpm": 1000.0, "speeds": (0.5, 2.0)},
    "decimate": {"signal": signal, "rate": 1024.0},
    "curve_bands": {"runs": runs},
    "dataset": {"plan": SMALL, "folder": lambda: file("set"), "workers": 1},
    "deconvolve": {"signal": signal, "frequency": 10.0, "length": 20, "iterations": 3},
    "demodulate": {"signal": signal, "fault_frequency": 10.0},
    "dynamic_factors": {"response": response},
    "envelope": {"signal": signal, "band": (150.0, 250.0)},
    "error_map": {"pairs": 1, "phases": 2, "loads": (10.0,), "workers": 1},
    "expected_lines": {"mesh_frequency": 500.0, "fault_frequency": 10.0, "carrier_frequency": 1.0},
    "export_mesh": {"path": lambda: file("mesh.msh"), "gear": lambda: pair().gear_1, "refine": 0.4},
    "face_load_distribution": {"contact": lambda: contact()},
    "fast_kurtogram": {"signal": signal, "levels": 2},
    "find_lines": {"found": lambda: gf.spectrum(signal()), "lines": {"mesh": 200.0}},
    "fit_machine": {"scene": lambda: train(), "record": lambda: healthy_record(), "vary": {DAMPING: (1e-6, 2e-5)},
        "channel": "a.theta acceleration", "harmonics": 2},
    "fit_surrogate": FIT,
    "force_law": {"pair": pair, "forces": [500.0, 1000.0], "material": STEEL, "phases": 8, "method": "textbook"},
    "frequency_response": {"machine": stage, "frequencies": [10.0, 20.0], "output": "sun.x", "input": "sun.x"},
    "gear_indicator_table": {"signals": lambda: {"healthy": signal()}, "teeth": 20},
    "gear_indicators": {"average": average, "teeth": 20},
    "gear_member": {"gear": lambda: pair().gear_1, "density": 7800.0, "bearing": 1e8},
    "gear_pair_machine": {"pair": pair, "bodies": BODIES, "stiffness": 1e8, "speed": 100.0, "torque": 10.0,
        "support": {"x": 1e8, "y": 1e8}} | MESH,
    "grow_crack": {"case": lambda: gf.Case(**called(CASE)), "crack": CRACK, "steps": 1, "refine": 0.5},
    "herringbone_planetary": {"stage": gears, "stiffness": {"sun_planet": 3e8, "planet_ring": 4e8}},
    "housing_signal": {"response": response},
    "import_rexs": {"path": lambda: rexs()},
    "indicator_table": {"signals": lambda: {"healthy": signal(), "hurt": signal()}, "mesh_frequency": 200.0,
        "fault_frequency": 10.0},
    "integrate": {"signal": signal, "times": 1, "above": 10.0, "unit": "m/s"},
    "iso_root_stress": {"pair": pair, "force": 2000.0},
    "law_error": {"law": law},
    "load_scene": {"name_or_path": "planetary_pitting"},
    "main_effects": {"runs": runs, "output": "k_mean"},
    "mesh_cycle": {"case": lambda: gf.Case(**called(CASE | {"damage": {"pinion": [CRACK]}})),
        "how": lambda: gf.Solve("textbook", phases=8)},
    "mesh_excitation": {"curve": curve},
    "mesh_modulation": {"average": average, "teeth": 20},
    "mesh_stiffness": CASE | OTHER | OPTIONS,
    "modal_energy": {"machine": stage},
    "mode_words": {"machine": stage, "energy": lambda: gf.modal_energy(stage()), "mode": 3},
    "natural_frequencies": {"machine": stage},
    "new_scene": {"path": lambda: file("new.toml"), "teeth": (21, 31), "torque_Nm": 40.0, "crack": (0.3, 60.0),
        "tip_relief_um": 10.0,
        "tip_length_mm": 1.0},
    "open_dataset": {"folder": lambda: str(gf.dataset(SMALL, file("set"), workers=1).folder)},
    "open_runs": {"folder": lambda: str(runs().folder)},
    "order_spectrum": {"signal": signal, "samples_per_turn": 512},
    "phase_portrait": {"signal": signal, "velocity": signal},
    "pitted_helical": {"pair": helical, "materials": (STEEL, STEEL)},
    "pitted_planetary": {"stage": gears, "stiffness": {"sun_planet": 3e8, "planet_ring": 4e8}} | MESH,
    "planetary": dict.fromkeys(("sun", "planet", "ring", "carrier"), MEMBER) | {"n_planets": 3, "alpha": (0.35, 0.35),
        "stiffness": {"sun_planet": 3e8, "planet_ring": 4e8}},
    "planetary_stiffness": {"case": set_case, "positions": 1, "refine": 0.4, "error": False},
    "plan_sweep": {"study": STUDY, "folder": lambda: file("runs"), "workers": 1},
    "plot_campbell": {"found": lambda: gf.campbell(machine(), (0.5, 2.0)), "path": lambda: file("campbell.png")},
    "plot_contact": {"pair": helical, "contact": contact, "path": lambda: file("contact.png")},
    "plot_kurtogram": {"kurtogram": lambda: gf.fast_kurtogram(signal(), 2), "path": lambda: file("kurtogram.png")},
    "plot_pair": {"pair": pair, "path": lambda: file("pair.png")},
    "plot_phase": {"portrait": lambda: gf.phase_portrait(signal()), "path": lambda: file("phase.png")},
    "plot_planetary_set": {"curves": set_curves, "path": lambda: file("set.png")},
    "plot_spectra": {"spectra": lambda: {"one": gf.spectrum(signal())}, "path": lambda: file("spectra.png")},
    "plot_spectrogram": {"spectrogram": lambda: gf.spectrogram(signal()), "path": lambda: file("spectrogram.png")},
    "poincare_section": {"signal": signal, "frequency": 200.0},
    "power_spectral_density": {"signal": signal, "resolution": 8.0},
    "pulses": {"base": 0.0, "peak": 1.0, "period": 1.0, "width": 0.1, "count": 3},
    "random_pitch": {"gear": lambda: pair().gear_1, "iso_class": 5, "seed": 0},
    "read_model": {"path": lambda: written("model.csv", "phase,k [N/m]\n" + "".join(f"{k / 8},{1e8 + k}\n" for k in range(8)))},
    "read_signal": {"path": lambda: written("signal.csv",
        "t [s],a [m/s^2]\n" + "".join(f"{k / 100},{k % 7}\n" for k in range(64)))},
    "read_signals": {"path": lambda: written("signal.csv",
        "t [s],a [m/s^2]\n" + "".join(f"{k / 100},{k % 7}\n" for k in range(64)))},
    "render_mesh": {"parts": lambda: meshes(), "path": lambda: file("mesh.png"), "size": (60, 40)},
    "render_stress": {"pair": lambda: gf.Case(**called(CASE)), "path": lambda: file("stress.png"), "size": (60, 40),
        "refine": 0.4},
    "report": {"scene": scene, "path": lambda: file("report.html"), "duration": 0.05, "phases": 8},
    "residual_signal": {"average": average, "teeth": 20},
    "ring_window": {"radius": 0.1, "bending": 1e3, "foundation": 1e6},
    "roc_auc": {"healthy": [1.0, 2.0], "damaged": [2.0, 3.0]},
    "root_stress": LOADED,
    "root_stress_along_width": LOADED,
    "root_stress_of_contact": {"pair": helical, "contact": contact, "index": 0, "material": STEEL, "refine": 0.5},
    "scene_lines": {"scene": scene},
    "simulate": {"machine": machine, "duration": 0.02, "rate": 2e4, "step": 1e-5},
    "single_mesh": {"mass": 1.0, "stiffness": 1e8, "frequency": 500.0} | MESH,
    "solve": {"case": lambda: gf.Case(**called(CASE)), "how": SOLVE},
    "sobol_indices": {"runs": runs, "output": "k_mean"},
    "spectrogram": {"signal": signal, "size": 256},
    "spectrum": {"signal": signal},
    "squared_envelope_spectrum": {"signal": signal, "band": (150.0, 250.0)},
    "stage_lines": {"sun": 21, "ring": 84, "n_planets": 3, "carrier": 1.0},
    "stage_phases": {"pairs": lambda: (gears().sun_planet, gears().planet_ring), "n_planets": 3},
    "steady_state": {"machine": machine, "period": 0.002},
    "stress_intensity": LOADED | {"crack": CRACK},
    "stress_intensity_along_front": LOADED | {"crack": CRACK},
    "sweep": {"study": STUDY, "folder": lambda: file("runs"), "workers": 1},
    "sweep_report": {"runs": runs, "path": lambda: file("sweep.html")},
    "synchronous_average": {"signal": signal, "samples_per_turn": 512},
    "through_frf": {"force": signal, "frequency": [0.0, 3000.0], "response": [1.0, 1.0]},
    "through_modes": {"force": signal, "modes": [(100.0, 0.05, 1.0)]},
    "tooth_flexibility": {name: value for name, value in LOADED.items() if name != "line_load"},
    "transmission_error": {"pair": pair, "forces": 2000.0, "material": STEEL, "method": "textbook"},
    "with_back_flanks": {"machine": lambda: gf.single_mesh(1.0, curve(), 500.0, backlash=1e-4),
        "back": {"mesh": gf.BackFlanks(0.1)}},
    "with_errors": {"machine": stage},
    "with_estimated_speed": {"signal": signal, "order": 20.0, "speeds": (9.9, 10.1), "harmonics": 1},
    "with_set": {"machine": stage, "curves": set_curves, "ring": "lumped"},
    "with_speed": {"machine": machine, "times": (0.0, 1.0), "factors": (0.5, 1.0)},
    "with_tachometer": {"signal": signal, "tachometer": np.arange(20) / 10.0},
    "write_contact_inp": {"path": lambda: file("pair.inp"), "pair": lambda: gf.Case(**called(CASE)), "phase": 0.5,
        "approach": 0.01, "refine": 0.4},
    "write_fmu": {"path": lambda: file("mesh.fmu"), "case": lambda: gf.Case(**called(CASE)),
        "how": lambda: gf.Solve("textbook", phases=8)},
    "write_inp": LOADED | {"path": lambda: file("section.inp")},
    "write_line_inp": LOADED | {"path": lambda: file("line.inp")},
    "write_mesh_table": {"path": lambda: file("mesh.mat"), "case": lambda: gf.Case(**called(CASE)),
        "how": lambda: gf.Solve("textbook", phases=8)},
    "write_outline": {"path": lambda: file("gear.svg"), "gear": lambda: pair().gear_1},
    "write_rexs": {"path": lambda: file("gear.rexs"), "scene": scene},
    "write_set_inp": {"path": lambda: file("set.inp"), "curves": set_curves, "at": 0, "refine": 0.4},
    "write_step": {"path": lambda: file("gear.step"), "gear": lambda: pair().gear_1},
}
# fmt: on
