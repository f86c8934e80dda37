"""The herringbone stage: forces, lines that cancel, the fast path on 55 degrees of freedom."""

import math

import numpy as np
import pytest
from machines import SHAPE, herringbone, lines, tooth
from numpy.testing import assert_allclose


def test_forces_of_the_herringbone_stage(herringbone_stage):
    """7614 N per planet at 400 N m; axial forces cancel in the planets and between the halves of the sun."""
    machine = herringbone(herringbone_stage)
    q = machine.rest()
    forces = machine.G @ q * machine.mean_stiffness()
    sun = herringbone_stage.sun
    assert_allclose(forces, 400 / 3 / 2 / (1e-3 * sun.r_b), rtol=1e-6)
    at = dict(zip(machine.dofs, q, strict=True))
    assert_allclose(at["sunL.z"], -at["sunR.z"], rtol=1e-6)
    assert abs(at["sunL.z"]) > 1e-7
    assert max(abs(at[f"planet{i}{h}.z"]) for i in (1, 2, 3) for h in "LR") < 1e-6 * abs(at["sunL.z"])
    assert abs(at["planet1L.tilt_y"]) > 1e-7  # the two axial forces of a planet tilt it
    axial = forces[0] * math.tan(abs(sun.beta_b))
    assert_allclose(-machine.meshes[0].row[machine.dofs.index("sunL.z")] * forces[0], axial * 1, rtol=1e-6)


@pytest.mark.parametrize("identical", [True, False])
def test_sun_tooth_lines_cancel_in_translation(herringbone_stage, identical):
    """Damaged sun tooth, three in-phase planets: 480 and 80 Hz in torsion and mesh force; in sun x only if planets differ."""
    damage = {"sun": (0, {"sun_planet": tooth(6e8 * SHAPE, 0.3, 1.5)})}
    machine = herringbone(herringbone_stage, damage)
    if not identical:
        from dataclasses import replace

        softer = [replace(m, stiffness=0.9 * np.asarray(m.stiffness)) if "planet1" in m.name else m for m in machine.meshes]
        machine = replace(machine, meshes=tuple(softer))
    from gearfe.dynamics.motion.steady import steady_state

    found = steady_state(machine, dt=1 / 480 / 60, tolerance=1e-11)
    assert found.stable
    assert_allclose(found.period, 18 / 480, rtol=1e-9)
    at = {name: lines(found.response, name, 80.0, (1, 5, 6, 7)) for name in ("sunL.theta", "sunL.x", "force sun_planet1L")}
    assert (at["sunL.theta"] > 1e-3 * at["sunL.theta"].max()).all()
    assert (at["force sun_planet1L"] > 0.1).all()
    every = lines(found.response, "sunL.x", 80 / 3, range(1, 25)).max()
    if identical:
        assert at["sunL.x"].max() < 1e-8 * every
    else:
        assert at["sunL.x"].max() > 1e-2 * every


def test_cancelling_lines_leave_those_of_single_planets(herringbone_stage):
    """The tooth passes the planets one after the other: multiples of 80/3 Hz that are none of 80 Hz stay in sun x."""
    from gearfe.dynamics.motion.steady import steady_state

    machine = herringbone(herringbone_stage, {"sun": (0, {"sun_planet": tooth(6e8 * SHAPE, 0.3, 1.5)})})
    response = steady_state(machine, dt=1 / 480 / 60).response
    assert (lines(response, "sunL.x", 80 / 3, (17, 19)) > 1e3 * lines(response, "sunL.x", 80.0, (6,))).all()
