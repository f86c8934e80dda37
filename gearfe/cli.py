"""The ``gearfe`` command: one function per verb, no logic of its own."""

import argparse
import contextlib
import os
import sys
import warnings


def main(argv=None):
    """Run the command line; returns the exit code."""
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # before numpy loads: on small matrices more threads wait for each other
    parser = argparse.ArgumentParser(
        prog="gearfe", description="Gear mesh stiffness with its error: finite elements beside energy methods."
    )
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    verb = _verb(verbs, "stiffness", stiffness, "compute a stiffness curve; print it by zone, save it, draw it")
    _scene_arguments(verb)
    verb.add_argument(
        "--method", default="auto", help="ritz, ritz3d, fe, fe3d, coupled, textbook, published (default: ritz or ritz3d)"
    )
    verb.add_argument("--force", type=float, metavar="N", help="force along the line of action [N]; default: the scene's")
    verb.add_argument("--no-extended", action="store_true", help="no tip-corner contact outside the path of contact")
    verb.add_argument("--error", action="store_true", help="estimate the discretisation error of every k (not of closed forms)")
    verb.add_argument("-o", "--output", metavar="FILE", help="save the curve: .csv, .npz, .mat or .json")
    verb.add_argument("--plot", metavar="FILE", help="draw the curve: .png, .svg or .pdf")
    verb = _verb(verbs, "compare", compare, "table of every formulation's error against finite elements, by zone, with cost")
    _scene_arguments(verb)
    verb.add_argument(
        "--model", metavar="FILE", action="append", default=[],
        help="a stiffness curve of your own, may be repeated: two columns, units in the header; first phase (0 to 1; 0: "
        "a pair enters), angle [deg] or angle [rad] (of the pinion), or radius [mm] (one tooth pair, on the pinion); then k in "
        "N/m, N/mm, N/um (or kN, MN, GN), or per width in N/(mm um) or N/(m um); or a .csv written by gearfe",
    )  # fmt: skip
    verb.add_argument("--plot", metavar="FILE", help="draw all curves: .png, .svg or .pdf")
    verb.add_argument(
        "--cases",
        action="store_true",
        help="all pairs in all cases of damage (default: those of a scene whose source prints their stiffness)",
    )
    verb.add_argument("--reference", action="store_true", help="with --cases: compute three-dimensional finite elements anew")
    verb = _verb(
        verbs, "render", render, "picture of the stress of the loaded teeth, or of their contact lines, without a screen"
    )
    _scene_arguments(verb, count=False)
    verb.add_argument(
        "--phase",
        type=float,
        metavar="X",
        help="mesh phase (default: where the damaged tooth carries most; healthy spur gears: 0)",
    )
    verb.add_argument(
        "--what", choices=["stress", "contact"], default="stress",
        help="von Mises stress (in three dimensions for pits and helical gears), or contact pressure along the contact lines and "
        "load over the face width (default: stress)",
    )  # fmt: skip
    verb.add_argument(
        "-o", "--output", metavar="FILE", required=True, help="picture: .png; stress also as .vtu: mesh, displacement, stress"
    )
    verb = _verb(verbs, "dynamics", dynamics, "response of a scene's machine: spectrum lines and indicators, healthy and damaged")
    verb.add_argument("scene", metavar="SCENE", help="a built-in scene with a machine, or a .toml file")
    verb.add_argument("--case", metavar="NAME", help="case of damage, compared with healthy (default: healthy alone)")
    verb.add_argument(
        "--duration", type=float, default=1.0, metavar="S", help="seconds kept, after half as much to settle (default: 1)"
    )
    verb.add_argument(
        "--channel", metavar="NAME", help="channel to analyse, e.g. 'sun.theta acceleration' (default: first mesh's force)"
    )
    verb.add_argument("--contact", choices=("linear", "impact"), help="contact law (default: the scene's, else linear)")
    verb.add_argument("--method", default="fast", help="fast or a method of scipy's solve_ivp, e.g. DOP853 (default: fast)")
    verb.add_argument("-o", "--output", metavar="FILE", help="save the response: .csv, .npz or .mat")
    _analysis_arguments(verb)
    verb = _verb(verbs, "signal", signal, "a measured signal: spectrum lines, indicators, kurtogram and squared envelope")
    verb.add_argument("file", metavar="FILE", nargs="+", help="signal as .csv, .mat or .npz; several: cases, the first healthy")
    verb.add_argument("--rate", type=float, metavar="HZ", help="sampling rate, if the file does not state it")
    verb.add_argument("--unit", metavar="U", help="unit, if the file does not state it")
    verb.add_argument("--column", metavar="NAME", help="column, if there are several")
    verb.add_argument("--mesh", type=float, metavar="HZ", help="mesh frequency")
    verb.add_argument("--fault", type=float, metavar="HZ", help="how often the faulty tooth meshes")
    verb.add_argument("--carrier", type=float, metavar="HZ", help="carrier frequency")
    _analysis_arguments(verb)
    _verb(verbs, "scenes", scenes, "list the built-in scenes with their assumptions")
    _verb(verbs, "info", info, "versions, and what this machine has")
    arguments = parser.parse_args(argv)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("always", UserWarning)
            warnings.showwarning = lambda message, *_: print(f"gearfe: note: {message}", file=sys.stderr)
            arguments.run(arguments)
    except (ValueError, RuntimeError) as error:
        print(f"gearfe: {error}", file=sys.stderr)
        return 1
    return 0


def _verb(verbs, name, run, text):
    verb = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
    verb.set_defaults(run=run)
    return verb


def _analysis_arguments(verb):
    verb.add_argument("--plot", metavar="FILE", help="draw the spectra: .png, .svg or .pdf")
    verb.add_argument("--kurtogram", metavar="FILE", help="draw the fast kurtogram of the last case: .png, .svg or .pdf")


def _scene_arguments(verb, *, count=True):
    verb.add_argument("scene", metavar="SCENE", help="a built-in scene (see 'gearfe scenes') or a .toml file")
    verb.add_argument("--pair", metavar="NAME", help="pair of the scene (default: its first)")
    verb.add_argument("--case", metavar="NAME", help="case of damage (see 'gearfe scenes'; default: healthy)")
    verb.add_argument(
        "--refine", type=float, default=1.0, metavar="X", help="finite-element resolution: divides the edge lengths (default: 1)"
    )
    if count:
        verb.add_argument("--phases", type=int, default=64, metavar="N", help="phases per mesh cycle (default: 64)")


@contextlib.contextmanager
def _working(text):
    """A moving bar with the seconds gone, on a terminal only; gives what prints a line above it."""
    if not sys.stderr.isatty():
        yield lambda line: print(f"gearfe: {line}", file=sys.stderr, flush=True)
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        progress.add_task(text, total=None)
        yield lambda line: progress.console.print(f"gearfe: {line}", markup=False, highlight=False)


def _print_scene(scene):
    print(f"{scene.title}\n")
    for note in scene.assumptions:
        print(f"  assumed: {note['what']}: {note['why']}" + (f" [depends: {note['depends']}]" if note["depends"] else ""))
    for item in scene.later:
        print(f"  not modelled yet: {item}")
    print()


def stiffness(arguments):
    """``gearfe stiffness``."""
    from .scene import load_scene
    from .stiffness import mesh_stiffness

    scene = load_scene(arguments.scene)
    chosen = scene.pair(arguments.pair)
    force = chosen.force if arguments.force is None else arguments.force
    _print_scene(scene)
    with _working(f"stiffness by {arguments.method}") as tell:
        run = chosen.case(arguments.case) | {"force": force, "span": "tooth" if arguments.case else "cycle"}
        if arguments.method in ("ritz", "fe", "coupled"):
            run["face"] = None
        curve = mesh_stiffness(
            **run, method=arguments.method, phases=arguments.phases,
            extended=not arguments.no_extended, refine=arguments.refine, error=arguments.error, tell=tell,
        )  # fmt: skip
    meta = curve.meta
    print(f"{meta['method']} ({meta['why']}), {force:g} N along the line of action, width {meta['width_mm']:g} mm:")
    doubt = curve.zone_errors()
    for zone, value in curve.zones().items():
        print(f"  {zone:7s} {value:.4e} N/m" + (f"  error at most about {100 * doubt[zone]:.2f} %" if zone in doubt else ""))
    if arguments.output:
        curve.save(arguments.output)
        print(f"written: {arguments.output}")
    if arguments.plot:
        curve.plot(arguments.plot)
        print(f"written: {arguments.plot}")


def compare(arguments):
    """``gearfe compare``."""
    from .case_table import printed_cases
    from .comparison import compare as run
    from .references import printed_stiffness
    from .scene import load_scene

    scene = load_scene(arguments.scene)
    _print_scene(scene)
    printed = printed_cases(scene)
    every = arguments.cases or arguments.reference
    if every or (printed and not (arguments.pair or arguments.case or arguments.model or arguments.plot)):
        _compare_cases(scene, arguments, None if arguments.cases or not printed else printed)
        return
    with _working("finite elements and energy methods"):
        options = {"models": arguments.model, "phases": arguments.phases, "refine": arguments.refine}
        result = run(scene, arguments.pair, case=arguments.case, **options)
    meta = result.reference.meta
    load = f"{meta['force_N']:g} N on {meta['width_mm']:g} mm"
    print(f"{result.pair_name}: mesh stiffness along the line of action, {load}, {arguments.phases} phases")
    print(f"errors are against {meta['method']}; the estimate is its own discretisation error\n")
    print(result.table())
    for text in printed_stiffness(scene, result.pair_name, arguments.case):
        print(text)
    if arguments.plot:
        from .plots import plot_curves

        plot_curves(result.curves, arguments.plot)
        print(f"\nwritten: {arguments.plot}")


def _compare_cases(scene, arguments, cases):
    """``gearfe compare --cases``."""
    from .case_table import case_table, printed_text

    if arguments.pair or arguments.case or arguments.model or arguments.plot:
        raise ValueError("--cases is every pair in every case: leave out --pair, --case, --model and --plot")
    with _working("every case by every method"):
        result = case_table(scene, cases, compute=arguments.reference)
    print("mesh stiffness along the line of action over the mesh cycle in which the damaged tooth is in the middle of its")
    print(f"engagement; errors are against {result.reference}\n")
    print(result.table())
    print(f"\nlargest loss of stiffness over that cycle\n\n{result.drop_table()}")
    printed = printed_text(scene, result)
    if printed:
        print(f"\nas printed, and after the stated corrections, beside `published` and {result.reference}\n\n{printed}")


def render(arguments):
    """``gearfe render``."""
    from .render import render_contact, render_stress
    from .scene import load_scene

    scene = load_scene(arguments.scene)
    pair, options = scene.pair(arguments.pair), {"case": arguments.case, "phase": arguments.phase}
    if arguments.what == "contact":
        with _working("contact lines"):
            told = render_contact(pair, arguments.output, **options)
        print(f"phase {told['phase']:.3g}: k {told['k']:.4e} N/m, largest pressure {told['pressure']:.0f} MPa")
    else:
        name = ", ".join(part for part in (scene.name, arguments.pair, arguments.case) if part)
        with _working("stress"):
            told = render_stress(pair, arguments.output, refine=arguments.refine, title=name, **options)
        print(told["text"])
        print(f"largest von Mises stress on the fillets {told['root']:.0f} MPa")
    print(f"written: {arguments.output}")


def dynamics(arguments):
    """``gearfe dynamics``."""
    from dataclasses import replace

    from .machine import natural_frequencies
    from .responses import analysis, responses
    from .scene import load_scene

    scene = load_scene(arguments.scene)
    if arguments.contact:
        scene = replace(scene, machine=scene.machine | {"contact": arguments.contact})
    _print_scene(scene)
    with _working("stiffness curves and response"):
        found = responses(scene, arguments.case, duration=arguments.duration, method=arguments.method)
    made = next(iter(found.values())).machine
    for name, value in made.notes.items():
        print(f"  {name}: {_rounded(value)}")
    print(f"  natural frequencies [Hz]: {_rounded(tuple(natural_frequencies(made)[0][:12]))} ...")
    for case, one in found.items():
        stats = one.stats
        doubt = f", error about {100 * stats['error']:.2g} % of the range" if "error" in stats else ""
        print(f"  {case}: {len(made.dofs)} degrees of freedom, {stats['seconds']:.2f} s by {stats['method']}{doubt}")
        if "switched" in stats:
            print(f"  {case}: reference used because {stats['switched']}")
    _print_analysis(analysis(found, arguments.channel), arguments)
    if arguments.output:
        list(found.values())[-1].save(arguments.output)
        print(f"written: {arguments.output}")


def signal(arguments):
    """``gearfe signal``."""
    from .responses import analyse
    from .signal_file import read_signal

    read = [read_signal(file, column=arguments.column, rate=arguments.rate, unit=arguments.unit) for file in arguments.file]
    signals = {one.name: one for one in read}
    if len(signals) < len(read):
        raise ValueError("two files have the same name: their cases could not be told apart; rename one")
    _print_analysis(analyse(signals, arguments.mesh, arguments.fault, carrier=arguments.carrier, channel=read[0].name), arguments)


def _print_analysis(report, arguments):
    """Tables, envelope and plots of a `gearfe.responses.Analysis`."""
    from .demodulation import demodulate

    if report.lines:
        print(f"\n{report.channel} [{report.unit}], amplitude at the expected lines\n\n{report.lines_text()}")
    print(f"\n{report.indicators_text()}\n")
    last = list(report.signals.values())[-1]
    if report.fault:
        found = demodulate(last, report.fault)
        print(f"{last.name}, {found.text()}")
        kurtogram = found.kurtogram
    elif arguments.kurtogram:
        from .kurtogram import fast_kurtogram

        kurtogram = fast_kurtogram(last)
    if arguments.kurtogram:
        from .vibration_plots import plot_kurtogram

        plot_kurtogram(kurtogram, arguments.kurtogram)
        print(f"written: {arguments.kurtogram}")
    if arguments.plot:
        report.plot(arguments.plot)
        print(f"written: {arguments.plot}")


def _rounded(value):
    if isinstance(value, dict):
        return ", ".join(f"{name} {_rounded(one)}" for name, one in value.items())
    if isinstance(value, tuple):
        return ", ".join(_rounded(one) for one in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def scenes(arguments):
    """``gearfe scenes``."""
    from .scene import load_scene, scene_names

    for name in scene_names():
        scene = load_scene(name)
        cases = {case for pair in scene.pairs.values() for case in pair.damage}
        print(f"{name}: pairs {', '.join(scene.pairs)}" + (f"; cases {', '.join(sorted(cases))}" if cases else ""))
        _print_scene(scene)


def info(arguments):
    """``gearfe info``."""
    import importlib.metadata
    import platform
    import shutil

    from .cache import folder
    from .solver import available

    print(f"Python {platform.python_version()} on {platform.machine()}, {os.cpu_count()} cores")
    for name in ("gearfe", "numpy", "scipy", "scikit-fem", "gmsh", "meshio", "pyvista", "vtk", "matplotlib", "numba"):
        try:
            print(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            print(f"{name} is not installed")
    from geometry.mesher import gmsh_session

    try:
        with gmsh_session():
            print("gmsh starts")
    except RuntimeError as error:
        print(error)
    print(f"solvers: sections SuperLU (scipy); three dimensions, the best first: {', '.join(available())}")
    print(f"CalculiX for decks: {shutil.which('ccx') or 'ccx is not installed'}")
    print(f"cache of solved gears: {folder() or 'switched off'}")
