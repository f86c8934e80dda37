"""Page `joint`: statements of the articles if all dynamic inputs that they do not print are drawn together."""

import importlib
from itertools import groupby

import numpy as np
from scipy.stats import hypergeom

import gearfe as gf
from gearfe.core.table import Column, Table
from gearfe.scene import verdicts

from ..shared import joint_inputs, page
from ..shared.kept_rows import kept, stored
from ..shared.places import TABLES
from ..shared.table_rows import read, write_table

NAME = "joint"
DECIDES = joint_inputs.DRAWS // 4  # An input is decisive if its lower and upper halves differ by at least this number of draws.
HOW = f"""
The {joint_inputs.DRAWS} draws of a page are a Latin hypercube, uniform in the logarithm of each input. Ranges, statements and
thresholds were fixed in a commit before the first run (`validation/shared/joint_inputs.py`). A number without a unit is a factor
of the value that the scene or its machine assumes. Masses and stiffness curves are constant. Channel and path are combined with
every draw. A statement is evaluated as on its page. [tables/joint.csv](tables/joint.csv) counts the draws in which it holds for
each channel.

On the pages, 'gearfe' is yes if the statement holds with the assumed inputs. [tables/joint_inputs.csv](tables/joint_inputs.csv)
names the input with the strongest relation to each statement. Two numbers are the draws in which the statement holds, of
{joint_inputs.DRAWS // 2} above and of {joint_inputs.DRAWS // 2} below the median of the input. The probability of such a
difference by chance is in parentheses. 'none': no input differs by {DECIDES} draws. If all draws agree, the cell is empty. The
number of draws is too small to identify the decisive input.
"""

METHOD = "`python -m validation joint` writes this page and sections of four pages from `tables/joint.jsonl`."
COUNTED = "Statements that an assumption of the scene sets are not counted. Inputs and their ranges:"
SPANS = [
    "Each row combines the cases of a quantity. The last column counts the draws within the tolerance, for the case with most of "
    "them. [tables/joint_numbers.csv](tables/joint_numbers.csv) has every case."
]


def home(name):
    """Return the module of the page of a machine."""
    return importlib.import_module(f"validation.make.{name}")


def rows_of(name):
    """Return the stored rows of a page, in order."""
    found = stored(NAME)
    return [found[key] for key in sorted(found) if key.startswith(f"{name} ")]


def compute(name, again=False):
    """Return the rows of a page. With `again`, stored rows are computed again."""
    for draw in joint_inputs.draws(name):
        key = f"{name} {draw.number:02d}"
        kept(NAME, key, lambda draw=draw: {"inputs": dict(draw.values)} | home(name).drawn(draw), again)


def said(name):
    """Return, for each statement and channel, an array of bool: in which draws the statement holds."""
    rows, out = rows_of(name), {}
    for statement, channels in rows[0]["holds"].items() if rows else ():
        out[statement] = {one: np.array([row["holds"][statement][one] for row in rows]) for one in channels}
    return out


def decides(name, held):
    """Return in words the input whose upper and lower halves of draws differ most in a statement, with counts and probability."""
    if held.all() or not held.any():
        return ""
    best, names = 0, []
    for word in joint_inputs.RANGES[name]:
        upper = np.argsort([row["inputs"][word] for row in rows_of(name)])[held.size // 2 :]
        above, below = int(held[upper].sum()), int(held.sum() - held[upper].sum())
        told = f"{joint_inputs.MEANT[word].partition(',')[0]}: {above}, {below}"
        names = [told] if abs(above - below) > best else [*names, told] if abs(above - below) == best else names
        best = max(best, abs(above - below))
    return f"{'; '.join(names)} ({by_chance(best, held, len(joint_inputs.RANGES[name])):.2g})" if best >= DECIDES else "none"


def by_chance(apart, held, inputs):
    """Return the probability of a difference of at least `apart` between halves of the draws, if no input has an effect.

    It is the probability for any one of the number `inputs` of inputs.
    """
    above, yes = np.arange(held.size // 2 + 1), int(held.sum())
    chance = hypergeom.pmf(above, held.size, yes, held.size // 2)[abs(2 * above - yes) >= apart].sum()
    return float(1 - (1 - chance) ** inputs)


def judged(name):
    """Return in how many draws each statement holds, on the channel on which the page judges."""
    chosen = getattr(home(name), "JUDGED_ON", {})
    return {word: channels[chosen.get(word, next(iter(channels)))] for word, channels in said(name).items()}


def counts(name):
    """Count the statements that hold in all, in none and in some of the draws, on the channel that the page judges."""
    ours = {row.case for row in read(name) if row.verdict == verdicts.ASSUMED}
    share = [held.mean() for word, held in judged(name).items() if word not in ours]
    return sum(x == 1 for x in share), sum(x == 0 for x in share), sum(0 < x < 1 for x in share)


def sentence(name):
    """Return a sentence with the numbers of statements that hold in all, in none and in some draws."""
    every, none, some = counts(name)
    return (
        f"{every} of {every + none + some} statements {'holds' if every == 1 else 'hold'} in all {joint_inputs.DRAWS} draws, "
        f"{none} in none, and {some} in some"
    )


def section(name, judged_rows):
    """Return the lines for the page of a machine with the verdicts on its statements. The result is empty without rows."""
    if not rows_of(name):
        return []
    own, verdict = judged(name), {row.case: row for row in judged_rows if row.kind == verdicts.STATEMENT}
    rows = []
    for statement, held in own.items():
        row = verdict.get(statement)
        cells = ["yes" if row.ours else "no", verdicts.marked(row.verdict)] if row else ["", ""]
        rows.append([statement, *cells, f"{held.sum()}"])
    return [
        "## Within which unprinted inputs statements hold",
        "",
        f"The column 'draws' counts in how many of {joint_inputs.DRAWS} random sets of inputs the statement holds. Of the "
        f"channels in [tables/joint.csv](tables/joint.csv), the verdict uses {judges(name)}. [joint.md](joint.md) lists the "
        "ranges of the inputs.",
        "",
        *Table(("statement", "gearfe", "verdict", "draws"), rows).markdown().splitlines(),
        "",
    ]


def by_channel(name):
    """Return rows of `tables/joint.csv` for a page: in how many draws each statement holds, by channel."""
    return [(name, statement, channel, held.sum()) for statement, one in said(name).items() for channel, held in one.items()]


def judges(name):
    """Describe the channel on which a page judges its statements."""
    chosen = getattr(home(name), "JUDGED_ON", {})
    words = {channel: [f"'{word}'" for word, one in chosen.items() if one == channel] for channel in chosen.values()}
    return "the first one" + "".join(f". For {', '.join(own)} it uses {channel}" for channel, own in words.items())


def numbers(name):
    """Return rows of `tables/joint_numbers.csv`: printed numbers, and their ranges in all draws."""
    named, judged = getattr(home(name), "PRINTED", {}), read(name)
    rows, scene = rows_of(name), {one.id: one for one in gf.load_scene(SCENES.get(name, name)).references}
    lines = []
    for word, reference in named.items():
        meant = scene[reference].quantity.replace("its centre", "centre of the band of largest spectral kurtosis")
        quantity = ", ".join(filter(None, (meant, word.partition(", ")[2])))
        for i, row in enumerate(one for one in judged if one.id == reference):
            values = [draw["numbers"][word][i] for draw in rows]
            inside = sum(scene[reference].within(value, row.printed) for value in values)
            lines.append((name, quantity, row.case, row.printed, row.ours, min(values), max(values), inside))
    return lines


def number_table(lines):
    """Return the printed numbers of all pages as Markdown, one row per quantity with the ranges of its cases."""
    out, above = [], ""
    for (page_name, quantity), group in groupby(lines, lambda line: line[:2]):
        _, _, _, printed, ours, least, largest, inside = zip(*group, strict=True)
        ends = [(min(one), max(two)) for one, two in ((printed, printed), (ours, ours), (least, largest))]
        spans = [" to ".join(dict.fromkeys(f"{x:.4g}" for x in end)) for end in ends]
        out.append(["" if page_name == above else page_name, quantity, *spans, f"{max(inside)}"])
        above = page_name
    head = ("page", "number", "printed", "on the page of the machine", "least to largest of the draws", "draws within, best case")
    return Table(head, out).markdown().splitlines()


SCENES = {"herringbone_machine": "herringbone"}


def answer():
    """Return the first sentence of the page."""
    every, none, some = np.sum([counts(name) for name in joint_inputs.RANGES], axis=0)
    return (
        f"Simulations decide {every + none + some} statements of the articles, each on the channel of its page. {every} "
        "hold in all "
        f"joint draws of load, supports, damping, noise and other unprinted inputs, and {none} in none. The other {some} depend "
        "on inputs that the articles omit, so that neither verdict on them is evidence."
    )


def ranges():
    """Return lines with the inputs and their ranges, by page."""
    names = list(joint_inputs.RANGES)
    rows = []
    for word, meant in joint_inputs.MEANT.items():
        ends = [joint_inputs.RANGES[name].get(word) for name in names]
        rows.append([meant, *("" if end is None else f"{end[0]:g} to {end[1]:g}" for end in ends)])
    return Table(("input", *names), rows).markdown().splitlines()


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    for name in joint_inputs.RANGES:
        compute(name, again)
    tell()


def tell():
    """Write this page and the pages of the machines."""
    head = ("page", *(Column(name, form="{}") for name in ("statements", "hold in all draws", "in none", "in some")))
    rows = [[f"[{name}.md]({name}.md)", sum(counts(name)), *counts(name)] for name in joint_inputs.RANGES]
    found = [line for name in joint_inputs.RANGES for line in numbers(name)]
    spans = ["## Printed numbers", "", *SPANS, "", *number_table(found)]
    page.write(
        NAME, answer(), HOW.strip().splitlines(), Table(head, rows).markdown().splitlines(), [COUNTED], ranges(), spans, METHOD
    )
    head = ("page", "number", "case", "printed", "on the page", "least", "largest", "draws within the tolerance")
    write_table(TABLES / f"{NAME}_numbers.csv", head, found)
    inputs = [(name, word, decides(name, held)) for name in joint_inputs.RANGES for word, held in judged(name).items()]
    write_table(TABLES / f"{NAME}_inputs.csv", ("page", "statement", "input"), inputs)
    channels = [row for name in joint_inputs.RANGES for row in by_channel(name)]
    write_table(TABLES / f"{NAME}.csv", ("page", "statement", "channel", "draws"), channels)
    for name in joint_inputs.RANGES:
        home("machines").write_page(name)  # That page includes a section made by this module.


def cheap():
    """Yield the rows that `validation.check` computes again: draws of the cheapest page."""
    name = "helical_pitting"
    for draw, row in zip(joint_inputs.draws(name), rows_of(name), strict=True):
        yield row["row"], row["holds"], lambda draw=draw: home(name).drawn(draw)["holds"]
