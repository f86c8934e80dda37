"""The machines of the page `sets`: a row computed anew, what is added to the meshes, and the section of a helical gear."""

import numpy as np
from numpy.testing import assert_allclose

import gearfe as gf
from validation.make import sets_dynamics
from validation.shared.kept_rows import stored
from validation.shared.simulated import scene


def test_stiffness_of_the_row_on_file():
    """Of the set of S0 and S1, under the force that its torque makes; every mesh mode feels it, modes on bearings hardly."""
    sun, torque = scene("planetary_pitting").gears["sun"], scene("planetary_pitting").machine["torque_Nm"]
    found = gf.planetary_stiffness(sets_dynamics.set_of("planetary_pitting", 1e3 * torque / (3 * sun.r_b)), sets_dynamics.PHASES)
    row = stored(sets_dynamics.TABLE)["planetary_pitting"]
    assert_allclose(found.k.mean(axis=(1, 2)), row["k"]["set"], rtol=1e-4)
    assert_allclose(found.k_alone.mean(axis=(1, 2)), row["k"]["alone"], rtol=1e-4)
    change = np.array(row[sets_dynamics.TOGETHER]["frequencies"]) / row[sets_dynamics.ALONE]["frequencies"] - 1
    assert abs(change[:12]).max() < 2e-3
    assert abs(change[12:]).min() > 5e-3


def test_what_a_set_adds_stands_at_its_own_phase():
    """In the set's own curves of isolated pairs, k of the set comes out at every position, planets out of phase as well."""
    case = sets_dynamics.set_of("planetary_pitting", 1700.0).with_(angles=2 * np.pi / 105 * np.array([0, 30, 71]))
    found = gf.planetary_stiffness(case, 8)
    phases = gf.stage_phases(case.pairs, 3, frequency=280.0, places=case.angles)
    alone = {}
    for kind, inner in (("sun_planet", 0), ("planet_ring", 1)):
        for planet in range(3):
            name = f"{kind}{planet + 1}"
            own = (found.position + phases[name]["phase"]) % 1.0
            order = np.argsort(own)
            alone[name] = gf.Samples(own[order], found.k_alone[inner, order, planet])
    bodies = [gf.Body("one", 1.0, 1.0)]
    row = gf.Layout(bodies).unit("one", "x")
    meshes = tuple(gf.GearMesh(name, row, curve, **phases[name]) for name, curve in alone.items())
    made = sets_dynamics.softer(gf.Machine(gf.Layout(bodies).dofs, np.ones(3), (), meshes), "planetary_pitting", found)
    for mesh in made.meshes:
        inner, planet = int(mesh.name.startswith("planet_ring")), int(mesh.name[-1]) - 1
        want = dict(zip(np.round(alone[mesh.name].phase, 6).tolist(), [None] * 8, strict=True))
        for position, k in zip(found.position, found.k[inner, :, planet], strict=True):
            want[round(float((position + phases[mesh.name]["phase"]) % 1.0), 6)] = k
        got = dict(zip(np.round(mesh.stiffness.phase, 6).tolist(), mesh.stiffness.k.tolist(), strict=True))
        for phase, k in want.items():
            assert_allclose(got[phase], k, rtol=1e-5)


def test_the_section_of_a_helical_gear():
    """Its radii and tooth thickness are those of the gear, its width that of a half."""
    for gear in scene("herringbone").gears.values():
        section = sets_dynamics._section(gear, "herringbone")
        for name in ("r_b", "r_a", "r_f", "r"):
            assert_allclose(getattr(section, name), getattr(gear, name), rtol=1e-9)
        assert_allclose(section.half_thickness(gear.r), gear.half_thickness(gear.r), rtol=1e-9)
        assert_allclose(section.b, gear.b / 2)
