"""Rotor programs that take the mesh stiffness: openTorsion (one constant) and ROSS (a curve over the angle)."""

import math

import numpy as np
import pytest
from opentorsion.assembly import Assembly
from opentorsion.elements.disk_element import Disk
from opentorsion.elements.elastic_gear_element import ElasticGear
from usual import PAIR

import gearfe as gf
from gearfe.exchange.mesh_table import mesh_table

CASE = gf.Case(PAIR, 2000.0, gf.Material(E=207e3, nu=0.25))


def test_opentorsion_has_the_natural_frequency_of_the_pair():
    """Two gears on their mesh: ``omega^2 = k (r_b1^2 / I_1 + r_b2^2 / I_2)``, which the machine of gearfe has too."""
    k, (r_1, r_2), (i_1, i_2) = float(gf.solve(CASE).k.mean()), (1e-3 * PAIR.gear_1.r_b, 1e-3 * PAIR.gear_2.r_b), (2e-4, 9e-4)
    parent, discs = ElasticGear(0, 0.0, r_1), [Disk(0, i_1), Disk(1, i_2)]
    assembly = Assembly([], discs, elastic_gear_elements=[parent, ElasticGear(1, 0.0, r_2, k=k * r_1**2, c=0.0, parent=parent)])
    found = np.sqrt(np.abs(assembly.undamped_modal_analysis()[0]).max()) / (2 * math.pi)
    mass = 1 / (r_1**2 / i_1 + r_2**2 / i_2)
    machine = gf.single_mesh(mass, k, 1000.0, force=2000.0)
    assert found == pytest.approx(math.sqrt(k / mass) / (2 * math.pi), rel=1e-9)
    assert found == pytest.approx(float(gf.natural_frequencies(machine)[0][-1]), rel=1e-9)


@pytest.mark.slow
def test_ross_runs_with_the_curve_of_gearfe():
    """The curve of its mesh is replaced; its own is 18 % (constant) and 24 % (over the angle) too stiff on average."""
    ross = pytest.importorskip("ross")
    mesh_of = pytest.importorskip("ross.gear_element").Mesh
    table = mesh_table(CASE, gf.Solve(phases=64))
    steel = ross.Material("gear_steel", rho=7810, E=207e9, Poisson=0.25)
    gears = [
        ross.GearElementTVMS(
            n=1, material=steel, width=0.02, bore_diameter=2e-3 * gear.r_bore, module=2e-3, n_teeth=gear.z, pr_angle=gear.alpha_n
        )
        for gear in (PAIR.gear_1, PAIR.gear_2)
    ]
    own = mesh_of(*gears)
    assert own.stiffness / table.k.mean() == pytest.approx(1.182, abs=0.002)
    assert np.mean(own.stiffness_range) / table.k.mean() == pytest.approx(1.240, abs=0.002)

    def rotor(gear):
        shaft = [ross.ShaftElement(L=0.1, idl=0, odl=0.03, material=steel) for _ in range(2)]
        return ross.Rotor(shaft, [gear], [ross.BearingElement(n=n, kxx=1e8, cxx=1e3) for n in (0, 2)])

    mean = float(table.k.mean())
    train = ross.MultiRotor(rotor(gears[0]), rotor(gears[1]), (1, 1), gear_mesh_stiffness=mean, update_mesh_stiffness=True)
    train.mesh.theta_range = np.append(table.angle, 2 * math.pi * table.cycles / PAIR.gear_1.z)
    train.mesh.stiffness_range = np.append(table.k, table.k[0])
    angle = np.random.default_rng(0).uniform(0, 50, 200)
    assert train.mesh.interpolate_stiffness(angle) == pytest.approx(table.at(angle * PAIR.gear_1.z / (2 * math.pi))[0], rel=1e-6)
    times = np.linspace(0, 0.005, 501)
    force = np.zeros((times.size, train.ndof))
    force[:, train.mesh.driving_gear.dof_global_index["theta_1"]] = 10.0
    moved = train.run_time_response(speed=100.0, F=force, t=times).yout
    assert np.isfinite(moved).all()
    assert np.ptp(moved) > 0
