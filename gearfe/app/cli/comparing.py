"""Verb ``gearfe compare``: stiffness by every formulation next to the reference."""

from .progress import working
from .verbs import plot_title, print_assumptions


def compare(arguments):
    """Run ``gearfe compare``."""
    from ...comparison.printed_stiffness import printed_cases, printed_text
    from ...scene.load import load_scene
    from ...scene.references import printed_stiffness

    scene = load_scene(arguments.scene)
    result, several = _results(scene, printed_cases(scene), arguments)
    reference = result.methods[0]
    _print_losses(scene, result)
    print(f"\nerrors against {reference}; the estimate is the discretisation error of the reference itself\n")
    table = result.table(digits=5 if several else 4)
    print(table)
    if several and (text := printed_text(scene, result)):
        print(f"\nas printed, and after the stated corrections, compared with `herringbone_article` and {reference}\n\n{text}")
    for text in () if several else printed_stiffness(scene, *result.subject):
        print(text)
    print()
    for why, methods in result.reasons().items():
        print(f"  no {methods}: {why.partition(' (reference=')[0]}")
    print_assumptions(scene, arguments.assumptions)
    if arguments.plot:
        from ...figures.stiffness_plots import plot_curves, told

        plot_curves(result.curves, arguments.plot, plot_title(scene, arguments, told(result.reference)))
        print(f"\nwritten: {arguments.plot}")
    if arguments.output:
        (result.record() if arguments.output.lower().endswith(".csv") else table).save(arguments.output)
        print(f"\nwritten: {arguments.output}")


def _results(scene, printed, arguments):
    """Compute the `Comparison` of the pair, or of the damage cases, that the arguments select."""
    from ...comparison.compare import compare, compare_cases

    one = arguments.pair or arguments.case or arguments.model or arguments.plot
    several = arguments.all_cases or (printed and not one)
    if several and one:
        raise ValueError("--all-cases compares every pair in every case: leave out --pair, --case, --model and --plot")
    if several and arguments.reference not in (None, "fe3d"):
        raise ValueError(
            f"--reference {arguments.reference} with --all-cases: all cases are compared with fe3d only: use --reference fe3d"
        )
    options = {"phases": arguments.phases, "reference": arguments.reference}
    with working("finite elements and energy methods"):
        if several:
            return compare_cases(scene, None if arguments.all_cases else printed, **options), True
        return compare(
            scene, arguments.pair, case=arguments.case, models=arguments.model, refine=arguments.refine, **options
        ), False


def _print_losses(scene, result):
    """Print the headline of a comparison, the definition of its zones, and the loss of stiffness by each damaged tooth."""
    from ...comparison.told_scene import told_supports

    meta, several = result.reference.meta, len(result.asked) > 1
    load = "" if several else f", {meta['force_N']:g} N on {meta['width_mm']:g} mm"
    names = ", ".join(dict.fromkeys(pair for pair, _ in result.asked))
    print(f"{scene.title}\n\n{result.headline}\n")
    print(f"{names}: mesh stiffness along the line of action{load};\n{result.definition}")
    if soft := told_supports(result.reference):
        print(soft)
    for one in result.by_tooth() if result.healthy else ():
        where = "" if one.definition == result.definition else f"; {one.definition}"
        print(f"\nloss of stiffness by the damage{where}\n\n{one.loss_table()}")
