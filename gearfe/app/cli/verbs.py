"""Verbs of the ``gearfe`` command: one function each, without computation. Slow imports are inside the functions."""

from dataclasses import replace

from ...core.steps import part
from .progress import working


def _print_notes(scene):
    """Print all assumptions of a scene, its changed values, and effects that are not modelled."""
    for note in scene.assumptions:
        print(f"  assumed: {note['what']}: {note['why']}" + (f" [depends: {note['depends']}]" if note["depends"] else ""))
    for text in scene.changed:
        print(f"  changed: {text}")
    for item in scene.later:
        print(f"  not modelled yet: {item}")


def plot_title(scene, arguments, *more):
    """Return the title of a picture: scene, pair, case and further texts."""
    pair = arguments.pair or next(iter(scene.pairs))
    return ", ".join(text for text in (scene.name, pair, arguments.case or "healthy", *more) if text)


def stiffness(arguments):
    """Run ``gearfe stiffness``."""
    from ...comparison.compare import beside_health
    from ...comparison.returns import returns_of
    from ...comparison.told_scene import told_supports
    from ...scene.load import load_scene
    from ...stiffness.methods import fitted
    from ...stiffness.solve import Solve

    if arguments.forces or arguments.torques:
        if arguments.force is not None:
            raise ValueError("--forces and --torques state the loads of a transmission error: leave out --force")
        from ...geometry.renamed import warn_renamed

        warn_renamed("gearfe stiffness --forces", "gearfe te --forces", FutureWarning)
        return transmission_error(arguments)
    scene = load_scene(arguments.scene)
    case = scene.case(arguments.pair, arguments.case)
    if arguments.force is not None:
        case = replace(case, force=arguments.force)
    print(f"{scene.title}\n")
    case, _, left_out = fitted(arguments.method, case)
    for text in left_out:
        print(f"{text}\n")
    with working(f"stiffness by {arguments.method}") as tell:
        how = Solve(
            arguments.method, arguments.phases, extended=not arguments.no_extended, refine=arguments.refine,
            error=arguments.error, tell=tell, pose=arguments.pose, span=_span(arguments, case),
        )  # fmt: skip
        name = arguments.pair or next(iter(scene.pairs))
        with part("", 0.0, 0.8 if scene.set else 1.0):
            found = beside_health(case, how, returns=returns_of(scene, name, arguments.case))
        in_set = _in_set(scene, name, found.reference)
    curve, meta = found.reference, found.reference.meta
    print(f"{meta['method']} ({meta['why']}), {case.force:g} N along the line of action, width {meta['width_mm']:g} mm:\n")
    if in_set:
        print(f"{in_set}\n")
    for one in found.by_tooth() if case.damaged else ():
        print(f"{one.headline};\n{one.definition}\n\n{one.loss_table()}\n")
    print(f"{found.definition}\n\n{found.table(digits=5)}")
    if soft := told_supports(curve):
        print(f"\n{soft}")
    print_assumptions(scene, arguments.assumptions)
    if arguments.output:
        curve.save(arguments.output)
        print(f"written: {arguments.output}")
    if arguments.plot:
        from ...figures.stiffness_plots import plot_curves, told

        drawn = {" ".join(filter(None, (found.kind, meta["method"]))): curve}
        drawn |= {f"healthy {name}": one for name, one in found.healthy.items()}
        plot_curves(drawn, arguments.plot, plot_title(scene, arguments, told(curve)))
        print(f"written: {arguments.plot}")


def _in_set(scene, name, curve):
    """Describe the stiffness of a pair in its planetary set. The result is empty without a set and for closed forms."""
    from ...stiffness.methods import METHODS

    if scene.set is None or not METHODS[curve.meta["method"]].converged:
        return ""
    from ...comparison.told_set import told_in_set  # imported here, because only sets need it and it takes 0.1 s

    with part("stiffness in the whole set", 0.8, 1.0):
        return told_in_set(scene, name, curve)


def transmission_error(arguments):
    """Run ``gearfe te``."""
    from ...comparison.harris import harris, over
    from ...comparison.losses import damaged_teeth, engaged_phases
    from ...comparison.returns import returns_of
    from ...core.table import stacked
    from ...figures.error_plots import plot_transmission_error
    from ...figures.stiffness_plots import told
    from ...scene.load import load_scene
    from ...stiffness.methods import fitted
    from ...stiffness.solve import Solve
    from ...stiffness.transmission_error import errors_under_loads

    scene = load_scene(arguments.scene)
    case, variants, left_out = fitted(arguments.method, scene.case(arguments.pair, arguments.case))
    print("\n\n".join([scene.title, *left_out]), end="\n\n")
    r_b = case.pair.gear_1.r_b
    forces = _forces(arguments, r_b) or [case.forces[0]]
    with working(f"transmission error by {arguments.method}"):
        phases = engaged_phases(case, arguments.phases) if case.damaged else arguments.phases
        options = {"extended": not arguments.no_extended, "refine": arguments.refine, "variants": variants}
        how = Solve(arguments.method, phases, span=_span(arguments, case), **options)
        found, plain = harris(replace(case, force=forces), how)
        healthy = errors_under_loads(replace(case.healthy, force=forces), how) if case.damaged else None
    returns = returns_of(scene, arguments.pair or next(iter(scene.pairs)), arguments.case)
    tables = []
    for teeth in damaged_teeth(case, returns):
        cycle = teeth.phases(case, arguments.phases)
        table = over(found, cycle).table(over(plain, cycle), r_b, over(healthy, cycle))
        tables.append((f"{teeth.words}; phases {cycle[0]:.3g} to {cycle[-1]:.3g}", table))
    over_words = {"cycle": "the mesh cycle", "hunting": "the hunting period"}.get(arguments.span, "a revolution of the pinion")
    for words, table in (tables := tables or [("healthy", found.table(plain, r_b))]):
        print(f"{found.curves[0].meta['method']}: transmission error along the line of action over {over_words}, {words}\n")
        print(table)
    if arguments.output:
        (found.record() if arguments.output.lower().endswith(".csv") else stacked(tables)).save(arguments.output)
        print(f"written: {arguments.output}")
    if arguments.plot:
        title = plot_title(scene, arguments, told(found.curves[0], load=False))
        plot_transmission_error(found, arguments.plot, title, plain)
        print(f"written: {arguments.plot}")
    print_assumptions(scene, arguments.assumptions)


def _span(arguments, case):
    """Return the span of the command line. ValueError for damaged gears, which are solved over the engagement of their teeth."""
    if arguments.span != "cycle" and case.damaged:
        raise ValueError(
            f"--span {arguments.span} is for healthy gears, but --case {arguments.case} has damage, which is solved over the "
            "engagement of the damaged teeth: leave out --span, or call mesh_stiffness with span='revolution' in Python"
        )
    return arguments.span


def _forces(arguments, r_b):
    """Return the forces [N] of the command line. Torques act at the base radius `r_b` [mm]."""
    if arguments.forces and arguments.torques:
        raise ValueError("--forces and --torques both state the loads: give one of them")
    return arguments.forces or [1e3 * torque / r_b for torque in arguments.torques or ()]


def print_assumptions(scene, every, told=None):
    """Print the assumptions `told` of a scene (default: those that affect the stiffness), or `every` note with its reason."""
    from ...scene.assumed import of_stiffness

    print()
    if every:
        _print_notes(scene)
        return
    told = of_stiffness(scene.assumptions) if told is None else told
    for note in told:
        print(f"  assumed: {note['what']}" + (f" [{note['depends']}]" if note["depends"] else ""))
    for text in scene.changed:
        print(f"  changed: {text}")
    rest = len(scene.assumptions) - len(told)
    if rest or any(note["why"] for note in told):
        print(f"  why{f', and {rest} further assumptions without effect on the stiffness' if rest else ''}: --assumptions")


def dynamics(arguments):
    """Run ``gearfe dynamics``."""
    from ...comparison.machine_vibration import analysis, gears_table
    from ...comparison.simulated import responses
    from ...dynamics.machine.modes import natural_frequencies
    from ...scene.load import load_scene

    scene = load_scene(arguments.scene)
    if arguments.contact and scene.machine:
        scene = replace(scene, machine=scene.machine | {"contact": arguments.contact})
    print(f"{scene.title}\n")
    with working("stiffness curves and response") as tell:
        names = ("duration", "method", "loads", "channel")
        options = {"progress": tell} | {name: getattr(arguments, name) for name in names}
        found = responses(scene, arguments.case, **options)
    made = next(iter(found.values())).machine
    for name, value in made.notes.items():
        print(f"  {name}: {_rounded(value)}")
    for fault in list(found.values())[-1].machine.faults:
        print(f"  {fault}")
    print(f"  natural frequencies [Hz]: {_rounded(tuple(natural_frequencies(made)[0][:12]))} ...")
    for case, one in found.items():
        stats = one.stats
        doubt = f", integration error about {100 * stats['error']:.2g} % of the range" if "error" in stats else ""
        if "error_phases" in stats:
            doubt += f", k between its phases within {100 * stats['error_phases']:.2g} % of its spread"
        print(f"  {case}: {len(made.dofs)} degrees of freedom, {stats['seconds']:.2f} s by {stats['method']}{doubt}")
        left = f"free vibrations at {stats['free']:.1g} of their start"
        for line in stats.get("loads", ()):
            print(f"  {case}: {line}")
        print(f"  {case}: recorded after {stats['settled']:.3g} s, {left}")
        if "switched" in stats:
            print(f"  {case}: reference used because {stats['switched']}")
        if "chaotic" in stats:
            print(f"  {case}: {stats['chaotic']}")
    if arguments.output:
        last = list(found.values())[-1]
        last.save(arguments.output, [*last.saved, *{arguments.channel} - {None, *last.saved}])
        print(f"written: {arguments.output}")
    report = analysis(found, arguments.channel)
    print_analysis(report, arguments, scene.name)
    if gears := gears_table(found):
        print(f"gears, from the average over their revolutions (empty: integration errors only)\n\n{gears}\n")
    if report.too_short:
        print(f"longer: --duration {report.resolving:.3g}")
    print_assumptions(scene, arguments.assumptions, scene.assumptions)


def print_analysis(report, arguments, name=""):
    """Print tables, envelope and plots of a `gearfe.comparison.vibration.Analysis`. `name` is the name of its scene."""
    if report.lines:
        print(f"\n{report.channel}, amplitude of the lines\n\n{report.lines_table()}")
        if hidden := report.hidden_lines():
            print(f"\n{hidden}")
    print(f"\n{report.indicators_table()}\n")
    last = list(report.signals.values())[-1]
    if report.fault:
        found, told = report.envelope()
        print(told)
        kurtogram = found.kurtogram
    elif arguments.kurtogram:
        from ...signal.kurtogram import fast_kurtogram

        kurtogram = fast_kurtogram(last)
    if arguments.kurtogram:
        from ...figures.vibration_plots import plot_kurtogram

        plot_kurtogram(kurtogram, arguments.kurtogram, f"{name}, {last.name}, {report.channel}" if name else last.name)
        print(f"written: {arguments.kurtogram}")
    if arguments.plot:
        report.plot(arguments.plot, ", ".join(filter(None, (name, report.channel))))
        print(f"written: {arguments.plot}")


def _rounded(value):
    if isinstance(value, dict):
        return ", ".join(f"{name} {_rounded(one)}" for name, one in value.items())
    if isinstance(value, tuple):
        return ", ".join(_rounded(one) for one in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def scenes(arguments):
    """Run ``gearfe scenes``."""
    from ...scene.load import load_scene, scene_names

    for name in scene_names():
        scene = load_scene(name)
        print(f"{name}: pairs {', '.join(scene.pairs)}" + (f"; cases {', '.join(sorted(scene.cases))}" if scene.cases else ""))
        print(scene.title)
        if arguments.assumptions:
            print()
            _print_notes(scene)
        print()
