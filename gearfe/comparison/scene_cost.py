"""Expected computing time of the verbs on a scene. Nothing is solved."""

from ..dynamics.machine.of_scene import flat_machine
from ..dynamics.motion.step_control import default_step
from ..planetary_sets.cost import set_seconds
from ..scene.load import Scene
from ..stiffness.cost import contact_seconds, curve_cost
from ..stiffness.methods import SUMS
from ..stiffness.solve import Solve
from .printed_stiffness import printed_cases
from .settled import settling
from .simulated import resolving_duration

# time of the libraries of a verb, of a simulated step, and of a step for each degree of freedom [s], measured as in
# `gearfe.stiffness.cost` on machines of 1 to 39 degrees of freedom
LIBRARIES, STEP, DEGREE = 0.9, 2e-6, 8e-7
MESHER = 0.5  # time to load the mesher and the formulations [s]
INTEGRATOR = 1.1  # time to load the compiled integrator, measured by the first of two equal runs of a single mesh [s]
ROUGH, FINE = 8, 2  # phases of the curves from which the forces at rest are computed; phases of a machine's curve, relative
POSITIONS, CHECKED = 32, 14  # positions of `gearfe planetary`, and those of its error estimate at their coarser resolution


def told_cost(scene: Scene) -> str:
    """Return a sentence with the expected times of the verbs on a scene: the first time, on one processor, without options."""
    in_set = set_seconds(POSITIONS) if scene.set else 0.0  # A set adds to the stiffness of its pairs.
    verbs = {"stiffness": _curve(scene.case()) + in_set, "compare": _compare(scene)}
    if scene.machine:
        verbs["dynamics"] = _dynamics(scene) + in_set
    if scene.set:
        verbs["planetary"] = in_set + set_seconds(CHECKED)
    times = ", ".join(f"{name} {float(f'{LIBRARIES + seconds:.1g}'):g} s" for name, seconds in verbs.items())
    return f"expected time on one processor, the first time, with default options: {times}"


def _curve(case, phases=64, **options):
    """Return the expected time of a curve by the method that suits the case [s]."""
    how = Solve(**options)
    return curve_cost(case, how, how.chosen(case)[0].name, phases).seconds


def _compare(scene):
    """Return the expected time of `compare` or, if the source prints stiffnesses, of `compare_cases` [s]."""
    printed = printed_cases(scene)
    cases = [scene.case(*key) for key in printed] or [scene.case()]
    solid = any(case.why_wide for case in cases)
    reference, *others = ["ritz3d", *SUMS] if solid else ["fe", "ritz", *SUMS]
    times = [curve_cost(case, Solve(), name).seconds for case in cases for name in others]
    times += [curve_cost(case, Solve(error=not printed), reference).seconds for case in cases]
    again = 0.0 if printed else contact_seconds(reference)  # The contact is solved again to be timed.
    return MESHER + sum(times) + again


def _dynamics(scene):
    """Return the expected time of `dynamics`, healthy: curves of all pairs and the motion [s]."""
    machine = flat_machine(scene)
    duration = resolving_duration(machine)
    motion = INTEGRATOR + (settling(machine, duration)[0] + duration) / default_step(machine) * (
        STEP + DEGREE * len(machine.dofs)
    )
    if scene.machine["contact"] == "impact":
        return motion
    return motion + sum(_curve(pair.case(), ROUGH + 64 * FINE) for pair in scene.pairs.values())
