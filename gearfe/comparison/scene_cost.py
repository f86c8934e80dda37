"""Expected computing time and memory of the verbs on a scene. Nothing is solved."""

from ..core.cost import Cost
from ..dynamics.machine.of_scene import flat_machine
from ..dynamics.motion.run_checks import output_memory
from ..dynamics.motion.step_control import default_step
from ..planetary_sets.cost import set_cost
from ..scene.load import Scene
from ..stiffness.cost import contact_seconds, curve_cost
from ..stiffness.limits import section_size
from ..stiffness.methods import SUMS
from ..stiffness.solve import Solve
from .printed_stiffness import printed_cases
from .settled import settling
from .simulated import resolving_duration

# time of the libraries of a verb, of a simulated step, and of a step for each degree of freedom [s], measured as in
# `gearfe.stiffness.cost` on machines of 1 to 39 degrees of freedom
LIBRARIES, STEP, DEGREE = 0.9, 2e-6, 8e-7
# memory of the verbs with their libraries [bytes], measured as the peak of quick scenes; teeth of the section of `section_size`
MEMORY, TEETH = {"stiffness": 0.1e9, "compare": 0.13e9, "dynamics": 0.3e9, "planetary": 0.16e9}, 25
SOLID = 6e7  # memory that a solved case in three dimensions keeps [bytes]
MESHER = 0.5  # time to load the mesher and the formulations [s]
INTEGRATOR = 1.1  # time to load the compiled integrator, measured by the first of two equal runs of a single mesh [s]
ROUGH, FINE = 8, 2  # phases of the curves from which the forces at rest are computed; phases of a machine's curve, relative
POSITIONS, CHECKED = 32, 14  # positions of `gearfe planetary`, and those of its error estimate at their coarser resolution


def told_cost(scene: Scene) -> str:
    """Return a sentence with the expected cost of the verbs on a scene: the first time, on one processor, without options."""
    in_set = set_cost(POSITIONS) if scene.set else Cost(0.0, 0.0)  # A set adds to the stiffness of its pairs.
    verbs = {"stiffness": _both(_curve(scene.case()), in_set), "compare": _compare(scene)}
    if scene.machine:
        verbs["dynamics"] = _both(_dynamics(scene), in_set)
    if scene.set:
        verbs["planetary"] = _both(in_set, set_cost(CHECKED))
    told = (
        f"{name} {_digit(LIBRARIES + cost.seconds):g} s and {_digit((MEMORY[name] + cost.memory) / 1e9):g} GB"
        for name, cost in verbs.items()
    )
    return f"expected time on one processor and memory, the first time, with default options: {', '.join(told)}"


def _digit(value):
    return float(f"{value:.1g}")


def _both(*costs):
    """Return the `Cost` of work one after the other: the sum of the times, and the largest memory."""
    return Cost(sum(cost.seconds for cost in costs), max(cost.memory for cost in costs))


def _curve(case, phases=64, **options):
    """Return the expected `Cost` of a curve by the method that suits the case."""
    how = Solve(**options)
    cost = curve_cost(case, how, name := how.chosen(case)[0].name, phases)
    return cost._replace(memory=cost.memory + SOLID * (name == "ritz3d"))


def _compare(scene):
    """Return the expected `Cost` of `compare` or, if the source prints stiffnesses, of `compare_cases`."""
    printed = printed_cases(scene)
    cases = [scene.case(*key) for key in printed] or [scene.case()]
    solid = any(case.why_wide for case in cases)
    reference, *others = ["ritz3d", *SUMS] if solid else ["fe", "ritz", *SUMS]
    curves = [curve_cost(case, Solve(), name) for case in cases for name in others]
    curves += [curve_cost(case, Solve(error=not printed), reference) for case in cases]
    if solid:
        curves.append(Cost(0.0, SOLID * len(cases)))
    else:
        teeth = max(gear.z for case in cases for gear in case.pair.gears)
        curves.append(Cost(0.0, section_size(1.0)[1] * teeth / TEETH))
    again = 0.0 if printed else contact_seconds(reference)  # The contact is solved again to be timed.
    return _both(Cost(MESHER + again, 0.0), *curves)


def _dynamics(scene):
    """Return the expected `Cost` of `dynamics`, healthy: curves of all pairs and the motion."""
    machine = flat_machine(scene)
    duration, step = resolving_duration(machine), default_step(machine)
    each = STEP + DEGREE * len(machine.dofs)
    seconds = INTEGRATOR + (settling(machine, duration)[0] + duration) / step * each
    motion = Cost(seconds, output_memory(machine, duration / step, True))
    if scene.machine["contact"] == "impact":
        return motion
    return _both(motion, *(_curve(pair.case(), ROUGH + 64 * FINE) for pair in scene.pairs.values()))
