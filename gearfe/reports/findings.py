"""Results of a report: comparisons of all pairs, the loaded tooth, the vibration of the machine, and computing times."""

import contextlib
import time
from dataclasses import dataclass, field

from ..comparison.compare import compare
from ..comparison.machine_vibration import analysis
from ..comparison.simulated import check_length, check_run, responses
from ..comparison.vibration import Analysis
from ..core.steps import part, steps
from ..core.threads import own_warnings
from ..scene.load import Scene, load_scene
from ..strength.holed import pressed_tooth, tooth_field
from ..strength.render import FINE, STRIP
from .whole_set import find_set

SECONDS = 0.2  # record length of a machine without shafts


@dataclass(slots=True)
class Findings:
    """All results of one scene."""

    scene: Scene
    case: str | None  # damage case that is compared with the healthy case
    comparisons: dict = field(default_factory=dict)  # `gearfe.comparison.comparison.Comparison` by (pair, case or None)
    tooth: tuple | None = None  # (name of the pair, `Pressed`, `Field`): the tooth in three dimensions
    vibration: Analysis | None = None
    responses: dict = field(default_factory=dict)  # `Response` by case
    sets: dict = field(default_factory=dict)  # `SetCurves` of the scene's planetary set by case
    notes: list = field(default_factory=list)  # warnings, and reasons for missing parts
    seconds: dict = field(default_factory=dict)  # wall time by part

    @property
    def headline(self):
        """Answer in one sentence for the pair `hurt_pair`. It contains the pair's name if there are several pairs."""
        return self._sentence(self.case if self.case in self.scene.pairs[self.hurt_pair].damage else None)

    @property
    def healthy_headline(self):
        """Answer in one sentence for the pair without damage."""
        return self._sentence(None)

    def _sentence(self, case):
        name = self.hurt_pair
        sentence = self.comparisons[name, case].headline
        return f"{name}: {sentence}" if len(self.scene.pairs) > 1 else sentence[:1].upper() + sentence[1:]

    @property
    def hurt_pair(self):
        """Name of the first pair that the case damages, otherwise of the first pair."""
        return next((name for name, pair in self.scene.pairs.items() if self.case in pair.damage), next(iter(self.scene.pairs)))


def find(scene, case=None, *, duration=None, phases=64):
    """Compute all `Findings` that a report shows. Arguments are those of `gearfe.report`."""
    if duration is not None and duration != 0:
        check_run(duration)
    scene = load_scene(scene) if not hasattr(scene, "pairs") else scene
    scene.check_case(case)
    if scene.machine and duration:
        check_length(scene, duration)
    if duration is None and scene.train is None:
        duration = SECONDS
    findings = Findings(scene, case or next(iter(scene.cases), None))
    compared = [(name, None) for name in scene.pairs]
    compared += [(name, findings.case) for name, pair in scene.pairs.items() if findings.case in pair.damage]
    moves = bool(scene.machine) and duration != 0
    done = 0.8 if moves else 1.0  # The remaining part of the progress is the vibration.
    with part("", 0.0, 0.7 * done):
        for name, which in steps(compared, lambda key: f"{key[0]}, {key[1] or 'healthy'}"):
            with _counted(findings, f"stiffness of {name}, {which or 'healthy'}"):
                findings.comparisons[name, which] = compare(scene, name, case=which, phases=phases)
    with part("loaded tooth", 0.7 * done, done), _counted(findings, "tooth in three dimensions"):
        findings.tooth = _tooth(findings)
    if scene.set is not None:
        with _counted(findings, "planetary set"):
            findings.sets, notes = find_set(scene, findings.case)
        findings.notes += notes
    if moves:
        with part("vibration", done, 1.0), _counted(findings, "vibration of the machine"):
            motions = responses(scene, findings.case, duration=duration)
            try:
                findings.vibration, findings.responses = analysis(motions), motions
            except ValueError as error:  # The record is too short to resolve its lines. The rest of the page is complete.
                findings.notes.append(f"no vibration is shown: {error}")
    findings.notes = list(dict.fromkeys(findings.notes))
    return findings


@contextlib.contextmanager
def _counted(found, name):
    """Add the seconds of a part and its warnings to the findings."""
    started = time.perf_counter()
    with own_warnings() as caught:
        yield
    found.seconds[name] = time.perf_counter() - started
    found.notes += [f"{name}: {warning.message}" for warning in caught]


def _tooth(found):
    """Return the damaged tooth under load in three dimensions. Damage that cannot be solved gives None and a note."""
    chosen = found.scene.pair(found.hurt_pair)
    case = found.case if found.case in chosen.damage else None
    try:
        pressed = pressed_tooth(chosen.case(case), sizes=FINE, strip=STRIP)  # This mesh equals that of the pictures.
    except ValueError as error:
        found.notes.append(f"no tooth in three dimensions: {error}")
        return None
    return found.hurt_pair, pressed, tooth_field(pressed)
