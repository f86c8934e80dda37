"""The force law of a mesh: closed forms, contact solved anew at other loads and phases, and what is no law."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import PAIR

import gearfe as gf
from gearfe.dynamics.machine.compound_planetary import SCENE_PAIRS

STEEL = gf.Material(E=207e3, nu=0.25)
LOADS = [50.0 * 2**i for i in range(7)]


def curve(load, depth, tangent, pairs=1, phases=8):
    """StiffnessCurve of a force that is the same at all phases."""
    phase = np.arange(phases) / phases
    every = np.full(phases, 1.0)
    forces = np.repeat([[load / pairs] * pairs + [0.0] * (2 - pairs)], phases, axis=0)
    return gf.StiffnessCurve(
        phase, load / depth * every, tangent * every, depth * every, np.arange(2), forces, 0 * forces, meta={"force_N": load}
    )


def test_between_its_loads_it_is_a_power_law_made_of_its_values_and_tangents():
    K = 1e13
    depths = (np.array([100.0, 200.0, 400.0, 800.0]) / K) ** (2 / 3)
    law = gf.ForceLaw.of([curve(K * d**1.5, d, 1.5 * K * d**0.5) for d in depths])
    at = np.linspace(1.05 * depths[0], depths[-1], 50)  # up to the smallest load the secant stiffness is constant
    assert_allclose(law(at, 0.3), K * at**1.5, rtol=5e-4)


@pytest.mark.parametrize("gap", [2.2e-6, 3e-6, 5e-6])
def test_it_knows_where_a_second_spring_comes_in_between_two_loads(gap):
    one, two, forces = 2e8, 1.5e8, np.array([200.0, 400.0, 1600.0, 3200.0])
    bend = one * gap
    depths = np.where(forces < bend, forces / one, (forces + two * gap) / (one + two))
    tangents = np.where(forces < bend, one, one + two)
    given = zip(forces, depths, tangents, strict=True)
    law = gf.ForceLaw.of([curve(f, d, t, pairs=1 if f < bend else 2) for f, d, t in given])
    at = np.linspace(0.1e-6, depths[-1], 200)
    want = one * at + two * np.maximum(at - gap, 0.0)
    column = np.diff(law.secant.depths).max()
    assert_allclose(law(at, 0.5), want, atol=two * column / 4, err_msg="a kink is cut off within a column of the table")
    plain = gf.ForceLaw.of([curve(f, d, t) for f, d, t in zip(forces, depths, tangents, strict=True)])
    assert np.abs(plain(at, 0.5) - want).max() > 2 * np.abs(law(at, 0.5) - want).max(), "the kink is worth knowing"


def test_below_its_loads_it_has_their_secant_and_above_them_their_tangent():
    law = gf.ForceLaw.of([curve(100.0, 1e-6, 1.2e8), curve(400.0, 3e-6, 2e8)])
    assert_allclose(law(0.3e-6, 0.0), 30.0, rtol=1e-9)
    assert_allclose(law(5e-6, 0.0), 400 + 2e8 * 2e-6, rtol=0.02)
    assert law(-1e-6, 0.0) == 0


def test_a_law_is_the_contact_solved_anew_at_other_loads_and_phases():
    law, phase = gf.force_law(PAIR, LOADS, STEEL), np.random.default_rng(1).random(40)
    for want in gf.mesh_stiffness(PAIR, [70.0, 300.0, 1111.0, 2500.0], STEEL, phases=np.sort(phase)):
        got = law(want.deflection, want.phase)
        load = want.meta["force_N"]
        assert np.sqrt(np.mean((got / load - 1) ** 2)) < 2e-3
        assert_allclose(got, load, rtol=0.02)


def test_its_secant_under_its_force_is_that_curve():
    law = gf.force_law(PAIR, LOADS, STEEL, force=1000.0)
    phase, k = law.at(1000.0)
    want = gf.mesh_stiffness(PAIR, 1000.0, STEEL, phases=phase[::16]).k
    assert_allclose(k[::16], want, rtol=5e-3)


def test_natural_frequencies_are_those_of_the_tangent():
    law = gf.force_law(PAIR, LOADS, STEEL)
    machine = gf.single_mesh(0.15, law, 100.0, force=1600.0)
    got = gf.natural_frequencies(machine)[0][0]
    tangent = gf.mesh_stiffness(PAIR, 1600.0, STEEL, phases=128).k_tangent.mean()
    assert_allclose(got, math.sqrt(tangent / 0.15) / (2 * math.pi), rtol=5e-3)
    x = machine.rest()[0]
    assert_allclose(np.mean(law(x, np.arange(512) / 512)), 1600.0, rtol=1e-4)


def test_what_is_no_law_is_refused():
    one, two = curve(100.0, 1e-6, 1e8), curve(200.0, 2e-6, 1e8)
    with pytest.raises(ValueError, match="two or more"):
        gf.ForceLaw.of([one])
    with pytest.raises(ValueError, match="two or more, all different"):
        gf.ForceLaw.of([one, one])
    with pytest.raises(ValueError, match="is not larger than under the smaller load"):
        gf.ForceLaw.of([curve(200.0, 1e-6, 1e8), curve(100.0, 2e-6, 1e8)])
    with pytest.raises(ValueError, match="same phases"):
        gf.ForceLaw.of([one, curve(200.0, 2e-6, 1e8, phases=9)])
    with pytest.raises(ValueError, match="list of StiffnessCurve"):
        gf.ForceLaw.of([3.0, 4.0])
    with pytest.raises(ValueError, match="span = 'revolution'"):
        gf.force_law(PAIR, LOADS, STEEL, span="revolution")
    law = gf.ForceLaw.of([one, two])
    with pytest.raises(ValueError, match="for the healthy mesh and for all its damage"):
        gf.single_mesh(1.0, law, 100.0, teeth=(21, 31), damage=(gf.ToothDamage(0, 0, one),))
    with pytest.raises(ValueError, match="but a force law defines the force"):
        gf.single_mesh(1.0, law, 100.0, power=1.5, backlash=math.inf)
    with pytest.raises(ValueError, match="does not cover one mesh cycle"):
        gf.single_mesh(1.0, gf.force_law(PAIR, LOADS[-2:], STEEL, phases=16, span="tooth"), 100.0)


def test_the_machine_of_a_scene_is_solved_under_its_own_forces():
    scene = gf.load_scene("compound_planetary", {f"pair.{name}.force_N": 1352.0 for name in set(SCENE_PAIRS.values())})
    machine = gf.build_machine(scene, loads=(1 / 16, 1 / 2, 1, 2))
    own, stated = (machine.notes[name] for name in ("mesh forces at rest [N]", "loads stated for the pairs [N]"))
    assert stated["sun_planet"] == 1352.0
    r_b = 1e-3 * scene.pairs["sun_planet"].pair.gear_1.r_b
    assert max(own.values()) < 0.6 * 1352.0, "the scene states a load that its machine does not have"
    for mesh in machine.meshes:
        assert mesh.stiffness.load[0] < 0.1 * mesh.stiffness.force
        assert_allclose(mesh.stiffness.load[-1], 2 * mesh.stiffness.force)
    sun = machine.dofs.index("sun2.theta")
    load = sum(one.row[sun] * one.value for one in machine.loads)
    assert_allclose(own["planet_planet"], load / r_b / 3, rtol=1e-6, err_msg="idlers pass on a third of the driving sun's force")
    single = gf.build_machine(scene)
    assert_allclose([mesh.stiffness.meta["force_N"] for mesh in single.meshes], [mesh.stiffness.force for mesh in machine.meshes])
    with pytest.raises(ValueError, match="give multiples"):
        gf.build_machine(scene, loads=())
