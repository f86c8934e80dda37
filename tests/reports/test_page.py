"""A report is one file that draws all its figures without a network and without a complaint of the browser."""

import math
import re
import shutil
import subprocess
from importlib import resources

import pytest
from matplotlib.colors import to_rgb

import gearfe as gf
from gearfe.core.units import significant
from gearfe.figures.look import COLOURS
from gearfe.reports import page as report_page
from gearfe.reports.findings import Findings, _tooth, find

pytest.importorskip("plotly")
pytest.importorskip("jinja2")
HOSTILE = "</script><script>document.title='broken'</script>"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    scene = gf.new_scene(folder / "own.toml", teeth=(17, 23), width=8.0)
    scene.write_text(scene.read_text().replace('title = "Pair 17/23', f'title = "{HOSTILE}Pair 17/23'))
    return gf.report(scene, folder / "page.html", phases=12)


def test_page_is_one_file_with_all_its_parts(page):
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < 15e6
    own = re.sub(r"<script>/\*\*.*?</script>", "", text, flags=re.DOTALL)  # without plotly itself
    assert not re.findall(r"<(?:script|img|link|iframe)[^>]*(?:src|href)=\"(?!data:)[^\"]*", own), "loads something"
    for part in ("assumed", "errors", "stress", "contact", "tooth", "growth", "made"):
        assert f'<section id="{part}">' in text
    assert HOSTILE not in text
    assert "No picture of" in own or own.count("data:image/png;base64,") == 5
    assert "Tooth lost: the crack reaches the unloaded fillet" in text
    assert "cracked" in text
    assert "gearfe report own.toml --case cracked -o page.html" in text
    assert "N along the line of action, " in text


@pytest.mark.slow
def test_numbers_of_the_page_are_those_of_compare(page):
    text = page.read_text(encoding="utf-8")
    found = gf.compare(gf.load_scene(page.parent / "own.toml"), case="cracked", phases=12)
    for row in found.rows():
        assert math.isnan(row.k) or f"<td>{significant(row.k / 1e6)}</td>" in text
        assert math.isnan(row.error) or f">{100 * row.error:+.1f} %</td>" in text
        assert math.isnan(row.loss) or f"<td>{100 * row.loss:.1f} %</td>" in text


@pytest.mark.slow
def test_first_sentence_is_the_answer(page):
    text = page.read_text(encoding="utf-8")
    healthy, hurt = (gf.compare(page.parent / "own.toml", case=case, phases=12).headline for case in (None, "cracked"))
    found = re.search(r'</h1>\s*<p class="answer">(.*?)</p>', text)[1]
    assert found == f"{healthy[:1].upper()}{healthy[1:]}.<br>{hurt}."


def test_tooth_is_pressed_as_its_scene_says(tmp_path, monkeypatch):
    """Flanks, misalignment and supports go to the tooth in three dimensions, which would look well without them, too."""
    text = gf.new_scene(tmp_path / "own.toml", tip_relief_um=10.0, tip_length_mm=2.0).read_text()
    (tmp_path / "own.toml").write_text(text.replace("#F_beta_x_um", "F_beta_x_um"))
    given = {}

    def pressed_tooth(case, **_):
        given.update(case.as_dict())
        raise ValueError("seen")

    monkeypatch.setattr("gearfe.reports.findings.pressed_tooth", pressed_tooth)
    scene = gf.load_scene(tmp_path / "own.toml")
    assert _tooth(Findings(scene, "cracked")) is None
    chosen = scene.pair()
    assert given["flanks"] == chosen.flanks
    assert set(given["flanks"]) == {"pinion", "wheel"}
    assert given["misalignment"] == chosen.misalignment
    assert given["misalignment"].F_beta_x == 0.01


@pytest.mark.slow
def test_the_turned_tooth_and_the_picture_state_one_root_stress(tmp_path):
    scene = gf.load_scene(gf.new_scene(tmp_path / "own.toml", teeth=(17, 23), width=8.0, helix_deg=15.0))
    _, pressed, field = _tooth(Findings(scene, "cracked"))
    told = gf.render_stress(scene.pair(), tmp_path / "stress.vtu", case="cracked")
    assert (told["root"], told["phase"]) == (field.root, float(pressed.contact.phase[0]))


def luminance(colour):
    rgb = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def test_colours_are_legible_on_light_and_dark_grounds():
    """WCAG 2: 4.5 to 1 for text, 3 to 1 for lines; on paper always the light ones."""
    style = (resources.files("gearfe.reports") / "page.css").read_text(encoding="utf-8")
    light, dark = (dict(re.findall(r"--(\w+): ([#\w]+);", rules)) for rules in re.findall(r":root \{(.*?)\}", style, re.S))
    assert style.count("prefers-color-scheme") == style.count("@media screen and (prefers-color-scheme: dark)") == 1
    assert light.keys() == dark.keys()
    for own in (light, dark):
        for ground in ("paper", "band", "note"):
            for text in ("ink", "soft", "blue", "far"):
                assert contrast(own[text], own[ground]) >= 4.5, (text, ground)
    bright = float(re.search(r"legendlines\) \{ filter: brightness\(([\d.]+)\)", style)[1])
    for colour in COLOURS:
        assert contrast([min(1.0, bright * c) for c in to_rgb(colour)], dark["paper"]) >= 3.0, colour


def test_surface_of_the_tooth_points_outwards():
    import numpy as np

    from gearfe.reports.tooth import surface

    cube = np.array([[0, 1, 0, 1, 0, 1, 0, 1], [0, 0, 1, 1, 0, 0, 1, 1], [0, 0, 0, 0, 1, 1, 1, 1]], dtype=float)
    tets = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]).T
    faces = surface(tets, cube)
    assert faces.shape == (3, 12)
    a, b, c = cube[:, faces].transpose(1, 0, 2)
    volume = (a * np.cross(b, c, axis=0)).sum() / 6  # by the divergence theorem
    np.testing.assert_allclose(volume, 1.0, rtol=1e-12)


def test_the_tooth_is_shown_with_some_of_its_body():
    """Of a column of cubes along the radius those within two modules below the root circle, and no deeper ones."""
    from types import SimpleNamespace

    import numpy as np

    from gearfe.reports.tooth import shown_tooth

    for body in ({"r_bore": 5.0}, {"r_rim": 60.0, "rack_tip_radius": 0.2, "addendum": 0.8}):
        gear = gf.Gear(z=40, m_n=2.0, alpha_n=0.35, b=1.0, **body)
        radius = gear.r_f - gear.outward * np.arange(-4.0, 13.0)  # from the tooth down into the body
        corners = np.array([[0, 1, 0, 1], [0, 0, 0, 0], [0, 0, 1, 1]], dtype=float)
        points = np.hstack([corners + np.array([[0.0], [r], [0.0]]) for r in radius])
        low = 4 * np.arange(radius.size - 1)
        tets = np.array([[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]).T
        cells = (tets[:, :, None] + low).reshape(4, -1)
        moved = np.ones_like(points)
        field = SimpleNamespace(cells=cells, points=points, moved=moved, mises=points[1])
        shown, faces, mises = shown_tooth(SimpleNamespace(sector=SimpleNamespace(gear=gear)), field, 0.25)
        depth = gear.outward * (gear.r_f - (shown[1] - 0.25)) / gear.m_n
        assert depth.min() == -2.0
        assert depth.max() == 2.0
        assert faces.max() == mises.size - 1
        np.testing.assert_allclose(mises, shown[1] - 0.25)


@pytest.mark.quick
def test_unknown_case_and_suffix_are_refused_before_work(tmp_path):
    with pytest.raises(ValueError, match="no case 'worn'"):
        find("planetary_pitting", "worn")
    with pytest.raises(ValueError, match=r"\.html"):
        gf.report("planetary_pitting", tmp_path / "page.docx")


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium")
def test_browser_draws_all_figures_without_errors(page, tmp_path):
    options = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--enable-logging=stderr"]
    options += [f"--user-data-dir={tmp_path}", "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=3000"]
    run = ["chromium", *options, "--window-size=900,900", "--dump-dom", f"file://{page}"]
    done = subprocess.run(run, capture_output=True, text=True, timeout=300, check=True)
    drawn = re.findall(r'id="(figure-\d+)" class="[^"]*js-plotly-plot', done.stdout)
    written = re.findall(r'<div id="(figure-\d+)"', page.read_text(encoding="utf-8"))
    assert len(written) >= 6
    assert sorted(drawn) == sorted(written)
    assert "<title>" in done.stdout
    assert "<title>broken" not in done.stdout
    assert not [line for line in done.stderr.splitlines() if ":CONSOLE" in line and ("Error" in line or "error" in line)]


def test_the_solved_tooth_is_drawn_without_another_solve(monkeypatch):
    drawn = []
    monkeypatch.setattr(
        report_page, "picture_data", lambda draw, title: drawn.append(draw) or {"told": {"phase": 0.5, "top": 300}}
    )
    found = Findings(gf.load_scene("planetary_pitting"), "mild", tooth=("sun_planet", "the solved tooth", None))
    report_page._pictures(found)
    hurt, healthy = drawn
    assert hurt.func is report_page.render_pressed
    assert hurt.args[1] == "the solved tooth"
    assert healthy.func is report_page.render_stress
    assert healthy.keywords["phase"] == 0.5
