"""Numbers in the prose of the documentation are what gearfe computes, or what the page they come from says."""

import re
from dataclasses import replace
from math import ceil, radians
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from remake import outputs

import gearfe as gf
from gearfe.comparison.harris import harris
from gearfe.comparison.pattern import pattern_of
from gearfe.comparison.root_iso import told_root

ROOT = Path(__file__).parents[2]
SITE = ROOT / "gearfe" / "docs"
NUMBER = r"[-+]?\d+(?:\.\d+)?"
PAGES = ROOT / "validation" / "pages"
STEEL = gf.Material(E=206e3, nu=0.3)


def words_of(path):
    """The text of a page in one line."""
    return " ".join(path.read_text(encoding="utf-8").split())


def says(page, sentence, *values):
    """Check a sentence of a page, ``{}`` for each value: they agree to the last digit that it shows."""
    pattern = re.escape(" ".join(sentence.split())).replace(r"\{\}", rf"({NUMBER})")
    found = re.findall(pattern, words_of(SITE / page))
    assert len(found) == 1, sentence
    shown = found[0] if isinstance(found[0], tuple) else found
    for word, value in zip(shown, values, strict=True):
        digits = len(word.partition(".")[2])
        assert abs(float(word) - value) <= 0.55 * 10.0**-digits, f"{sentence}: {word} is {value:.6g}"


@pytest.fixture(scope="module")
def pair():
    """The pair of the first page."""
    rack = dict(m_n=2.0, alpha_n=radians(20), b=20.0)
    return gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))


def solved(pair, force=2000.0, **options):
    return gf.mesh_stiffness(pair, force, STEEL, **options)


def mean(pair, force=2000.0, **options):
    """Mean of k [N/um]."""
    return solved(pair, force, **options).k.mean() / 1e6


def loss(phases, pair, **crack):
    """What a 2 mm crack takes at these phases [%]: where one pair carries, on average, at the worst phase."""
    healthy, cracked = (solved(pair, phases=phases, damage=d) for d in (None, {"pinion": [gf.Crack(length=2.0, **crack)]}))
    before, after = healthy.zones(), cracked.zones()
    return 100 * np.array([*(1 - after[name] / before[name] for name in ("single", "mean")), (1 - cracked.k / healthy.k).max()])


def middle(pair, count=64):
    """Phases of the mesh cycle in which tooth 0 is in the middle of its engagement."""
    return (ceil((pair.eps_alpha - 1) / 2 * count) + np.arange(count)) / count


@pytest.mark.parametrize(
    "page",
    [
        "index.md",
        pytest.param("howto/design.md", marks=pytest.mark.slow),
        "howto/scene.md",
        "howto/gearbox.md",
        "life_of_a_number.md",
    ],
)
def test_programs_print_what_the_page_shows(page):
    text = (SITE / page).read_text(encoding="utf-8")
    if page == "howto/design.md":  # its programs go on from each other, and from the scene that `gearfe new` writes
        programs = "".join(re.findall(r"```python\n(.*?)```", text, re.S))
        text = f'```python\nimport gearfe\ngearfe.new_scene("my.toml")\n{programs}```'
    (printed,) = outputs(text)
    assert printed
    for line in printed.splitlines():
        parts = re.split(rf"({NUMBER})", " ".join(line.split()))
        says(page, "{}".join(parts[::2]), *map(float, parts[1::2]))


@pytest.mark.slow
def test_start(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    gf.new_scene("my.toml")
    assert gf.compare("my.toml", case="cracked").headline in words_of(SITE / "start.md")


def relieved(pair, amount, length):
    """A pair's tip reliefs on both gears [mm]."""
    gears = (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    return {side: gf.Flank(tip_relief=amount, tip_start_roll=gear.roll_a - length) for side, gear in gears}


def test_design_relief(pair):
    run = {"pair": pair, "material": STEEL}
    error, plain = harris(gf.Case(**run, force=[500.0, 1000.0, 2000.0, 4000.0], flanks=relieved(pair, 0.010, 2.6)), gf.Solve())
    assert str(error.table(plain, pair.gear_1.r_b)) in (SITE / "howto" / "design.md").read_text(encoding="utf-8")
    short = gf.transmission_error(**run, forces=[2000.0], flanks=relieved(pair, 0.010, 1.0))
    says("howto/design.md", "{} um remain at 2000 N with 10 um over 1 mm", 1e6 * short.peak_to_peak[0])
    says("howto/design.md", "the first and the last {} mm of roll", (pair.eps_alpha - 1) * pair.p_bt)
    pinion = pair.gear_1
    diameter = 2 * np.hypot(pinion.roll_a - 2.6, pinion.r_b)
    says("howto/design.md", "from a diameter of {} mm on", diameter)


@pytest.mark.slow
def test_design_pattern_and_root_stress(tmp_path):
    text = (SITE / "howto" / "design.md").read_text(encoding="utf-8")
    scene = gf.new_scene(tmp_path / "my.toml")
    assert "\n".join(told_root(gf.load_scene(scene).case())) in text
    scene.write_text(scene.read_text().replace("#F_beta_x_um", "F_beta_x_um"))
    first, second, *_ = pattern_of(gf.load_scene(scene).case()).told().splitlines()
    assert f"{first}\n{second}\n```" in text


def test_bores_and_textbook_formulas(pair):
    def bored(part):
        return gf.GearPair(*(replace(gear, r_bore=part * gear.r_f) for gear in (pair.gear_1, pair.gear_2)))

    sentence = "Held bores of 0.33, 0.5, 0.7 and 0.85 of the root radius give k of {}, {}, {} and {} N/um"
    says("faq.md", sentence, *(mean(bored(part)) for part in (0.33, 0.5, 0.7, 0.85)))
    says("faq.md", "The mean mesh stiffness $k$ is {} N/um", mean(pair))
    truth, book = solved(pair).zones(), solved(pair, method="textbook").zones()
    above = {zone: 100 * (book[zone] / truth[zone] - 1) for zone in truth}
    says("faq.md", "textbook formulas are {} % above the converged solution", above["double"])
    says("faq.md", "With one pair they are {} % above", above["single"])
    says("faq.md", "Corner contact off the path of contact adds {} %", 100 * (mean(pair) / mean(pair, extended=False) - 1))


def test_crack(pair):
    alone, whole, worst = loss(middle(pair), pair, angle=radians(60))
    says("faq.md", "At 60 degrees it is {} % in single tooth contact", alone)
    says("faq.md", "In the middle of the engagement of the cracked tooth it is {} % of the mean over the mesh cycle", whole)
    says("faq.md", "and {} % at the worst phase", worst)
    first = loss(64, pair, angle=radians(60))[1]
    says("faq.md", "where the cracked tooth is not in the middle of its engagement: {} %", first)
    crack = {"pinion": [gf.Crack(length=2.0, angle=radians(60))]}
    engaged = 100 * (1 - mean(pair, span="tooth", damage=crack) / mean(pair, span="tooth"))
    says("faq.md", "and a part of the next ones: {} %", engaged)
    says("faq.md", "between {} and {} %, because definitions differ", min(engaged, first, whole), worst)
    cracks = [{}, {"angle": radians(30)}, *({"angle": radians(60)} | more for more in ({"start": "root"}, {"side": "unloaded"}))]
    sentence = """the loss by 2 mm at 45 degrees is {} %, and at 30 degrees {} %. It is {} % at 60 degrees from the root circle,
        and {} % on the unloaded side"""
    says("faq.md", sentence, *(loss(middle(pair), pair, **crack)[0] for crack in cracks))


def test_load_and_tangent(pair):
    means = [curve.k.mean() / 1e6 for curve in solved(pair, [500.0, 1000.0, 2000.0, 4000.0, 8000.0])]
    says("faq.md", "8000 N k is {}, {}, {}, {} and {} N/um", *means)
    says("faq.md", "about {} % with each doubling", 100 * ((means[-1] / means[0]) ** 0.25 - 1))
    curve = solved(pair)
    says("faq.md", "the slope of force over deflection, {} % more here", 100 * (curve.k_tangent.mean() / curve.k.mean() - 1))


@pytest.mark.slow
def test_width_and_helix(pair):
    def changed(**options):
        beta = options.pop("beta", 0.0)
        gears = (replace(gear, beta=sign * beta, **options) for gear, sign in ((pair.gear_1, 1), (pair.gear_2, -1)))
        return gf.GearPair(*gears)

    widths = [10.0, 20.0, 40.0]
    narrow = [mean(changed(b=b), 100 * b) / mean(changed(b=b), 100 * b, method="ritz3d") for b in widths]
    sentence = "the section is too stiff by {}, {} and {} % at widths of 5, 10 and 20 modules"
    says("faq.md", sentence, *(100 * (ratio - 1) for ratio in narrow))
    pairs = [changed(beta=radians(beta)) for beta in (5, 15, 30)]
    section, whole = ([solved(one, method=method, phases=32).k for one in pairs] for method in ("ritz", "ritz3d"))
    stiff = [100 * (flat.mean() / full.mean() - 1) for flat, full in zip(section, whole, strict=True)]
    says("faq.md", "it is {} % too stiff on average, at 15 degrees {} %, at 30 degrees {} %", *stiff)
    swings = [100 * np.ptp(k) / k.mean() for k in (section[1], *whole[1:])]
    says(
        "faq.md",
        "Its k changes by {} % over the cycle. The k of the helical gears changes by {} % at 15 and 30 degrees",
        *swings[:2],
    )
    assert_allclose(swings[1], swings[2], atol=0.5)


def test_support(pair):
    held = mean(pair, supports={"pinion": gf.Support(radial=200e3)})
    says("faq.md", "at the pinion alone leave {} of {} N/um", held, mean(pair))


@pytest.mark.slow
def test_law_of_force(pair):
    law = gf.force_law(pair, [100.0 * 2 ** (i / 2) for i in range(13)], STEEL, force=1600.0)
    curve = solved(pair, 1600.0, phases=128)

    def swing(stiffness, frequency):
        machine = gf.single_mesh(0.15, stiffness, frequency, force=1600.0, zeta=0.02, backlash=1e-4)
        response = gf.simulate(machine, 0.03 + 20 / frequency, filtered=False)
        return response["force mesh"][response.time > 0.03].std(), response["force mesh"].min()

    machine = gf.single_mesh(0.15, law, 1500.0, force=1600.0)
    says("faq.md", "(natural frequency {} kHz)", gf.natural_frequencies(machine)[0][0] / 1000)
    (parted, least), (kept, most) = swing(curve, 1500.0), swing(law, 1500.0)
    assert least <= 0 < most
    says("faq.md", "the mesh force under the curve oscillates by {} N RMS", parted)
    says("faq.md", "`gearfe.force_law` gives {} N", kept)
    says(
        "faq.md",
        "At 2500 Hz, a third of the natural frequency, the values are {} and {} N",
        swing(curve, 2500.0)[0],
        swing(law, 2500.0)[0],
    )
    apart = {f: 100 * abs(swing(curve, f)[0] / swing(law, f)[0] - 1) for f in (280.0, 3500.0, 3000.0, 5500.0, 7000.0, 12000.0)}
    values = list(apart.values())
    sentence = "At 280 and 3500 Hz they differ by up to {} %, at 3000, 5500, 7000 and 12 000 Hz by up to {} %"
    says("faq.md", sentence, max(values[:2]), max(values[2:]))


def shares(page, start):
    """Numbers in the row of a page's table that begins so."""
    row = re.search(rf"^\| {re.escape(start)} \|.*$", (PAGES / page).read_text(encoding="utf-8"), re.M)[0]
    return [float(word) for word in re.findall(r"[-+]?\d+(?:\.\d+)?", row)]


def test_what_other_pages_say():
    low, _, high = shares("map.md", "textbook")[8:11]
    says("faq.md", "Over random pairs the mean is between {} and {} % too high in nine cases of ten", low, high)
    low, _, high = shares("map.md", "coupled")[8:11]
    says("faq.md", "`coupled` is the best of them, {} to {} % low in nine cases of ten", -high, -low)
    sets = (PAGES / "sets.md").read_text(encoding="utf-8")
    alone = [float(x) for x in re.search(r"k of (\d+) N/um \(sun and planet\) and (\d+) N/um", sets).groups()]
    rows = re.findall(r"\| (\d?) \| (\d+) \| all around \| (\d+) \| (\d+) \|", sets)
    below = [100 * (1 - float(sun) / alone[0]) for planets, rim, sun, _ in rows if rim == "5" and planets in "35"]
    above = [100 * (float(ring) / alone[1] - 1) for *_, ring in rows]
    says("faq.md", "below that of the isolated pair: {} % with three planets and {} % with five", *below)
    says("faq.md", "k of planet and ring is {} to {} % above that", min(above), max(above))
    says(
        "faq.md",
        "On supports it is {} to {} times that of the isolated pair",
        *map(float, re.search(r"is ([\d.]+) to ([\d.]+) times", sets).groups()),
    )
    ritz, fe = re.search(
        r"in the section in (\d+) of 100 pairs for `ritz` and (\d+) of 100 pairs for `fe`", words_of(PAGES / "sample.md")
    ).groups()
    says("faq.md", "the error on {} of 100 (`fe`) and {} of 100 (`ritz`) random pairs in the section", int(fe), int(ritz))
    rows = (PAGES / "sample.md").read_text(encoding="utf-8")
    medians = [float(x) for x in re.findall(r"^\| (?:error of `\w+`|its estimate) \| ([\d.]+) \|", rows, re.M)]
    times = [re.search(rf"\| `{name}` \| \d+ of 100 \| ([\d.]+) \|", rows)[1] for name in ("fe", "ritz")]
    says("faq.md", "estimate is {} (`fe`) and {} times (`ritz`) the median error", *map(float, times))
    for number, one in enumerate(times):  # the table rounds the medians
        assert abs(medians[2 * number + 1] / medians[2 * number] / float(one) - 1) < 0.15
    found = re.search(r"([\d]+) of ([\d]+) published or independent values agree", words_of(PAGES / "truth.md")).groups()
    says("faq.md", "Values of other codes and standards: {} of {} within a tolerance", *map(int, found))


def test_the_frequent_questions_count_the_articles_results():
    """Results of models, by the rows of the pages."""
    from gearfe.scene import verdicts
    from validation.shared import herringbone_page, table_rows

    shown = []
    for name in ("planetary_pitting", "herringbone_machine"):
        rows = [row for row in table_rows.read(name) if row.kind == "model" and row.verdict != verdicts.FORMULA]
        shown += [sum(row.verdict == word for row in rows) for word in (verdicts.REPRODUCED, verdicts.TREND)]
        shown.insert(-1, len(rows))
    says(
        "faq.md",
        """Of the numbers of models in the articles S0 and S1 {} of {} are reproduced and {} in their trend. Of the vibration
        numbers of S4 {} of {} are reproduced and {} in their trend""",
        *shown,
    )
    solid = [row.verdict for row in herringbone_page.judged()[1] if row.kind == "model"]
    found = (len(solid), solid.count(verdicts.REPRODUCED) + solid.count(verdicts.CORRECTED), solid.count(verdicts.ASSUMED))
    says("faq.md", "Of its {} stiffnesses and reductions {} are reproduced, and {} agree by an assumption of the scene", *found)
