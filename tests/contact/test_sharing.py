import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

from gearfe.contact import sharing
from gearfe.contact.sharing import LineContacts, approaches, line_contact, line_contacts, share, stacked

pytestmark = pytest.mark.quick


def brute_force(flexibility, gap, load):
    """Try every set of touching contacts; the one that satisfies all conditions is the solution."""
    n = gap.size
    for size in range(1, n + 1):
        for touch in itertools.combinations(range(n), size):
            touch = list(touch)
            system = np.block([[flexibility[np.ix_(touch, touch)], -np.ones((size, 1))], [np.ones((1, size)), np.zeros((1, 1))]])
            *force, approach = np.linalg.solve(system, [*-gap[touch], load])
            full = np.zeros(n)
            full[touch] = force
            if (full >= -1e-12 * load).all() and (flexibility @ full + gap >= approach - 1e-12).all():
                return full, approach
    raise AssertionError("no solution")


@pytest.mark.parametrize("seed", range(200))
def test_share_equals_brute_force(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    root = rng.normal(size=(n, n))
    flexibility = root @ root.T + 0.05 * np.eye(n)
    gap = rng.exponential(size=n) * 10 ** rng.uniform(-3, 1)
    load = 10 ** rng.uniform(-2, 2)
    force, approach = share(flexibility, gap, load)
    want, want_approach = brute_force(flexibility, gap, load)
    assert_allclose(force, want, atol=1e-9 * load)
    assert_allclose(approach, want_approach, rtol=1e-9)


@pytest.mark.parametrize("scale", [1e-22, 1.0, 1e22])
@pytest.mark.parametrize("seed", range(12))
def test_where_the_active_set_does_not_settle(monkeypatch, seed, scale):
    """Crack faces between loads: the least energy of all pushes, with the loads' sum given, whatever the unit of length.

    Every set of pushes is tried: those in touch close by the approach, the faces by none, and no other face overlaps.
    """
    monkeypatch.setattr(sharing, "STEPS", 0)
    rng = np.random.default_rng(seed)
    n, load = 5, 10 ** rng.uniform(-2, 2)
    weight = np.array([1.0, 1.0, 1.0, 0.0, 0.0])
    root = rng.normal(size=(n, n))
    flexibility, gap = scale * (root @ root.T + 0.05 * np.eye(n)), scale * rng.exponential(size=n) * weight
    force, approach = share(flexibility, gap, load, weight)
    assert_allclose(weight @ force, load, rtol=1e-10)
    rests = flexibility @ force + gap - approach * weight
    assert (force >= 0).all()
    assert (rests > -1e-9 * scale * load).all()
    assert_allclose(force * rests, 0, atol=1e-9 * scale * load**2)
    assert (force > 0).sum() > 1


@pytest.mark.parametrize("load", [0.0, -1.0, float("nan")])
def test_load_must_push(load):
    with pytest.raises(ValueError, match="give load > 0"):
        share(np.eye(2), np.zeros(2), load)


def test_indefinite_flexibility_is_an_error():
    with pytest.raises(RuntimeError, match="positive definite"):
        share(np.array([[1.0, 2.0], [2.0, 1.0]]), np.zeros(2), 1.0)


@pytest.mark.parametrize("seed", range(40))
def test_line_contact_satisfies_its_equations(seed):
    rng = np.random.default_rng(seed)
    n, load = 3, 10 ** rng.uniform(-2, 3.5)
    smooth = 4e-5 * (np.eye(n) + 0.2) * rng.uniform(0.5, 2)
    gap = np.array([0.0, *rng.exponential(size=2) * 0.01])
    radius, c, modulus = rng.uniform(1, 8, size=n), 5.6e-6, 1.13e5
    tilt = rng.uniform(0, 0.05, size=n) * smooth[0, 0] / load  # what contacts gain by sliding, up to a twentieth
    case = LineContacts(smooth, gap, c, radius, modulus, tilt)
    force, approach, tangent = line_contact(case, load)
    width = np.sqrt(4 * np.maximum(force, 1e-300) * radius / (np.pi * modulus))
    closing = smooth @ force + gap + np.where(force > 0, c * (np.log(2 / width) + 0.5) * force, 0) - tilt * force**2
    assert_allclose(force.sum(), load, rtol=1e-12)
    touch = force > 1e-6 * load
    assert_allclose(closing[touch], approach, rtol=1e-7)
    assert (closing[~touch] >= approach * (1 - 1e-6)).all()
    more = line_contact(case, load * 1.0001)[1]
    assert_allclose(tangent, 0.0001 * load / (more - approach), rtol=5e-3)


@pytest.mark.parametrize("seed", range(20))
def test_many_contacts_at_once_are_those_one_by_one(seed):
    """Rows of hats beside single contacts, of different lengths and under different loads."""
    rng = np.random.default_rng(seed)
    c, modulus, cases = 5.6e-6, 1.13e5, []
    for n in rng.integers(2, 9, size=6).tolist():
        root = rng.normal(size=(n, n)) * 4e-3
        gap, coefficient = rng.exponential(size=n) * 0.01, np.where(np.arange(n) < 1, c, 0.0)
        cases.append((root @ root.T + 2e-5 * np.eye(n), gap - gap.min(), coefficient, rng.uniform(1, 8, size=n)))
    loads = 10 ** rng.uniform(0, 3.5, size=len(cases))
    flexibility, gap, coefficient, radius = (stacked(values) for values in zip(*cases, strict=True))
    there = stacked([np.ones(case[1].size, dtype=bool) for case in cases])
    together = LineContacts(flexibility, gap, coefficient, np.where(there, radius, 1.0), modulus)
    force, approach, tangent, settled = line_contacts(together, loads, there)
    assert settled.sum() >= len(cases) - 1
    found = approaches(flexibility, gap, loads, there)
    for k, (own, distance, softness, curved) in enumerate(cases):
        want = line_contact(LineContacts(own, distance, softness, curved, modulus), loads[k])
        if settled[k]:
            assert_allclose(force[k], np.pad(want[0], (0, gap.shape[1] - want[0].size)), atol=1e-8 * loads[k])
            assert_allclose([approach[k], tangent[k]], want[1:], rtol=1e-8)
        assert_allclose(found[:, k], [share(own, distance, load)[1] for load in loads.tolist()], rtol=1e-9)
