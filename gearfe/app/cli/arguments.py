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
        raise argparse.ArgumentTypeError(f"{text!r} is no ratio of speeds: give 29/95 or 0.305") from None


def main(argv=None):
    """Run the command line; returns the exit code."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy loads: on small matrices more threads wait for each other
    parser = argparse.ArgumentParser(
        prog="gearfe", description="Gear mesh stiffness with its error: finite elements beside energy methods."
    )
    parser.add_argument("--version", action=_Version, help="show the version and leave")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    verb = partial(_verb, verbs)
    methods = {"formatter_class": argparse.RawDescriptionHelpFormatter, "epilog": f"methods:\n{described()}"}
    add = verb("stiffness", run.stiffness, "compute a stiffness curve; print it by zone, save it, draw it", **methods)
    _scene_arguments(add)
    known = ", ".join(name for name in NAMES if name != "auto")
    add("--method", f"{known} (see below; default: ritz or ritz3d)", default="auto")
    add("--force N", "force along the line of action [N]; default: the scene's", type=float)
    add("--no-extended", "no tip-corner contact outside the path of contact")
    add(
        "--pose",
        "who turns under load: both gears alike, or one against the held other (default: mean)",
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
    add("--plot FILE", "draw the transmission error: .png, .svg or .pdf")
    add = verb("compare", run.compare, "table of every formulation's error against finite elements, by zone, with cost")
    _scene_arguments(add)
    add(
        "--model FILE",
        "a stiffness model of your own, may be repeated: file.py:function, k [N/m] at an array of mesh phases from 0 to "
        "1; or two columns, units in the header: first phase (0: a pair enters), angle [deg] or angle [rad] (of the "
        "pinion), or radius [mm] (one tooth pair, on the pinion); then k in N/m, N/mm, N/um (or kN, MN, GN), or per "
        "width in N/(mm um) or N/(m um); or a .csv written by gearfe",
        action="append",
        default=[],
    )
    add("--plot FILE", "draw all curves: .png, .svg or .pdf")
    add(
        "-o --output FILE",
        ".csv: k, errors, losses and seconds by pair, case, method and zone; .md or .tex: the table of errors as printed",
    )
    add("--all-cases --cases", "all pairs in all cases of damage (default: those of a scene whose source prints their stiffness)")
    add(
        "--reference METHOD",
        "what errors are against: fe3d (default of the option), finite elements of whole gears, minutes and gigabytes "
        "for each (fewer with a smaller --refine); or ritz3d",
        nargs="?",
        const="fe3d",
    )
    add = verb("render", run.render, "picture of the stress of the loaded teeth, or of their contact pattern, without a screen")
    _scene_arguments(add, count=False)
    add(
        "--phase X",
        "mesh phase (default: where the damaged tooth carries most; of healthy gears: stress of spur gears at 0, others "
        "and contact where pair 0 carries most)",
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
    add("--gear", "which gear of the pair (default: pinion)", choices=("pinion", "wheel"), default="pinion")
    add("--cells", "default: tetrahedra with pits or --teeth", choices=("hexahedra", "tetrahedra"))
    add("--teeth N", "odd number of teeth around the damaged one (default: all)", type=int)
    add("-o --output FILE", "the mesh: .msh, .vtu or .inp", required=True)
    add("--picture FILE", "draw it too: .png")
    add("--close-up", "with --picture: only what is around the damage", choices=("crack", "pits"))
    add = verb("dynamics", run.dynamics, "response of a scene's machine: spectrum lines and indicators, healthy and damaged")
    add("scene SCENE", "a built-in scene with a machine, or a .toml file")
    add("--case NAME", "case of damage, compared with healthy (default: healthy alone)")
    add(
        "--duration S",
        "seconds kept, from when free vibrations have fallen to a thousandth (at most 20 s are left out; default: 1)",
        default=1.0,
    )
    add("--channel NAME", "channel to analyse, e.g. 'sun.theta acceleration' (default: first mesh's force)")
    add("--contact", "contact law (default: the scene's, else linear)", choices=("linear", "impact"))
    add(
        "--loads X",
        "laws of force solved under these multiples of the meshes' own loads, e.g. 0.0625 0.25 0.5 1 2: for resonances "
        "and loads that change (default: 1, a stiffness over the phase)",
        nargs="+",
        default=(1.0,),
        type=float,
    )
    add("--method", "fast or a method of scipy's solve_ivp, e.g. DOP853 (default: fast)", default="fast")
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
    add("--positions N", "positions of the sun, at least (default: 32)", default=32)
    add(
        "--cycles N",
        "mesh cycles that they are spread over (default: 1; of a ring on pads a pitch of the pads; with --case 2, in "
        "which tooth 0 goes through its mesh)",
        type=int,
    )
    add("--refine X", "finite-element resolution: divides the edge lengths (default: 1)", default=1.0)
    add("-o --output FILE", "save loads, stiffness and transmission error: .csv, .npz, .mat or .json")
    add("--plot FILE", "draw them over the positions: .png, .svg or .pdf")
    add("--picture FILE", "draw the set bent under its load, coloured by stress: .png, .svg or .pdf")
    add("--animate FILE", "the same moving, over a mesh cycle or --cycles: .gif")
    _assumptions(add)
    add = verb("signal", signals.signal, "a measured signal: spectrum lines, indicators, kurtogram and squared envelope")
    add("file FILE", f"signal as {', '.join(SIGNALS)}; several: cases, the first healthy", nargs="+")
    add("--list", "only list the channels of the files")
    add("--rate HZ", "sampling rate, if the file does not state it", type=float)
    add("--unit U", "unit, if the file does not state it")
    add("--column NAME", "column, if there are several")
    add("--header TEXT", "names of the columns of a table without, 'time [s], a [m/s^2]'")
    add("--scale X", "factor on the values; --unit is then theirs", default=1.0)
    add("--scene SCENE", "scene whose machine, at its speed, names the lines of the last spectrum")
    add("--gear NAME", "gear of --scene: mesh, fault, carrier and shaft frequencies and teeth that are not given")
    add("--mesh HZ", "mesh frequency", type=float)
    add("--fault HZ", "how often the faulty tooth meshes", type=float)
    add("--carrier HZ", "carrier frequency", type=float)
    add("--teeth Z", "of a gear: FM0, FM4, NA4 and others from the mean of its turns", type=int)
    add("--shaft HZ", "turns of that gear in a second", type=float)
    add("--tacho NAME", "column with pulses of its shaft, or its speed in rpm, in place of --shaft")
    add("--pulses N", "pulses per revolution of the tachometer's shaft (default: 1)", default=1)
    add("--tacho-ratio R", "speed of the gear's shaft over the tachometer's (29/95)", default=1, type=_ratio)
    add("--level X", "height at which a pulse counts (default: half the highest)", type=float)
    _analysis_arguments(add)
    add("--cepstrum FILE", "draw the cepstrum of the last case: .png, .svg or .pdf")
    add("--orders FILE", "draw the spectra by turns of the shaft: .png, .svg or .pdf")
    add("--spectrogram FILE", "draw the spectrogram of the last case: .png, .svg or .pdf")
    add = verb("report", tools.report, "one page of a scene, readable without a network: errors, curves, stress, vibration")
    add("scene SCENE", "a built-in scene (see 'gearfe scenes'), a .toml file, or the folder of a sweep")
    add("--case NAME", "case of damage shown beside healthy (default: the scene's first)")
    add("--duration S", "of the machine's vibration [s] (default: 0.2)", default=0.2)
    add("-o --output FILE", "the page: .html", required=True)
    add = verb("sweep", filling.sweep, "compute all cases of a study into a folder; stopped, it goes on where it was")
    add("study STUDY", "a .toml file: a scene, and what varies in it")
    add("-o --output FOLDER", "folder of the results: new, or of this study", required=True)
    add("--workers N", "processes of this machine (default: one per core)", type=int)
    add("--scheduler ADDRESS", "compute on the workers of this Dask scheduler, tcp://host:8786")
    add("--dry-run", "say how many cases, how long, how much memory and disk; write nothing")
    add("--mixed", "go on although another version of gearfe began it")
    add = verb("dataset", filling.dataset, "make labelled vibration windows for learning, split without leakage")
    add("plan DATASET", "a .toml file: machine, faults, operation, sensors, noise, split")
    add("-o --output FOLDER", "folder of the data set: new, or of this one", required=True)
    add("--also", "each side of the split as one file too", nargs="+", choices=("mat", "hdf5"), default=[])
    add("--workers N", "processes of this machine (default: one per core)", type=int)
    add("--dry-run", "say how many windows, how long and how much disk; write nothing")
    add = verb("new", tools.new, "write a scene of your own to start from, with all it can say as comments")
    add("output FILE", "the new file, for instance my.toml")
    add("--teeth Z", "of pinion and wheel (default: 21 31, of a ring 21 63)", nargs=2, type=int)
    add("--module MM", "normal module [mm] (default: 2)", default=2.0)
    add("--helix DEG", "helix angle of the pinion [degrees] (default: 0)", default=0.0)
    add("--width MM", "face width [mm] (default: 20)", default=20.0)
    add("--torque NM", "on the pinion [N m] (default: of 100 N per mm of width)", type=float)
    add(
        "--crack",
        "length [mm] and angle to the centre-line [degrees] of the pinion's root crack (default: level 0.3 at 45 degrees)",
        nargs=2,
        metavar=("MM", "DEG"),
        type=float,
    )
    add(
        "--tip-relief",
        "tip relief of both gears [um], linear over so much roll below the tip [mm]: --tip-relief 20 1.5 (default: none)",
        nargs=2,
        metavar=("UM", "MM"),
        type=float,
    )
    add("--ring", "the wheel is an internal gear")
    add = verb(
        "import", exchange.import_file, "write a scene of a gear unit of another program, with what its file lacks as assumptions"
    )
    add("kind", "format of the file: REXS 1.0 to 2.0.0, as XML, JSON or zip", choices=("rexs",))
    add("file FILE", "the file: .rexs, .rexsj or .zip")
    add("--load-case N", "load case of its load spectrum (default: 1)", default=1)
    add("-o --output FILE", "the new scene (default: its name with .toml, in the present folder)")
    add = verb(
        "export", exchange.export_file, "write a pair or a gear for other programs: FMU, lookup table, REXS, outline, solid"
    )
    _scene_arguments(add, count=False)
    add("--gear", "which gear an outline or a solid has (default: pinion)", choices=("pinion", "wheel"), default="pinion")
    add("--method", "of the stiffness (default: ritz or ritz3d)", default="auto")
    add("--phases N", "phases per mesh cycle (default: 64)", default=64)
    add(
        "-o --output FILE",
        ".fmu: the pair as an FMU 2.0; .mat, .txt: stiffness over the angle of the pinion for Simscape and Modelica; .rexs: all "
        "gears of the scene; .dxf, .svg: outline of a gear; .step: its solid",
        required=True,
    )
    add = verb("check", tools.check, "say in words what a scene holds, and how each case would be solved")
    add("scene SCENE", "a .toml file, or a built-in scene (see 'gearfe scenes')")
    add("--picture FILE", "draw a pair with its damage to scale: .png, .svg or .pdf")
    add("--pair NAME", "which pair is drawn (default: its first)")
    add("--case NAME", "which case of damage is drawn (default: the first of the pair)")
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
    add("--page", "instead a page of all keys of scenes, studies and data sets, as Markdown")
    add = verb("app", tools.app, "a page in the browser: turn a slider, see mesh, stiffness and transmission error at once")
    add("scene SCENE", "opened in it: a built-in scene or a .toml file (default: an example)", nargs="?")
    add("--pair NAME", "pair of the scene (default: its only one)")
    add("--case NAME", "case of damage (default: its only one)")
    add("--port N", "of 127.0.0.1; 0: any that is free (default: 8033)", default=8033)
    add("--no-browser", "only serve the page, do not open it")
    add("--workers N", "solver processes (default: one per core, at least 2)", type=int)
    add("--public NAME", "also answer to this name, of a reverse proxy on this machine: for a course")
    add("--users N", "with --public: addresses at a time (default: 40)", default=40)
    add("--tasks N", "with --public: of an address in a minute (default: 600)", default=600)
    add = verb("completion", tools.completion, "print what completes verbs, options and scenes at the press of a key")
    add("shell", 'eval "$(gearfe completion bash)" in your shell\'s start file', choices=("bash", "zsh"))
    verbs.choices["completion"].set_defaults(verbs=verbs.choices)
    verb("scenes", run.scenes, "list the built-in scenes with their assumptions")
    verb("info", tools.info, "versions, what this machine has, and what would make it faster")
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
    add("--assumptions", "all that the scene assumes, with the reasons")


def _scene_arguments(add, *, count=True):
    add("scene SCENE", "a built-in scene (see 'gearfe scenes') or a .toml file")
    add("--pair NAME", "pair of the scene (default: its first)")
    add("--case NAME", "case of damage (see 'gearfe scenes'; default: healthy)")
    add("--refine X", "finite-element resolution: divides the edge lengths (default: 1)", default=1.0)
    if count:
        _assumptions(add)
        add("--phases N", "phases per mesh cycle (default: 64)", default=64)
