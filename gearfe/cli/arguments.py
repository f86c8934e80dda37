"""The ``gearfe`` command and its arguments; what its verbs do is in `gearfe.cli.verbs`."""

import argparse
import os

from ..stiffness.methods import NAMES, described, having
from . import labelling, shell, signals, sweeping, tools
from . import verbs as run

SIGNALS = (".csv", ".txt", ".mat", ".npz", ".h5", ".wav", ".uff", ".tdms", ".parquet")  # as of gearfe.files


def main(argv=None):
    """Run the command line; returns the exit code."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy loads: on small matrices more threads wait for each other
    parser = argparse.ArgumentParser(
        prog="gearfe", description="Gear mesh stiffness with its error: finite elements beside energy methods."
    )
    parser.add_argument("--version", action=_Version, help="show the version and leave")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    verb = _verb(verbs, "stiffness", run.stiffness, "compute a stiffness curve; print it by zone, save it, draw it")
    _scene_arguments(verb)
    verb.formatter_class, verb.epilog = argparse.RawDescriptionHelpFormatter, f"methods:\n{described()}"
    methods = ", ".join(name for name in NAMES if name != "auto")
    verb.add_argument("--method", default="auto", help=f"{methods} (see below; default: ritz or ritz3d)")
    verb.add_argument("--force", type=float, metavar="N", help="force along the line of action [N]; default: the scene's")
    verb.add_argument("--no-extended", action="store_true", help="no tip-corner contact outside the path of contact")
    verb.add_argument(
        "--pose", choices=("mean", "pinion", "wheel"), default="mean",
        help="who turns under load: both gears alike, or one against the held other (default: mean)",
    )  # fmt: skip
    verb.add_argument("--error", action="store_true", help=f"estimate the discretisation error of every k ({having('error')})")
    verb.add_argument(
        "--forces", type=float, nargs="+", metavar="N",
        help="instead of the stiffness, the transmission error over the mesh cycle under these forces [N], of modified flanks "
        "beside plain involutes: table, --plot",
    )  # fmt: skip
    verb.add_argument("--torques", type=float, nargs="+", metavar="NM", help="the same under these torques of the pinion [N m]")
    verb.add_argument("-o", "--output", metavar="FILE", help="save the curve: .csv, .npz, .mat or .json")
    verb.add_argument("--plot", metavar="FILE", help="draw the curve: .png, .svg or .pdf")
    verb = _verb(verbs, "compare", run.compare, "table of every formulation's error against finite elements, by zone, with cost")
    _scene_arguments(verb)
    verb.add_argument(
        "--model", metavar="FILE", action="append", default=[],
        help="a stiffness model of your own, may be repeated: file.py:function, k [N/m] at an array of mesh phases from 0 to 1; "
        "or two columns, units in the header: first phase (0: a pair enters), angle [deg] or angle [rad] (of the pinion), or "
        "radius [mm] (one tooth pair, on the pinion); then k in N/m, N/mm, N/um (or kN, MN, GN), or per width in N/(mm um) or "
        "N/(m um); or a .csv written by gearfe",
    )  # fmt: skip
    verb.add_argument("--plot", metavar="FILE", help="draw all curves: .png, .svg or .pdf")
    verb.add_argument(
        "--cases",
        action="store_true",
        help="all pairs in all cases of damage (default: those of a scene whose source prints their stiffness)",
    )
    verb.add_argument(
        "--reference", nargs="?", const="fe3d", metavar="METHOD",
        help="what errors are against: fe3d (default of the option), finite elements of whole gears, minutes for each; or ritz3d",
    )  # fmt: skip
    verb = _verb(
        verbs, "render", run.render, "picture of the stress of the loaded teeth, or of their contact pattern, without a screen"
    )
    _scene_arguments(verb, count=False)
    verb.add_argument(
        "--phase", type=float, metavar="X",
        help="mesh phase (default: where the damaged tooth carries most; of healthy gears: stress of spur gears at 0, others and "
        "contact where pair 0 carries most)",
    )  # fmt: skip
    verb.add_argument(
        "--what", choices=["stress", "contact", "pattern"], default="stress",
        help="von Mises stress (in three dimensions for pits and helical gears); contact pressure along the contact lines of one "
        "phase, and load over the face width; or both over a mesh cycle, with the largest pressure and the face load factor "
        "(default: stress)",
    )  # fmt: skip
    verb.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="picture: .png; stress also as .vtu: mesh, displacement, stress"
    )
    verb = _verb(verbs, "mesh", run.mesh, "write the mesh of a damaged gear, whole or a few teeth, for other programs")
    _scene_arguments(verb, count=False)
    verb.add_argument("--gear", choices=("pinion", "wheel"), default="pinion", help="which gear of the pair (default: pinion)")
    verb.add_argument("--cells", choices=("hexahedra", "tetrahedra"), help="default: tetrahedra with pits or --teeth")
    verb.add_argument("--teeth", type=int, metavar="N", help="odd number of teeth around the damaged one (default: all)")
    verb.add_argument("-o", "--output", metavar="FILE", required=True, help="the mesh: .msh, .vtu or .inp")
    verb.add_argument("--picture", metavar="FILE", help="draw it too: .png")
    verb.add_argument("--close-up", choices=("crack", "pits"), help="with --picture: only what is around the damage")
    verb = _verb(
        verbs, "dynamics", run.dynamics, "response of a scene's machine: spectrum lines and indicators, healthy and damaged"
    )
    verb.add_argument("scene", metavar="SCENE", help="a built-in scene with a machine, or a .toml file")
    verb.add_argument("--case", metavar="NAME", help="case of damage, compared with healthy (default: healthy alone)")
    verb.add_argument(
        "--duration",
        type=float,
        default=1.0,
        metavar="S",
        help="seconds kept, from when free vibrations have fallen to a thousandth (at most 20 s are left out; default: 1)",
    )
    verb.add_argument(
        "--channel", metavar="NAME", help="channel to analyse, e.g. 'sun.theta acceleration' (default: first mesh's force)"
    )
    verb.add_argument("--contact", choices=("linear", "impact"), help="contact law (default: the scene's, else linear)")
    verb.add_argument("--method", default="fast", help="fast or a method of scipy's solve_ivp, e.g. DOP853 (default: fast)")
    verb.add_argument("-o", "--output", metavar="FILE", help="save the response: .csv, .npz or .mat")
    _assumptions(verb)
    _analysis_arguments(verb)
    verb = _verb(verbs, "signal", signals.signal, "a measured signal: spectrum lines, indicators, kurtogram and squared envelope")
    verb.add_argument(
        "file", metavar="FILE", nargs="+", help=f"signal as {', '.join(SIGNALS)}; several: cases, the first healthy"
    )
    verb.add_argument("--list", action="store_true", help="only list the channels of the files")
    verb.add_argument("--rate", type=float, metavar="HZ", help="sampling rate, if the file does not state it")
    verb.add_argument("--unit", metavar="U", help="unit, if the file does not state it")
    verb.add_argument("--column", metavar="NAME", help="column, if there are several")
    verb.add_argument("--header", metavar="TEXT", help="names of the columns of a table without, 'time [s], a [m/s^2]'")
    verb.add_argument("--scale", type=float, default=1.0, metavar="X", help="factor on the values; --unit is then theirs")
    verb.add_argument("--mesh", type=float, metavar="HZ", help="mesh frequency")
    verb.add_argument("--fault", type=float, metavar="HZ", help="how often the faulty tooth meshes")
    verb.add_argument("--carrier", type=float, metavar="HZ", help="carrier frequency")
    verb.add_argument("--teeth", type=int, metavar="Z", help="of a gear: FM0, FM4, NA4 and others from the mean of its turns")
    verb.add_argument("--shaft", type=float, metavar="HZ", help="turns of that gear in a second")
    verb.add_argument("--tacho", metavar="NAME", help="column with pulses of its shaft, or its speed in rpm, in place of --shaft")
    verb.add_argument("--pulses", type=int, default=1, metavar="N", help="pulses of the tachometer in a turn (default: 1)")
    verb.add_argument("--level", type=float, metavar="X", help="height at which a pulse counts (default: half the highest)")
    _analysis_arguments(verb)
    verb.add_argument("--cepstrum", metavar="FILE", help="draw the cepstrum of the last case: .png, .svg or .pdf")
    verb.add_argument("--orders", metavar="FILE", help="draw the spectra by turns of the shaft: .png, .svg or .pdf")
    verb.add_argument("--spectrogram", metavar="FILE", help="draw the spectrogram of the last case: .png, .svg or .pdf")
    verb = _verb(
        verbs, "report", tools.report, "one page of a scene, readable without a network: errors, curves, stress, vibration"
    )
    verb.add_argument(
        "scene", metavar="SCENE", help="a built-in scene (see 'gearfe scenes'), a .toml file, or the folder of a sweep"
    )
    verb.add_argument("--case", metavar="NAME", help="case of damage shown beside healthy (default: the scene's first)")
    verb.add_argument("--duration", type=float, default=0.2, metavar="S", help="of the machine's vibration [s] (default: 0.2)")
    verb.add_argument("-o", "--output", metavar="FILE", required=True, help="the page: .html")
    verb = _verb(verbs, "sweep", sweeping.sweep, "compute all cases of a study into a folder; stopped, it goes on where it was")
    verb.add_argument("study", metavar="STUDY", help="a .toml file: a scene, and what varies in it")
    verb.add_argument("-o", "--output", metavar="FOLDER", required=True, help="folder of the results: new, or of this study")
    verb.add_argument("--workers", type=int, metavar="N", help="processes of this machine (default: one per core)")
    verb.add_argument("--scheduler", metavar="ADDRESS", help="compute on the workers of this Dask scheduler, tcp://host:8786")
    verb.add_argument(
        "--dry-run", action="store_true", help="say how many cases, how long, how much memory and disk; write nothing"
    )
    verb.add_argument("--mixed", action="store_true", help="go on although another version of gearfe began it")
    verb = _verb(verbs, "dataset", labelling.dataset, "make labelled vibration windows for learning, split without leakage")
    verb.add_argument("plan", metavar="DATASET", help="a .toml file: machine, faults, operation, sensors, noise, split")
    verb.add_argument("-o", "--output", metavar="FOLDER", required=True, help="folder of the data set: new, or of this one")
    verb.add_argument("--also", nargs="+", choices=("mat", "hdf5"), default=[], help="each side of the split as one file too")
    verb.add_argument("--workers", type=int, metavar="N", help="processes of this machine (default: one per core)")
    verb.add_argument("--dry-run", action="store_true", help="say how many windows, how long and how much disk; write nothing")
    verb = _verb(verbs, "new", tools.new, "write a scene of your own to start from, with all it can say as comments")
    verb.add_argument("output", metavar="FILE", help="the new file, for instance my.toml")
    verb.add_argument("--teeth", type=int, nargs=2, metavar="Z", help="of pinion and wheel (default: 21 31, of a ring 21 63)")
    verb.add_argument("--module", type=float, default=2.0, metavar="MM", help="normal module [mm] (default: 2)")
    verb.add_argument("--helix", type=float, default=0.0, metavar="DEG", help="helix angle of the pinion [degrees] (default: 0)")
    verb.add_argument("--width", type=float, default=20.0, metavar="MM", help="face width [mm] (default: 20)")
    verb.add_argument("--torque", type=float, metavar="NM", help="on the pinion [N m] (default: of 100 N per mm of width)")
    verb.add_argument(
        "--crack", type=float, nargs=2, metavar=("MM", "DEG"),
        help="length [mm] and angle to the centre-line [degrees] of the pinion's root crack (default: level 0.3 at 45 degrees)",
    )  # fmt: skip
    verb.add_argument(
        "--tip-relief", type=float, nargs=2, metavar=("UM", "MM"),
        help="tip relief of both gears [um], linear over so much roll below the tip [mm]: --tip-relief 20 1.5 (default: none)",
    )  # fmt: skip
    verb.add_argument("--ring", action="store_true", help="the wheel is an internal gear")
    verb = _verb(verbs, "check", tools.check, "say in words what a scene holds, and how each case would be solved")
    verb.add_argument("scene", metavar="SCENE", help="a .toml file, or a built-in scene (see 'gearfe scenes')")
    verb.add_argument("--picture", metavar="FILE", help="draw a pair with its damage to scale: .png, .svg or .pdf")
    verb.add_argument("--pair", metavar="NAME", help="which pair is drawn (default: its first)")
    verb.add_argument("--case", metavar="NAME", help="which case of damage is drawn (default: the first of the pair)")
    verb = _verb(
        verbs, "app", tools.app, "a page in the browser: turn a slider, see mesh, stiffness and transmission error at once"
    )
    verb.add_argument(
        "scene", metavar="SCENE", nargs="?", help="opened in it: a built-in scene or a .toml file (default: an example)"
    )
    verb.add_argument("--pair", metavar="NAME", help="pair of the scene (default: its only one)")
    verb.add_argument("--case", metavar="NAME", help="case of damage (default: its only one)")
    verb.add_argument("--port", type=int, default=8033, metavar="N", help="of 127.0.0.1; 0: any that is free (default: 8033)")
    verb.add_argument("--no-browser", action="store_true", help="only serve the page, do not open it")
    verb.add_argument("--workers", type=int, metavar="N", help="solver processes (default: one per core, at least 2)")
    verb.add_argument(
        "--public", metavar="NAME", help="also answer to this name, of a reverse proxy on this machine: for a course"
    )
    verb.add_argument("--users", type=int, default=40, metavar="N", help="with --public: addresses at a time (default: 40)")
    verb.add_argument(
        "--tasks", type=int, default=600, metavar="N", help="with --public: of an address in a minute (default: 600)"
    )
    verb = _verb(verbs, "completion", tools.completion, "print what completes verbs, options and scenes at the press of a key")
    verb.add_argument("shell", choices=("bash", "zsh"), help='eval "$(gearfe completion bash)" in your shell\'s start file')
    verb.set_defaults(verbs=verbs.choices)
    _verb(verbs, "scenes", run.scenes, "list the built-in scenes with their assumptions")
    _verb(verbs, "info", tools.info, "versions, what this machine has, and what would make it faster")
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


def _verb(verbs, name, function, text):
    verb = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    verb.set_defaults(run=function)
    return verb


def _analysis_arguments(verb):
    verb.add_argument("--plot", metavar="FILE", help="draw the spectra: .png, .svg or .pdf")
    verb.add_argument("--kurtogram", metavar="FILE", help="draw the fast kurtogram of the last case: .png, .svg or .pdf")


def _assumptions(verb):
    verb.add_argument("--assumptions", action="store_true", help="all that the scene assumes, with the reasons")


def _scene_arguments(verb, *, count=True):
    verb.add_argument("scene", metavar="SCENE", help="a built-in scene (see 'gearfe scenes') or a .toml file")
    verb.add_argument("--pair", metavar="NAME", help="pair of the scene (default: its first)")
    verb.add_argument("--case", metavar="NAME", help="case of damage (see 'gearfe scenes'; default: healthy)")
    verb.add_argument(
        "--refine", type=float, default=1.0, metavar="X", help="finite-element resolution: divides the edge lengths (default: 1)"
    )
    if count:
        _assumptions(verb)
        verb.add_argument("--phases", type=int, default=64, metavar="N", help="phases per mesh cycle (default: 64)")
