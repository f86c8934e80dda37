"""Pictures say what they show, and their lines can be told apart without colours."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.figures.error_plots import plot_transmission_error
from gearfe.figures.look import COLOURS, DASHES, MARKS, look
from gearfe.figures.vibration_plots import plot_spectra
from validation.shared.plots import plot_lengths, plot_phases

pytestmark = pytest.mark.quick


def test_lines_differ_by_colour_and_by_dashes():
    assert len(set(COLOURS)) == len(set(map(str, DASHES))) == len(set(MARKS)) == 7
    assert look(8) == look(1) != look(0)


def test_names_of_near_lines_do_not_cover_each_other():
    found = gf.spectrum(gf.Signal(np.random.default_rng(1).normal(size=4000), 1000.0, "m"))
    lines = {"a": 200.0, "b": 200.5, "c": 201.0, "d": 260.0, "beyond": 499.0}
    figure = plot_spectra({"healthy": found}, lines, top=300.0, title="scene, channel")
    places = sorted(text.xy[0] for text in figure.axes[0].texts)
    assert len(places) == 4, "a line outside of the picture has no name in it"
    assert np.diff(places).min() > 0.9 * 0.014 * 300
    assert np.mean(places[:3]) == pytest.approx(200.5)
    assert figure.get_suptitle() == "scene, channel"


def test_lengths_are_not_squashed_by_an_axis_from_zero():
    phase = np.linspace(0, 1, 50)
    whole = {"healthy": np.full(50, 40.0), "mild": np.full(50, 38.0)}
    axes = plot_lengths(phase, whole, {"mild": np.full(50, 37.0)}, title="scene, pair", told="by a formula").axes[0]
    assert axes.get_ylim()[0] > 30
    assert len({line.get_linestyle() for line in axes.lines[:2]}) == 2
    assert [text.get_text() for text in axes.get_legend().get_texts()][-1] == "mild, by a formula"


def test_lines_of_every_load_stand_out_from_the_paper():
    """WCAG 2, 1.4.11: a contrast of 3 to 1."""
    from matplotlib.colors import to_rgb

    loads = np.array([500.0, 1000.0, 2000.0, 4000.0, 8000.0])
    phase, te = np.arange(8) / 8, np.outer(loads, np.ones(8)) * 1e-9
    found = gf.TransmissionError(loads, phase, te, np.zeros(8), ())
    figure = plot_transmission_error(found, title="")
    for line in figure.axes[0].lines:
        rgb = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(line.get_color())]
        assert 1.05 / (np.dot(rgb, [0.2126, 0.7152, 0.0722]) + 0.05) >= 3.0, line.get_label()


def test_portraits_say_what_they_show():
    circle = np.cos(np.linspace(0, 6, 40)), np.sin(np.linspace(0, 6, 40))
    figure = plot_phases({name: (circle, np.zeros((1, 2))) for name in "abcd"}, "rad", title="scene, sun")
    assert figure.get_suptitle() == "scene, sun"
    assert [axes.get_visible() for axes in figure.axes] == [True] * 4 + [False] * 2


def test_transmission_errors_say_whose_they_are(pair, steel):
    found = gf.transmission_error(pair, [1000.0], steel, phases=8, method="textbook")
    assert found.plot().axes[0].get_title() == "z = 21 / 31, 20 mm wide"
    assert "µm" in found.plot(title="own").axes[0].get_ylabel()


@pytest.mark.slow
@pytest.mark.parametrize("side", ["pinion", "wheel"])
@pytest.mark.parametrize("name", ["sun_planet", "planet_ring"])
def test_a_drawn_pair_has_its_damage_below_the_flank_that_touches(name, side):
    """Of any tooth: the drawing turns it to the pitch point, and the crack starts in the fillet beside it, on its own gear."""
    pair = gf.load_scene("planetary_pitting").pair(name).pair
    gear, centre = ((pair.gear_1, 0.0), (pair.gear_2, pair.centre_2))[side == "wheel"]
    for tooth in (0, -2):
        figure = gf.plot_pair(pair, {side: [gf.Crack(level=0.2, tooth=tooth)]})
        crack = next(line for line in figure.axes[1].lines if len(line.get_xdata()) == 2 and line.get_zorder() == 4)
        x, y = np.array(crack.get_data())
        assert abs(x).max() < 2 * gear.m_n
        assert abs(y - pair.pitch_radius_1).max() < 3 * gear.m_n
        depth = gear.outward * (np.hypot(x, y - centre) - gear.r_f)
        assert depth[1] < depth[0] < gear.m_n, "from the fillet into the body"
    with pytest.raises(ValueError, match="'pinion' and 'wheel'"):
        gf.plot_pair(pair, {"sun": []})


def test_curves_of_teeth_that_differ_are_not_closed():
    scene = gf.load_scene("compound_planetary")
    hurt = next(iter(scene.pair().damage))
    for case, closed in ((None, True), (hurt, False)):
        found = gf.transmission_error(scene.case(case=case), phases=16)
        drawn = plot_transmission_error(found).axes[0].lines[0].get_xydata()
        assert len(drawn) == 16 + closed
        assert_allclose(drawn[:16, 1], 1e6 * (found.te[0] - found.te[0].mean()), atol=1e-9)
        assert len(found.curves[0].plot().axes[0].lines[0].get_xdata()) >= 16 + closed


def test_notebooks_show_figures_curves_and_scenes():
    scene = gf.load_scene("planetary_pitting")
    curve = gf.solve(scene.case(), gf.Solve("textbook", phases=16))
    assert curve.plot()._repr_png_().startswith(b"\x89PNG")
    assert "<svg" in curve._repr_html_()
    assert "<td>21 / 31</td>" in scene._repr_html_()
    assert len(repr(scene)) < 300
