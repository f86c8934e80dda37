"""The ``gearfe`` command and its arguments; what its verbs do is in `gearfe.app.cli.verbs`."""

import argparse
import os
from functools import partial

from ...stiffness.methods import NAMES, described, having
from . import filling, sets, shell, signals, tools
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
    add("--method", default="auto", help=f"{known} (see below; default: ritz or ritz3d)")
    add("--force", type=float, metavar="N", help="force along the line of action [N]; default: the scene's")
    add("--no-extended", action="store_true", help="no tip-corner contact outside the path of contact")
    add(
        "--pose", choices=("mean", "pinion", "wheel"), default="mean",
        help="who turns under load: both gears alike, or one against the held other (default: mean)",
    )  # fmt: skip
    add("--error", action="store_true", help=f"estimate the discretisation error of every k ({having('error')})")
    add(
        "--forces", type=float, nargs="+", metavar="N",
        help="instead of the stiffness, the transmission error over the mesh cycle under these forces [N], of modified flanks "
        "beside plain involutes: table, --plot",
    )  # fmt: skip
    add("--torques", type=float, nargs="+", metavar="NM", help="the same under these torques of the pinion [N m]")
    add("-o", "--output", metavar="FILE", help="save the curve: .csv, .npz, .mat or .json")
    add("--plot", metavar="FILE", help="draw the curve: .png, .svg or .pdf")
    add = verb("compare", run.compare, "table of every formulation's error against finite elements, by zone, with cost")
    _scene_arguments(add)
    add(
        "--model", metavar="FILE", action="append", default=[],
        help="a stiffness model of your own, may be repeated: file.py:function, k [N/m] at an array of mesh phases from 0 to 1; "
        "or two columns, units in the header: first phase (0: a pair enters), angle [deg] or angle [rad] (of the pinion), or "
        "radius [mm] (one tooth pair, on the pinion); then k in N/m, N/mm, N/um (or kN, MN, GN), or per width in N/(mm um) or "
        "N/(m um); or a .csv written by gearfe",
    )  # fmt: skip
    add("--plot", metavar="FILE", help="draw all curves: .png, .svg or .pdf")
    add(
        "--cases",
        action="store_true",
        help="all pairs in all cases of damage (default: those of a scene whose source prints their stiffness)",
    )
    add(
        "--reference", nargs="?", const="fe3d", metavar="METHOD",
        help="what errors are against: fe3d (default of the option), finite elements of whole gears, minutes and gigabytes for "
        "each (fewer with a smaller --refine); or ritz3d",
    )  # fmt: skip
    add = verb("render", run.render, "picture of the stress of the loaded teeth, or of their contact pattern, without a screen")
    _scene_arguments(add, count=False)
    add(
        "--phase", type=float, metavar="X",
        help="mesh phase (default: where the damaged tooth carries most; of healthy gears: stress of spur gears at 0, others and "
        "contact where pair 0 carries most)",
    )  # fmt: skip
    add(
        "--what", choices=["stress", "contact", "pattern"], default="stress",
        help="von Mises stress (in three dimensions for pits and helical gears); contact pressure along the contact lines of one "
        "phase, and load over the face width; or both over a mesh cycle, with the largest pressure and the face load factor "
        "(default: stress)",
    )  # fmt: skip
    add("-o", "--output", metavar="FILE", required=True, help="picture: .png; stress also as .vtu: mesh, displacement, stress")
    add = verb("mesh", run.mesh, "write the mesh of a damaged gear, whole or a few teeth, for other programs")
    _scene_arguments(add, count=False)
    add("--gear", choices=("pinion", "wheel"), default="pinion", help="which gear of the pair (default: pinion)")
    add("--cells", choices=("hexahedra", "tetrahedra"), help="default: tetrahedra with pits or --teeth")
    add("--teeth", type=int, metavar="N", help="odd number of teeth around the damaged one (default: all)")
    add("-o", "--output", metavar="FILE", required=True, help="the mesh: .msh, .vtu or .inp")
    add("--picture", metavar="FILE", help="draw it too: .png")
    add("--close-up", choices=("crack", "pits"), help="with --picture: only what is around the damage")
    add = verb("dynamics", run.dynamics, "response of a scene's machine: spectrum lines and indicators, healthy and damaged")
    add("scene", metavar="SCENE", help="a built-in scene with a machine, or a .toml file")
    add("--case", metavar="NAME", help="case of damage, compared with healthy (default: healthy alone)")
    add(
        "--duration", type=float, default=1.0, metavar="S",
        help="seconds kept, from when free vibrations have fallen to a thousandth (at most 20 s are left out; default: 1)",
    )  # fmt: skip
    add("--channel", metavar="NAME", help="channel to analyse, e.g. 'sun.theta acceleration' (default: first mesh's force)")
    add("--contact", choices=("linear", "impact"), help="contact law (default: the scene's, else linear)")
    add(
        "--loads", type=float, nargs="+", default=(1.0,), metavar="X",
        help="laws of force solved under these multiples of the meshes' own loads, e.g. 0.0625 0.25 0.5 1 2: for resonances and "
        "loads that change (default: 1, a stiffness over the phase)",
    )  # fmt: skip
    add("--method", default="fast", help="fast or a method of scipy's solve_ivp, e.g. DOP853 (default: fast)")
    add("-o", "--output", metavar="FILE", help="save the response: .csv, .npz or .mat")
    _assumptions(add)
    _analysis_arguments(add)
    add = verb("set", sets.planetary_set, "a whole planetary set in one contact: stiffness of its meshes, load shares, pictures")
    add("scene", metavar="SCENE", help="a .toml file with a [set] table")
    add("--case", metavar="NAME", help="case of cracks, compared with healthy (default: healthy alone)")
    add("--positions", type=int, default=32, metavar="N", help="positions of the sun, at least (default: 32)")
    add(
        "--cycles", type=int, metavar="N",
        help="mesh cycles that they are spread over (default: 1; of a ring on pads a pitch of the pads; with --case 2, in which "
        "tooth 0 goes through its mesh)",
    )  # fmt: skip
    add("--refine", type=float, default=1.0, metavar="X", help="finite-element resolution: divides the edge lengths (default: 1)")
    add("-o", "--output", metavar="FILE", help="save loads, stiffness and transmission error: .csv, .npz, .mat or .json")
    add("--plot", metavar="FILE", help="draw them over the positions: .png, .svg or .pdf")
    add("--picture", metavar="FILE", help="draw the set bent under its load, coloured by stress: .png, .svg or .pdf")
    add("--animate", metavar="FILE", help="the same moving, over a mesh cycle or --cycles: .gif")
    _assumptions(add)
    add = verb("signal", signals.signal, "a measured signal: spectrum lines, indicators, kurtogram and squared envelope")
    add("file", metavar="FILE", nargs="+", help=f"signal as {', '.join(SIGNALS)}; several: cases, the first healthy")
    add("--list", action="store_true", help="only list the channels of the files")
    add("--rate", type=float, metavar="HZ", help="sampling rate, if the file does not state it")
    add("--unit", metavar="U", help="unit, if the file does not state it")
    add("--column", metavar="NAME", help="column, if there are several")
    add("--header", metavar="TEXT", help="names of the columns of a table without, 'time [s], a [m/s^2]'")
    add("--scale", type=float, default=1.0, metavar="X", help="factor on the values; --unit is then theirs")
    add("--mesh", type=float, metavar="HZ", help="mesh frequency")
    add("--fault", type=float, metavar="HZ", help="how often the faulty tooth meshes")
    add("--carrier", type=float, metavar="HZ", help="carrier frequency")
    add("--teeth", type=int, metavar="Z", help="of a gear: FM0, FM4, NA4 and others from the mean of its turns")
    add("--shaft", type=float, metavar="HZ", help="turns of that gear in a second")
    add("--tacho", metavar="NAME", help="column with pulses of its shaft, or its speed in rpm, in place of --shaft")
    add("--pulses", type=int, default=1, metavar="N", help="pulses per revolution of the tachometer's shaft (default: 1)")
    add("--tacho-ratio", type=_ratio, default=1, metavar="R", help="speed of the gear's shaft over the tachometer's (29/95)")
    add("--level", type=float, metavar="X", help="height at which a pulse counts (default: half the highest)")
    _analysis_arguments(add)
    add("--cepstrum", metavar="FILE", help="draw the cepstrum of the last case: .png, .svg or .pdf")
    add("--orders", metavar="FILE", help="draw the spectra by turns of the shaft: .png, .svg or .pdf")
    add("--spectrogram", metavar="FILE", help="draw the spectrogram of the last case: .png, .svg or .pdf")
    add = verb("report", tools.report, "one page of a scene, readable without a network: errors, curves, stress, vibration")
    add("scene", metavar="SCENE", help="a built-in scene (see 'gearfe scenes'), a .toml file, or the folder of a sweep")
    add("--case", metavar="NAME", help="case of damage shown beside healthy (default: the scene's first)")
    add("--duration", type=float, default=0.2, metavar="S", help="of the machine's vibration [s] (default: 0.2)")
    add("-o", "--output", metavar="FILE", required=True, help="the page: .html")
    add = verb("sweep", filling.sweep, "compute all cases of a study into a folder; stopped, it goes on where it was")
    add("study", metavar="STUDY", help="a .toml file: a scene, and what varies in it")
    add("-o", "--output", metavar="FOLDER", required=True, help="folder of the results: new, or of this study")
    add("--workers", type=int, metavar="N", help="processes of this machine (default: one per core)")
    add("--scheduler", metavar="ADDRESS", help="compute on the workers of this Dask scheduler, tcp://host:8786")
    add("--dry-run", action="store_true", help="say how many cases, how long, how much memory and disk; write nothing")
    add("--mixed", action="store_true", help="go on although another version of gearfe began it")
    add = verb("dataset", filling.dataset, "make labelled vibration windows for learning, split without leakage")
    add("plan", metavar="DATASET", help="a .toml file: machine, faults, operation, sensors, noise, split")
    add("-o", "--output", metavar="FOLDER", required=True, help="folder of the data set: new, or of this one")
    add("--also", nargs="+", choices=("mat", "hdf5"), default=[], help="each side of the split as one file too")
    add("--workers", type=int, metavar="N", help="processes of this machine (default: one per core)")
    add("--dry-run", action="store_true", help="say how many windows, how long and how much disk; write nothing")
    add = verb("new", tools.new, "write a scene of your own to start from, with all it can say as comments")
    add("output", metavar="FILE", help="the new file, for instance my.toml")
    add("--teeth", type=int, nargs=2, metavar="Z", help="of pinion and wheel (default: 21 31, of a ring 21 63)")
    add("--module", type=float, default=2.0, metavar="MM", help="normal module [mm] (default: 2)")
    add("--helix", type=float, default=0.0, metavar="DEG", help="helix angle of the pinion [degrees] (default: 0)")
    add("--width", type=float, default=20.0, metavar="MM", help="face width [mm] (default: 20)")
    add("--torque", type=float, metavar="NM", help="on the pinion [N m] (default: of 100 N per mm of width)")
    add(
        "--crack", type=float, nargs=2, metavar=("MM", "DEG"),
        help="length [mm] and angle to the centre-line [degrees] of the pinion's root crack (default: level 0.3 at 45 degrees)",
    )  # fmt: skip
    add(
        "--tip-relief", type=float, nargs=2, metavar=("UM", "MM"),
        help="tip relief of both gears [um], linear over so much roll below the tip [mm]: --tip-relief 20 1.5 (default: none)",
    )  # fmt: skip
    add("--ring", action="store_true", help="the wheel is an internal gear")
    add = verb("check", tools.check, "say in words what a scene holds, and how each case would be solved")
    add("scene", metavar="SCENE", help="a .toml file, or a built-in scene (see 'gearfe scenes')")
    add("--picture", metavar="FILE", help="draw a pair with its damage to scale: .png, .svg or .pdf")
    add("--pair", metavar="NAME", help="which pair is drawn (default: its first)")
    add("--case", metavar="NAME", help="which case of damage is drawn (default: the first of the pair)")
    add = verb("schema", tools.schema, "print the JSON schema of scenes, by which an editor completes and checks their keys")
    add("--page", action="store_true", help="instead a page of all keys of scenes, studies and data sets, as Markdown")
    add = verb("app", tools.app, "a page in the browser: turn a slider, see mesh, stiffness and transmission error at once")
    add("scene", metavar="SCENE", nargs="?", help="opened in it: a built-in scene or a .toml file (default: an example)")
    add("--pair", metavar="NAME", help="pair of the scene (default: its only one)")
    add("--case", metavar="NAME", help="case of damage (default: its only one)")
    add("--port", type=int, default=8033, metavar="N", help="of 127.0.0.1; 0: any that is free (default: 8033)")
    add("--no-browser", action="store_true", help="only serve the page, do not open it")
    add("--workers", type=int, metavar="N", help="solver processes (default: one per core, at least 2)")
    add("--public", metavar="NAME", help="also answer to this name, of a reverse proxy on this machine: for a course")
    add("--users", type=int, default=40, metavar="N", help="with --public: addresses at a time (default: 40)")
    add("--tasks", type=int, default=600, metavar="N", help="with --public: of an address in a minute (default: 600)")
    add = verb("completion", tools.completion, "print what completes verbs, options and scenes at the press of a key")
    add("shell", choices=("bash", "zsh"), help='eval "$(gearfe completion bash)" in your shell\'s start file')
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
    return verb.add_argument


def _analysis_arguments(add):
    add("--plot", metavar="FILE", help="draw the spectra: .png, .svg or .pdf")
    add("--kurtogram", metavar="FILE", help="draw the fast kurtogram of the last case: .png, .svg or .pdf")


def _assumptions(add):
    add("--assumptions", action="store_true", help="all that the scene assumes, with the reasons")


def _scene_arguments(add, *, count=True):
    add("scene", metavar="SCENE", help="a built-in scene (see 'gearfe scenes') or a .toml file")
    add("--pair", metavar="NAME", help="pair of the scene (default: its first)")
    add("--case", metavar="NAME", help="case of damage (see 'gearfe scenes'; default: healthy)")
    add("--refine", type=float, default=1.0, metavar="X", help="finite-element resolution: divides the edge lengths (default: 1)")
    if count:
        _assumptions(add)
        add("--phases", type=int, default=64, metavar="N", help="phases per mesh cycle (default: 64)")
