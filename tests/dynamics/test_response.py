"""Channels, units and files of a response; errors of a machine."""

import math

import numpy as np
import pytest
from machines import stepped, two_masses
from numpy.testing import assert_allclose
from scipy.io import loadmat

from gearfe.dynamics.machine.gear_mesh import GearMesh
from gearfe.dynamics.machine.loads import Load
from gearfe.dynamics.machine.mesh_errors import with_errors
from gearfe.dynamics.machine.springs import Spring
from gearfe.dynamics.machine.tables import Machine
from gearfe.dynamics.motion.simulate import simulate

pytestmark = pytest.mark.quick


def test_errors_of_a_machine_shift_its_bodies():
    """A body displaced by s answers as the error -row s: at rest the misplaced teeth carry the same forces as a moved body."""
    machine = two_masses()
    moved = with_errors(machine, profile=1e-6, runout={"a": (2e-6, 30.0, 0.4)}, place={"b": (5e-7, 0.0)})
    t = np.linspace(0, 0.05, 7)
    want = 1e-6 * np.sin(2 * math.pi * 500 * t) - 2e-6 * np.cos(2 * math.pi * 30 * t + 0.4) + 5e-7
    assert_allclose(moved.meshes[0].e(t)[0], want, atol=1e-18)
    with pytest.raises(ValueError, match="no body 'c'"):
        with_errors(machine, place={"c": (0.0, 0.0)})


def test_the_runout_of_a_body_that_moves_in_a_plane():
    """Its teeth's centre goes round at (cos, sin)(2 pi f t + start) from the axis; the mesh closes by its row with that."""
    row = np.array([0.6, 0.8, -1.0])
    mesh = GearMesh("m", row, np.full(8, 1e8), frequency=500.0)
    springs = [Spring(f"to ground {i}", np.eye(3)[i], 1e7) for i in range(3)]
    machine = Machine(("a.x", "a.y", "b.x"), np.ones(3), tuple(springs), (mesh,), (Load("F", np.eye(3)[2], 10.0),))
    moved = with_errors(machine, runout={"a": (2e-6, 30.0, 0.4)})
    t = np.linspace(0, 0.05, 13)
    turn = 2 * math.pi * 30.0 * t + 0.4
    away = 2e-6 * np.array([np.cos(turn), np.sin(turn), 0 * t])
    assert_allclose(moved.meshes[0].e(t)[0], -row @ away, atol=1e-18)


def test_channels_units_and_files(tmp_path):
    machine = two_masses(error=((1e-6, 500.0, 0.3),))
    r = stepped(machine, 0.01, dt=2e-5)
    speed, motion = r["a.x velocity"], r["a.x"]
    assert_allclose(np.gradient(motion, r.time)[2:-2], speed[2:-2], atol=5e-3 * np.ptp(speed))
    assert_allclose(np.gradient(speed, r.time)[2:-2], r["a.x acceleration"][2:-2], atol=2e-2 * np.ptp(r["a.x acceleration"]))
    assert_allclose(r["a.x acceleration"], 1000.0 - r["force m"], rtol=1e-6, atol=1e-3)
    assert_allclose(r["compression m"], machine.G[0] @ [motion, r["b.x"]] - machine.meshes[0].e(r.time)[0], rtol=1e-9)
    units = {"a.x": "m", "b.x velocity": "m/s", "a.x acceleration": "m/s2", "force m": "N", "stiffness m": "N/m"}
    assert {name: r.unit(name) for name in units} == units
    assert len(r.names) == 3 * 2 + 3
    with pytest.raises(ValueError, match="no channel"):
        r["c.x"]
    r.save(tmp_path / "r.csv", ["a.x", "force m"])
    rows = np.loadtxt(tmp_path / "r.csv", delimiter=",", skiprows=3)
    assert_allclose(rows, np.stack([r.time, r["a.x"], r["force m"]], axis=1), rtol=0)
    r.save(tmp_path / "r.npz")
    with np.load(tmp_path / "r.npz") as data:
        assert list(data["names"]) == ["a.x", "b.x", "force m"]
        assert_allclose(data["values"][:, 2], r["force m"], rtol=0)
    r.save(tmp_path / "r.mat")
    data = loadmat(tmp_path / "r.mat")
    assert_allclose(data["values"], np.stack([r["a.x"], r["b.x"], r["force m"]], axis=1), rtol=0)
    with pytest.raises(ValueError, match="no format"):
        r.save(tmp_path / "r.txt")


def test_states_and_durations_that_cannot_be_are_refused():
    machine = two_masses()
    n = len(machine.dofs)
    far = np.zeros(n)
    far[0] = 1e30
    with pytest.raises(ValueError, match="initial: the flanks of a mesh would be"):
        simulate(machine, 0.01, initial=(far, np.zeros(n)))
    with pytest.raises(ValueError, match=r"duration = 1e\+15 s: .* outputs, .* need about .* GB"):
        simulate(machine, 1e15)
    for wrong in ("1", True, None):
        with pytest.raises(ValueError, match=r"duration = .*number"):
            simulate(machine, wrong)
