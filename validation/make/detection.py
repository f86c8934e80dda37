"""The page `detection`: cracks among the scatter of manufacture and of machines."""

from ..shared import page
from ..shared.kept_rows import stored
from . import dataset, diagnosis, tolerances

HOW = """
`python -m validation detection` computes this page and `tables/detection.jsonl` (the
classifier needs scikit-learn). All machines are simulated, and their scatter is assumed.
"""


def answer():
    """The first line."""
    state = stored("detection")["tolerances"]["states"]["10 % crack"]
    return (
        f"A crack of 10 % of the tooth's thickness lowers the mean stiffness by {100 * state['loss']:.1f} % where manufacture "
        f"scatters it by {100 * state['spread']:.1f} %: the mean tells it no better than {100 * (1 - state['k_mean']):.0f} %, "
        f"the least stiffness of the engagement {100 * (1 - state['k_min']):.0f} %, and two measurements of one machine, each "
        f"0.3 % off, {100 * state['own 0.003']:.1f} %. The verdict on vibration calls {_false()} healthy machines faulty."
    )


def _false():
    worst = stored("detection")["diagnosis"]["false"]
    return f"{100 * worst:.1f} % of {diagnosis.HEALTHY}" if worst else f"none of {diagnosis.HEALTHY}"


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    sections = tolerances.section(again), dataset.section(again), diagnosis.section(again)
    page.write("detection", answer(), HOW.strip().splitlines(), *sections)
