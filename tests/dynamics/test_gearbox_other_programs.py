"""Natural frequencies of trains by openTorsion and ROSS, where they are installed: same masses, constant mesh stiffness.

``pip install opentorsion ross-rotordynamics "plotly<6"`` in an environment of its own, with gearfe on its path.
"""

import copy
import math
from dataclasses import replace

import numpy as np
import pytest
from gearboxes import TWO_STAGE
from numpy.testing import assert_allclose
from scipy.linalg import eigh

import gearfe as gf
from gearfe.dynamics.machine.gearbox import _chains, gearbox
from gearfe.scene.load import scene_of

STIFFNESS = {"fast": 2e8, "slow": 3e8}
G = 2.06e11 / 2.6


def train_of(dofs, helical=()):
    """The train at standstill, its gears spur but the `helical` ones; its chains of stations and its scene."""
    tables = copy.deepcopy(TWO_STAGE)
    for name, gear in tables["gear"].items():
        gear["beta_deg"] *= name in helical
    for shaft in tables["shaft"].values():
        shaft.pop("bores_mm", None)
    tables["pair"]["slow"]["angle_deg"] = 0.0
    tables["motor"], tables["load"] = {"shaft": "one", "inertia_kgm2": 0.02}, {"brake": {"shaft": "three", "inertia_kgm2": 0.3}}
    tables["machine"]["dofs"] = dofs
    scene = scene_of("own.toml", tables)
    return replace(gearbox(scene, STIFFNESS, {"fast": (), "slow": ()}), rotors={}), _chains(scene.train), scene


def mass(machine, body, dof):
    return float(machine.mass[machine.dofs.index(f"{body}.{dof}")])


def test_torsional_train_by_opentorsion():
    import opentorsion as ot

    machine, chains, scene = train_of("torsion")
    shafts, discs, at = [], [], {}
    for chain in chains.values():
        first = len(at)
        at |= {body: first + i for i, body in enumerate(chain.names)}
        discs += [ot.Disk(at[body], mass(machine, body, "theta")) for body in chain.names]
        for i, (length, section) in enumerate(chain.pieces):
            k = G * math.pi * (1e-3 * section.diameter) ** 4 / 32 / (1e-3 * length)
            shafts.append(ot.Shaft(first + i, first + i + 1, k=k))
    gears = []
    for pair, (one, two, _) in scene.train.pairs.items():
        radii = [1e-3 * scene.gears[gear].r_b for gear in (one, two)]
        parent = ot.ElasticGear(at[one], 0.0, radii[0], c=0.0)
        gears += [parent, ot.ElasticGear(at[two], 0.0, radii[1], k=STIFFNESS[pair] * radii[0] ** 2, c=0.0, parent=parent)]
    made = ot.Assembly(shafts, discs, elastic_gear_elements=gears)
    theirs = np.sort(np.sqrt(np.abs(eigh(made.K, made.M, eigvals_only=True)))) / (2 * math.pi)
    assert_allclose(gf.natural_frequencies(machine)[0][1:], theirs[1:], rtol=1e-9)


def by_ross(rs, machine, chains, scene):
    """Natural frequencies by ROSS [Hz].

    Its second mesh is driven clockwise: the line of action is that of a pair turned by twice the pressure angle, less pi. Its k
    is normal to the teeth, here it is that of the transverse plane.
    """
    steel = rs.Material(name="box", rho=1e-9, E=2.06e11, G_s=G)  # the masses of the shafts are in the stations

    def rotor(name, chain):
        shape = {"shear_effects": True, "rotary_inertia": False, "gyroscopic": False, "shear_method_calc": "cowper"}
        parts = [rs.ShaftElement(L=1e-3 * length, idl=0.0, odl=1e-3 * section.diameter, material=steel, **shape)
                 for length, section in chain.pieces]  # fmt: skip
        stations = []
        for i, body in enumerate(chain.names):
            sizes = {"n": i, **{key: mass(machine, body, dof) for key, dof in (("m", "x"), ("Id", "tilt_x"), ("Ip", "theta"))}}
            gear = scene.gears.get(body)
            teeth = (
                {}
                if gear is None
                else {"n_teeth": gear.z, "pitch_diameter": 2e-3 * gear.r, "pr_angle": math.radians(20), "helix_angle": gear.beta}
            )
            stations.append((rs.DiskElement if gear is None else rs.GearElement)(**sizes, **teeth))
        shaft = scene.train.shafts[name]
        held = [rs.BearingElement(n=chain.names.index(chain.at(at)), kxx=shaft.radial[i], kyy=shaft.radial[i], cxx=0.0,
                                  kzz=shaft.axial[i] or 1e-6) for i, at in enumerate(shaft.bearings)]  # fmt: skip
        return rs.Rotor(parts, stations, held)

    one, two, three = (rotor(name, chain) for name, chain in chains.items())
    names = [chain.names for chain in chains.values()]
    nodes = names[0].index("a"), names[1].index("b")
    normal = STIFFNESS["fast"] / math.cos(scene.gears["a"].beta_b) ** 2
    both = rs.MultiRotor(one, two, coupled_nodes=nodes, gear_mesh_stiffness=normal, orientation_angle=0.0)
    nodes = len(names[0]) + names[1].index("c"), names[2].index("d")
    turned = 2 * scene.pair("slow").pair.alpha_wt - math.pi
    train = rs.MultiRotor(both, three, coupled_nodes=nodes, gear_mesh_stiffness=STIFFNESS["slow"], orientation_angle=turned)
    return np.sort(np.sqrt(np.abs(eigh(train.K(0), train.M(0), eigvals_only=True)))) / (2 * math.pi)


@pytest.mark.slow
def test_spur_train_in_six_directions_by_ross():
    made = train_of("six")
    theirs = by_ross(pytest.importorskip("ross"), *made)
    assert_allclose(gf.natural_frequencies(made[0])[0][1:], theirs[1:], rtol=1e-6)


@pytest.mark.slow
def test_helical_rows_of_ross_differ_in_two_entries(monkeypatch):
    """Version 2.3.0 has sin(alpha) sin(beta) as axial component, and the tilt of the driven gear with the other sign.

    With the unit normal of the tooth, (cos alpha cos beta, sin alpha, cos alpha sin beta), at the pitch point both agree.
    """
    rs, made = pytest.importorskip("ross"), train_of("six", helical="ab")
    ours = gf.natural_frequencies(made[0])[0][1:]
    assert 0.01 < np.abs(by_ross(rs, *made)[1:] / ours - 1).max() < 0.05

    def corrected(self):
        a, b, p = self.mesh.pressure_angle, self.mesh.helix_angle - math.pi, self.orientation_angle
        x, y, z = math.cos(a) * math.cos(b), math.sin(a), math.cos(a) * math.sin(b)
        n = np.array([math.sin(p) * x + math.cos(p) * y, math.sin(p) * y - math.cos(p) * x, z])
        tilts = z * np.array([math.sin(p), -math.cos(p)])
        r_1, r_2 = (gear.pitch_diameter / 2 for gear in (self.mesh.driving_gear, self.mesh.driven_gear))
        row = np.concatenate([n, r_1 * tilts, [-x * r_1], -n, r_2 * tilts, [x * r_2]])
        return np.outer(row, row)

    monkeypatch.setattr(rs.MultiRotor, "coupling_matrix", corrected)
    assert_allclose(ours, by_ross(rs, *made)[1:], rtol=1e-6)
