"""The ``gearfe`` command and its arguments; what its verbs do is in `gearfe.app.cli.verbs`."""

import argparse
import os
from functools import partial

from ...stiffness.methods import NAMES, described, having
from . import exchange, filling, sets, shell, signals, tools
from . import verbs as run

SIGNALS = (".csv", ".txt", ".mat", ".npz", ".h5", ".wav", ".uff", ".tdms", ".parquet", ".lvm")  # as of gearfe.core.files


def _ratio(text):
    """Ratio of speeds, ``0.305`` or ``29/95``."""
    from fractions import Fraction

    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r} is not a speed ratio: give for example 29/95 or 0.305") from None


def main(argv=None):
    """Run the command line; returns the exit code."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy loads: on small matrices more threads wait for each other
    parser = argparse.ArgumentParser(
        prog="gearfe", description="Compute gear mesh stiffness, transmission error and gearbox vibration."
    )
    parser.add_argument("--version", action=_Version, help="print the version and exit")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    verb = partial(_verb, verbs)
    methods = {"formatter_class": argparse.RawDescriptionHelpFormatter, "epilog": f"methods:\n{described()}"}
    text = "compute the mesh stiffness over the mesh cycle; print it by zone, save it, plot it"
    add = verb("stiffness", run.stiffness, text, **methods)
    _scene_arguments(add)
    known = ", ".join(name for name in NAMES if name != "auto")
    add("--method", f"{known} (see below; default: ritz or ritz3d)", default="auto")
    add("--force N", "force along the line of action [N] (default: the force of the scene)", type=float)
    add("--no-extended", "neglect tip-corner contact outside the path of contact")
    add(
        "--pose",
        "gear that rotates under load: both by half, or only pinion or wheel (default: mean)",
        choices=("mean", "pinion", "wheel"),
        default="mean",
    )
    add("--error", f"estimate the discretisation error of every k ({having('error')})")
    add("--forces N", argparse.SUPPRESS, nargs="+", type=float)  # former options: the verb te has them
    add("--torques NM", argparse.SUPPRESS, nargs="+", type=float)
    add("-o --output FILE", "save the curve: .csv, .npz, .mat or .json")
    add("--plot FILE", "draw the curve: .png, .svg or .pdf")
    add = verb("te", run.transmission_error, "compute the transmission error over the mesh cycle, loaded and unloaded", **methods)
    _scene_arguments(add)
    add("--method", f"{known} (see below; default: ritz or ritz3d)", default="auto")
    add("--forces N", "forces along the line of action [N] (default: the force of the scene)", nargs="+", type=float)
    add("--torques NM", "torques of the pinion instead of forces [N m]", nargs="+", type=float)
    add("--no-extended", "neglect tip-corner contact outside the path of contact")
    add("-o --output FILE", ".csv: transmission error over the phase at each load; .md or .tex: the table as printed")
    add("--plot FILE", "draw the transmission error: .png, .svg or .pdf")
    add = verb("compare", run.compare, "compare formulations with finite elements: table of errors by zone, with cost")
    _scene_arguments(add)
    add(
        "--model FILE",
        "user-defined stiffness model, may be repeated: file.py:function, k [N/m] at an array of mesh phases from 0 to "
        "1; or two columns, units in the header: first phase (0: a pair enters), angle [deg] or angle [rad] (of the "
        "pinion), or radius [mm] (one tooth pair, on the pinion); then k in N/m, N/mm, N/um (or kN, MN, GN), or per "
        "width in N/(mm um) or N/(m um); or a .csv or .mat written by gearfe; damaged.csv,healthy.csv adds the losses",
        action="append",
        default=[],
    )
    add("--plot FILE", "draw all curves: .png, .svg or .pdf")
    add(
        "-o --output FILE",
        ".csv: k, errors, losses and seconds by pair, case, method and zone; .md or .tex: the table of errors as printed",
    )
    add("--all-cases --cases", "compare every pair in every damage case (default if the scene lists published stiffness values)")
    add(
        "--reference METHOD",
        "reference method for the errors: fe3d (three-dimensional finite elements, minutes and several GB; less with a "
        "smaller --refine; default of the option) or ritz3d",
        nargs="?",
        const="fe3d",
    )
    add = verb("render", run.render, "draw the tooth stress or the contact pattern to a file (works without a display)")
    _scene_arguments(add, count=False)
    add(
        "--phase X",
        "mesh phase to draw (default: maximum load on the damaged tooth; healthy gears: 0 for the stress of spur gears, "
        "otherwise maximum load on tooth pair 0)",
        type=float,
    )
    add(
        "--what",
        "von Mises stress (in three dimensions for pits and helical gears); contact pressure along the contact lines of "
        "one phase, and load over the face width; or both over a mesh cycle, with the largest pressure and the face load "
        "factor (default: stress)",
        choices=["stress", "contact", "pattern"],
        default="stress",
    )
    add("-o --output FILE", "picture: .png; stress also as .vtu: mesh, displacement, stress", required=True)
    add = verb("mesh", run.mesh, "write the mesh of a damaged gear, whole or a few teeth, for other programs")
    _scene_arguments(add, count=False)
    add("--gear", "gear of the pair (default: pinion)", choices=("pinion", "wheel"), default="pinion")
    add("--cells", "type of elements (default: hexahedra; tetrahedra with pits or --teeth)", choices=("hexahedra", "tetrahedra"))
    add("--teeth N", "odd number of teeth around the damaged one (default: all)", type=int)
    add("-o --output FILE", "the mesh: .msh, .vtu or .inp", required=True)
    add("--picture FILE", "draw it too: .png")
    add("--close-up", "with --picture: draw only the surroundings of the damage", choices=("crack", "pits"))
    add = verb("dynamics", run.dynamics, "simulate the vibration of a gearbox; print spectral lines and condition indicators")
    add("scene SCENE", "a built-in scene with a machine, or a .toml file")
    add("--case NAME", "case of damage, compared with healthy (default: healthy alone)")
    add(
        "--duration S",
        "duration of the record [s], after the start-up transient has decayed to 0.1 %% (at most 20 s; default: that which "
        "resolves the sidebands of the damage, 1 to 5)",
        type=float,
    )
    add("--channel NAME", "channel to analyse, e.g. 'sun.theta acceleration' (default: first mesh's force)")
    add("--contact", "contact law (default: the scene's, else linear)", choices=("linear", "impact"))
    add(
        "--loads X",
        "load-dependent mesh force, from static solutions at these multiples of the static mesh force, e.g. 0.0625 0.25 "
        "0.5 1 2; use it near resonance or for varying loads (default: 1, a time-varying stiffness)",
        nargs="+",
        default=(1.0,),
        type=float,
    )
    add("--method", "integrator: fast, or a method of scipy's solve_ivp, e.g. DOP853 (default: fast)", default="fast")
    add("-o --output FILE", "save the response: .csv, .npz or .mat")
    _assumptions(add)
    _analysis_arguments(add)
    add = verb(
        "planetary",
        sets.planetary_set,
        "solve all meshes of a planetary gear set together: mesh stiffness, load sharing, pictures",
        aliases=["set"],
    )
    add("scene SCENE", "a .toml file with a [set] table")
    add("--case NAME", "case of cracks, compared with healthy (default: healthy alone)")
    add("--positions N", "minimum number of sun positions (default: 32)", default=32)
    add(
        "--cycles N",
        "mesh cycles covered by the positions (default: 1; for a ring gear on pads: one pad pitch; 2 if --case is given, "
        "in which tooth 0 is in mesh)",
        type=int,
    )
    add("--refine X", "finite-element resolution: divisor of the edge lengths (default: 1)", default=1.0)
    add("-o --output FILE", "save loads, stiffness and transmission error: .csv, .npz, .mat or .json")
    add("--plot FILE", "draw them over the positions: .png, .svg or .pdf")
    add("--picture FILE", "draw the deformed set, coloured by stress: .png, .svg or .pdf")
    add("--animate FILE", "animate the deformed set over a mesh cycle or --cycles: .gif")
    _assumptions(add)
    add = verb("signal", signals.signal, "analyse measured signals: spectral lines, indicators, kurtogram, squared envelope")
    add(
        "file FILE",
        f"signal as {', '.join(SIGNALS)}; several: cases, the first healthy; a folder: trend over its records",
        nargs="+",
    )
    add("-o --output FOLDER", "write all analyses as pictures and tables, and a page with the verdict, into this folder")
    add("--list", "only list the channels of the files")
    add("--rate HZ", "sampling rate, if the file does not state it", type=float)
    add("--unit U", "unit, if the file does not state it")
    add("--column NAME", "column (channel) to analyse, if there are several")
    add("--header TEXT", "column names and units for a table that has no header line, e.g. 'time [s], a [m/s^2]'")
    add("--scale X", "calibration factor; --unit is the unit after scaling (default: 1)", default=1.0)
    add("--start S", "begin of the part of each record that is analysed [s] (default: 0)", default=0.0)
    add("--stop S", "end of that part [s] (default: that of the record)", default=float("inf"))
    add("--scene SCENE", "scene whose machine gives the line frequencies of the last spectrum")
    add("--case NAME", "case of damage of --scene: simulates the healthy and the damaged machine for comparison; needs --gear")
    add("--gear NAME", "gear of --scene; gives the frequencies and the number of teeth that are not stated")
    add("--mesh HZ", "mesh frequency [Hz]", type=float)
    add("--fault HZ", "fault frequency [Hz]", type=float)
    add("--carrier HZ", "carrier frequency [Hz]", type=float)
    add("--teeth Z", "number of teeth; computes FM0, FM4, NA4, ... from the synchronous average (TSA)", type=int)
    add("--shaft HZ", "rotational frequency of that gear [Hz]", type=float)
    add("--tacho NAME", "column with tachometer pulses or shaft speed [rpm], instead of --shaft")
    add(
        "--speeds",
        "lowest and highest rotational frequency of that gear [Hz]; estimates its speed from the mesh lines, instead of --shaft",
        nargs=2,
        metavar=("LOW", "HIGH"),
        type=float,
    )
    add("--pulses N", "pulses per revolution of the tachometer's shaft (default: 1)", default=1)
    add("--tacho-ratio R", "ratio of the gear's shaft speed to the tachometer's, e.g. 29/95 (default: 1)", default=1, type=_ratio)
    add("--level X", "trigger level of the tachometer pulses (default: half the highest)", type=float)
    _analysis_arguments(add)
    add("--cepstrum FILE", "draw the cepstrum of the last case: .png, .svg or .pdf")
    add("--orders FILE", "draw the order spectra: .png, .svg or .pdf")
    add("--spectrogram FILE", "draw the spectrogram of the last case: .png, .svg or .pdf")
    add = verb("report", tools.report, "write a self-contained HTML report: errors, curves, stress, vibration")
    add("scene SCENE", "a built-in scene (see 'gearfe scenes'), a .toml file, or the folder of a sweep")
    add("--case NAME", "case of damage, compared with healthy (default: the scene's first)")
    add("--duration S", "record length of the vibration [s] (default: 0.2)", default=0.2)
    add("-o --output FILE", "report file: .html", required=True)
    add = verb("sweep", filling.sweep, "run a parameter study; an interrupted study is resumed")
    add("study STUDY", "a .toml file: a scene and its variables")
    add("-o --output FOLDER", "output folder: new, or one of the same study", required=True)
    add("--workers N", "number of parallel processes (default: one per core)", type=int)
    add("--scheduler ADDRESS", "compute on the workers of this Dask scheduler, tcp://host:8786")
    add("--dry-run", "print the number of cases, time, memory and disk space; write nothing")
    add("--mixed", "resume a study that was started with another version")
    add = verb("dataset", filling.dataset, "generate a labelled vibration data set for machine learning")
    add("plan DATASET", "a .toml file: machine, faults, operation, sensors, noise, split")
    add("-o --output FOLDER", "output folder: new, or one of the same data set", required=True)
    add("--also", "also write one file per split (train, validation, test)", nargs="+", choices=("mat", "hdf5"), default=[])
    add("--workers N", "number of parallel processes (default: one per core)", type=int)
    add("--dry-run", "print the number of windows, time and disk space; write nothing")
    add = verb("new", tools.new, "create a scene file; all further keys are included as comments")
    add("output FILE", "the new file, for instance my.toml")
    add("--teeth Z", "tooth numbers of pinion and wheel (default: 21 31; with a ring 21 63)", nargs=2, type=int)
    add("--module MM", "normal module [mm] (default: 2)", default=2.0)
    add("--helix DEG", "helix angle of the pinion [degrees] (default: 0)", default=0.0)
    add("--alpha DEG", "normal pressure angle [degrees] (default: 20)", default=20.0)
    add(
        "--x",
        "profile shift coefficients of pinion and wheel (default: 0 0)",
        nargs=2,
        metavar="X",
        type=float,
        default=(0.0, 0.0),
    )
    add(
        "--bore",
        "bore diameters of pinion and wheel, of a ring its rim diameter [mm] (default: half of the root diameters)",
        nargs=2,
        metavar="MM",
        type=float,
    )
    add("--width MM", "face width [mm] (default: 20)", default=20.0)
    add("--torque NM", "pinion torque [N m] (default: 100 N per mm of face width)", type=float)
    add(
        "--crack",
        "length [mm] and angle to the centre-line [degrees] of the pinion's root crack (default: level 0.3 at 45 degrees)",
        nargs=2,
        metavar=("MM", "DEG"),
        type=float,
    )
    add(
        "--tip-relief",
        "tip relief of both gears [um] and its roll length below the tip [mm], linear, e.g. --tip-relief 20 1.5 (default: none)",
        nargs=2,
        metavar=("UM", "MM"),
        type=float,
    )
    add("--ring", "the wheel is an internal gear")
    add = verb(
        "import", exchange.import_file, "convert a gear unit of another program to a scene; missing values become assumptions"
    )
    add("kind", "format of the file: REXS 1.0 to 2.0.0, as XML, JSON or zip", choices=("rexs",))
    add("file FILE", "the file: .rexs, .rexsj or .zip")
    add("--load-case N", "load case of its load spectrum (default: 1)", default=1)
    add("-o --output FILE", "the new scene (default: its name with .toml, in the present folder)")
    add = verb(
        "export", exchange.export_file, "write a pair or a gear for other programs: FMU, lookup table, REXS, outline, solid"
    )
    _scene_arguments(add, count=False)
    add("--gear", "gear of an outline or a solid (default: pinion)", choices=("pinion", "wheel"), default="pinion")
    add("--method", "stiffness method (default: ritz or ritz3d)", default="auto")
    add("--phases N", "phases per mesh cycle (default: 64)", default=64)
    add(
        "-o --output FILE",
        ".fmu: the pair as an FMU 2.0; .mat, .txt: stiffness over the angle of the pinion for Simscape and Modelica; .rexs: all "
        "gears of the scene; .dxf, .svg: outline of a gear; .step: its solid",
        required=True,
    )
    add = verb("crack", exchange.grow, "compute crack growth: the path, and the life by Paris's law")
    add("scene SCENE", "a built-in scene or a .toml file")
    add("--pair NAME", "pair of the scene (default: its first)")
    add("--case NAME", "damage case with the initial crack, the only one", required=True)
    add("--step MM", "growth increment [mm] (default: 0.1 modules)", type=float)
    add("--steps N", "maximum number of steps (default: 60)", default=60)
    add("--paris", "constants C [mm/(MPa sqrt(mm))^m] and m of Paris's law", nargs=2, metavar=("C", "M"), type=float)
    add("--threshold K", "threshold range of K [MPa sqrt(mm)] (default: 0)", default=0.0)
    add("--refine X", "resolution: divides the edge lengths (default: 1)", default=1.0)
    add(
        "--method",
        "method (default: ritz while the crack is in its sector, then fe)",
        choices=("auto", "ritz", "fe"),
        default="auto",
    )
    add(
        "--loading",
        "loads that pass over the tooth and its neighbours, or the whole load at the highest point of single contact (default: "
        "engagement)",
        choices=("engagement", "single"),
        default="engagement",
    )
    add(
        "--criterion",
        "direction of growth: largest tangential stress, largest energy release rate, or no K_II (default: tangential)",
        choices=("tangential", "energy", "shear"),
        default="tangential",
    )
    add(
        "--held",
        "arc of the bore that is held [degrees], from the cracked tooth towards its loaded side (default: all)",
        nargs=2,
        metavar=("FROM", "TO"),
        type=float,
    )
    add("--plot FILE", "draw the grown crack in its tooth: .png, .svg or .pdf")
    add = verb("check", tools.check, "summarise a scene file and show which method each case would use")
    add("scene SCENE", "a .toml file, or a built-in scene (see 'gearfe scenes')")
    add("--picture FILE", "draw a pair with its damage to scale: .png, .svg or .pdf")
    add("--pair NAME", "pair to draw (default: its first)")
    add("--case NAME", "case of damage to draw (default: the first of the pair)")
    add = verb("lines", tools.lines, "table of the frequencies of a scene's machine: meshes, shafts, teeth, planets, bearings")
    add("scene SCENE", "a .toml file, or a built-in scene with a machine (see 'gearfe scenes')")
    add("-o --output FILE", "save the table: .csv, .md or .tex")
    add("--picture FILE", "draw the shafts and gears of a gearbox: .png, .svg or .pdf")
    add = verb("modes", tools.modes, "natural frequencies in words, critical speeds and Campbell diagram of a scene's machine")
    add("scene SCENE", "a .toml file, or a built-in scene with a machine (see 'gearfe scenes')")
    add("--case NAME", "case of damage (default: healthy)")
    add("--top HZ", "largest natural frequency printed [Hz] (default: 3 times the largest mesh frequency)", type=float)
    add(
        "--speeds",
        "speeds over that of the scene (default: 0.5 1.5)",
        nargs=2,
        metavar=("LOW", "HIGH"),
        type=float,
        default=(0.5, 1.5),
    )
    add("--plot FILE", "draw the Campbell diagram: .png, .svg or .pdf")
    add = verb("schema", tools.schema, "print the JSON schema of scenes, by which an editor completes and checks their keys")
    add("--page", "print a page of all keys of scenes, studies and data sets instead, as Markdown")
    add = verb("app", tools.app, "open the live page in the browser: sliders, mesh, stiffness and transmission error")
    add("scene SCENE", "scene to open: a built-in scene or a .toml file (default: an example)", nargs="?")
    add("--pair NAME", "pair of the scene (default: its only one)")
    add("--case NAME", "case of damage (default: its only one)")
    add("--port N", "TCP port on 127.0.0.1; 0 selects a free port (default: 8033)", default=8033)
    add("--no-browser", "only serve the page, do not open it")
    add("--workers N", "solver processes (default: one per core, at least 2)", type=int)
    add("--public NAME", "host name of a reverse proxy on this computer, to share the app with a class")
    add("--users N", "maximum number of simultaneous client addresses, only with --public (default: 40)", default=40)
    add("--tasks N", "maximum number of requests per address and minute, only with --public (default: 600)", default=600)
    add = verb("completion", tools.completion, "print a shell completion script")
    add("shell", 'eval "$(gearfe completion bash)" in your shell\'s start file', choices=("bash", "zsh"))
    verbs.choices["completion"].set_defaults(verbs=verbs.choices)
    verb("scenes", run.scenes, "list the built-in scenes with their assumptions")
    add = verb("info", tools.info, "print versions, hardware and missing optional packages")
    add("--cite", "print the BibTeX entry of this version instead")
    arguments = parser.parse_args(argv)
    _refuse_nothing(verbs.choices[arguments.verb], arguments)
    return shell.run(lambda: arguments.run(arguments), [name for name in vars(arguments) if name not in ("verb", "run", "verbs")])


def _refuse_nothing(parser, arguments):
    """Refuse ``--force=--``, of which argparse of older Pythons makes an empty list."""
    for action in parser._actions:
        value = getattr(arguments, action.dest, None)
        if action.nargs is None and value != action.default and (value == [] or value == [[]]):
            parser.error(f"argument {'/'.join(action.option_strings)}: expected one argument")


class _Version(argparse.Action):
    """Prints the version; looked up only if asked for, because that takes time."""

    def __init__(self, option_strings, dest, help=None):
        super().__init__(option_strings, dest, nargs=0, help=help)

    def __call__(self, parser, *_):
        from importlib.metadata import version

        print(f"gearfe {version('gearfe')}")
        parser.exit()


def _verb(verbs, name, function, text, **options):
    """Add a verb; gives the function that adds its arguments."""
    verb = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".", **options)
    verb.set_defaults(run=function)

    def add(names, text, **options):
        """Add an option: ``"-o --output FILE"``, or a switch if nothing follows its name; a default states the type."""
        flags = names.split()
        if not flags[-1].startswith("-") and len(flags) > 1:
            options["metavar"] = flags.pop()
        elif flags[0].startswith("-") and not options:
            options["action"] = "store_true"
        if isinstance(options.get("default"), (int, float)):
            options.setdefault("type", type(options["default"]))
        verb.add_argument(*flags, help=text, **options)

    return add


def _analysis_arguments(add):
    add("--plot FILE", "draw the spectra: .png, .svg or .pdf")
    add("--kurtogram FILE", "draw the fast kurtogram of the last case: .png, .svg or .pdf")


def _assumptions(add):
    add("--assumptions", "print all assumptions of the scene, with their reasons")


def _scene_arguments(add, *, count=True):
    add("scene SCENE", "a built-in scene (see 'gearfe scenes') or a .toml file")
    add("--pair NAME", "pair of the scene (default: its first)")
    add("--case NAME", "case of damage (see 'gearfe scenes'; default: healthy)")
    add("--refine X", "finite-element resolution: divisor of the edge lengths (default: 1)", default=1.0)
    if count:
        _assumptions(add)
        add("--phases N", "phases per mesh cycle (default: 64)", default=64)
