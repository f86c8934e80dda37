"""Frequency response, modal energy, Campbell diagram: against closed forms, and against each other."""

import math
from dataclasses import replace

import numpy as np
import pytest
from machines import two_masses
from numpy.testing import assert_allclose

import gearfe as gf

PAIR = gf.single_mesh(1.5, 2e8, 600.0, zeta=0.04)


def stage():
    return gf.build_machine(gf.load_scene("planetary_pitting"), phases=8)


@pytest.mark.parametrize(("kind", "power"), [("receptance", 0), ("mobility", 1), ("accelerance", 2)])
def test_one_mass_answers_by_the_closed_form(kind, power):
    f, w0 = np.array([0.0, 300.0, 1837.0, 4000.0]), math.sqrt(2e8 / 1.5)
    w = 2 * math.pi * f
    want = (1j * w) ** power / 1.5 / (w0**2 - w**2 + 2j * 0.04 * w0 * w)
    (name,) = PAIR.dofs
    assert_allclose(gf.frequency_response(PAIR, f, name, name, kind=kind), want, rtol=1e-9, atol=1e-30)


def test_the_answer_is_that_of_a_run_under_a_harmonic_load():
    made = two_masses(stiffness=np.full(8, 1e8), load=0.0)
    f = 700.0
    H = gf.frequency_response(made, [f], "b.x", "a.x")[0]
    shaken = gf.Machine(
        made.dofs,
        made.mass,
        made.springs,
        made.meshes,
        (gf.Load("F", made.row("a.x"), lambda t: 100 * np.cos(2 * np.pi * f * t)),),
    )
    start = [100 * gf.frequency_response(made, [f], name, "a.x")[0] for name in made.dofs]
    start = np.real(start), np.real(2j * np.pi * f * np.array(start))
    run = gf.simulate(shaken, 0.01, initial=start, rate=2e4)
    want = 100 * np.real(H * np.exp(2j * np.pi * f * run.time))
    assert_allclose(run.q[:, 1], want, atol=2e-3 * np.abs(want).max())


def test_it_is_the_sum_over_the_modes_and_the_same_from_either_side():
    made = stage()
    plain = gf.Machine(
        made.dofs,
        made.mass,
        tuple(gf.Spring(s.name, s.row, s.k) for s in made.springs),
        made.with_meshes(zeta=0.0, damping=0.0, damping_per_stiffness=0.0).meshes,
    )
    found = gf.modal_energy(plain)
    f, one, two = np.array([433.3, 1234.5]), made.dofs[0], made.meshes[0].name
    row = made.meshes[0].row
    squared = (2 * math.pi) ** 2 * (found.frequencies[:, None] ** 2 - f**2)
    want = ((found.participation(made.row(one)) * found.participation(row))[:, None] / squared).sum(axis=0)
    assert_allclose(gf.frequency_response(plain, f, one, two).real, want, rtol=1e-6)
    assert_allclose(gf.frequency_response(made, f, one, two), gf.frequency_response(made, f, row, one), rtol=1e-8)


def test_what_has_no_answer_is_refused():
    (name,) = PAIR.dofs
    free = gf.Machine(("a.x",), [1.0], (), ())
    for work, said in (
        (lambda: gf.frequency_response(PAIR, [1.0], name, name, kind="compliance"), "kind = 'compliance'"),
        (lambda: gf.frequency_response(PAIR, [-1.0], name, name), "each from 0 to"),
        (lambda: gf.frequency_response(PAIR, [1.0], "nobody.x", name), "no degree of freedom 'nobody.x'"),
        (lambda: gf.frequency_response(PAIR, [1.0], [1.0, 0.0], name), "one per degree of freedom"),
        (lambda: gf.frequency_response(free, [0.0], "a.x", "a.x"), "is infinite"),
        (lambda: gf.campbell(PAIR, [1.0]), "two or more"),
        (lambda: gf.campbell(PAIR, [100.0, 6000.0]), "not in rpm"),
        (lambda: gf.campbell(PAIR, [0.0, 1.0], harmonics=0), "harmonics = 0"),
        (lambda: gf.campbell(PAIR, [0.0, 1.0], orders={"x": -1.0}), "order x = -1 Hz"),
    ):
        with pytest.raises(ValueError, match=said):
            work()


def test_energies_are_parts_of_one_and_tell_how_frequencies_change():
    made = stage()
    found = gf.modal_energy(made)
    vibrating = found.frequencies > 0
    assert_allclose(sum(found.strain.values())[vibrating], 1.0, rtol=1e-12)
    assert_allclose(sum(found.kinetic.values()), 1.0, rtol=1e-12)
    parts = np.array([found.strain[one.name] for one in made.springs])
    apart = np.diff(found.frequencies, prepend=-1.0, append=1e9)
    alone = vibrating & (np.minimum(apart[:-1], apart[1:]) > 1.0)  # two modes of one frequency are any mixture of both
    which, mode = np.unravel_index(np.argmax(np.where(alone, parts, 0.0)), parts.shape)
    name, share = made.springs[which].name, parts[which, mode]
    assert name in found.largest(mode, 20)
    assert share > 0.1
    springs = tuple(replace(one, k=one.k * (1 + 1e-4 * (one.name == name))) for one in made.springs)
    grown = gf.natural_frequencies(replace(made, springs=springs))[0][mode] / found.frequencies[mode] - 1
    assert_allclose(grown, 1e-4 * share / 2, rtol=1e-3)


def test_two_equal_masses_share_their_energy():
    rows = np.eye(2)
    springs = (gf.Spring("one", rows[0], 1e6), gf.Spring("two", rows[1], 1e6), gf.Spring("between", np.array([1.0, -1.0]), 1e6))
    found = gf.modal_energy(gf.Machine(("a.x", "b.x"), [1.0, 1.0], springs, ()))
    assert_allclose(found.strain["between"], [0.0, 2 / 3], atol=1e-12)
    assert_allclose(found.strain["one"], [0.5, 1 / 6], atol=1e-12)
    assert_allclose(found.kinetic["a.x"], [0.5, 0.5], rtol=1e-12)


def test_orders_cross_where_they_are_the_natural_frequency(tmp_path):
    made = stage()
    found = gf.campbell(made, np.linspace(0.2, 6.0, 7), harmonics=2)
    assert {"mesh", "2 mesh", "driving gear", "damaged tooth", "carrier"} == set(found.orders)
    natural = gf.natural_frequencies(made)[0]
    for speed, frequency, order, mode in found.crossings:
        assert_allclose([frequency, found.orders[order] * speed], natural[mode], rtol=1e-9)
    met = [one for one in found.crossings if one.order == "mesh"]
    assert len(met) == np.sum((natural > 0.2 * 280) & (natural < 6 * 280))
    assert_allclose([one.speed for one in found.crossings], sorted(one.speed for one in found.crossings))
    gf.plot_campbell(found, tmp_path / "campbell.png")
    assert (tmp_path / "campbell.png").stat().st_size > 10000
