"""What other programs receive: an FMU run by fmpy, tables read by scipy, outlines, solids, and gears that come back from REXS."""

import math
import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.io import loadmat
from usual import RACK

import gearfe as gf
from gearfe.app.cli.arguments import main
from gearfe.exchange.mesh_table import mesh_table
from gearfe.exchange.outline_file import outline_lines

PAIR = gf.GearPair(gf.Gear(z=21, r_bore=7.4, E_sn=-0.03, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
STEEL = gf.Material(E=207e3, nu=0.25)
HOW = gf.Solve(phases=32)


def case_of(tooth=5):
    """A pair with tip relief and a cracked tooth of the wheel."""
    relieved = gf.Flank(tip_relief=0.01, tip_start_diameter=44.5)
    return gf.Case(PAIR, 2000.0, STEEL, damage={"wheel": [gf.Crack(level=0.4, tooth=tooth)]}, flanks={"pinion": relieved})


class Running:
    """An FMU as a function."""

    def __init__(self, path, kind="ModelExchange"):
        description = fmpy.read_model_description(str(path))
        self.names = {one.name: one.valueReference for one in description.modelVariables}
        self.fmu = fmpy.instantiate_fmu(fmpy.extract(str(path)), description, kind)
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def __call__(self, *names, **values):
        """Values of outputs for inputs."""
        self.fmu.setReal([self.names[name] for name in values], list(values.values()))
        return self.fmu.getReal([self.names[name] for name in names])


@pytest.fixture(scope="module")
def running(tmp_path_factory):
    path = tmp_path_factory.mktemp("fmu") / "pair.fmu"
    gf.write_fmu(path, case_of(), HOW)
    assert not validate_fmu(str(path))
    return Running(path)


def test_the_torque_of_the_fmu_is_that_of_gearfe_at_any_angle(running):
    """Linear between phases; over both gears' revolutions, backwards too, with loss of contact and back flanks."""
    table, (r_1, r_2) = mesh_table(case_of(), HOW), (1e-3 * gear.r_b for gear in (PAIR.gear_1, PAIR.gear_2))
    play = 1e-3 * PAIR.backlash
    rng = np.random.default_rng(1)
    for phase, x in zip(rng.uniform(-100, 100, 60), rng.uniform(-4e-5, 2e-5, 60), strict=True):
        phi_1 = 2 * math.pi * phase / 21
        k, e = (float(value) for value in table.at(np.array(phase)))
        depth = max(x - e, 0.0) + min(x - e + play, 0.0)
        got = running("tau_1", "tau_2", phi_1=phi_1, phi_2=(r_1 * phi_1 - x) / r_2)
        assert got == pytest.approx([-k * depth * r_1, k * depth * r_2], abs=1e-6 * 2000 * r_2)


def test_the_fmu_softens_where_the_cracked_tooth_of_the_wheel_meshes(running):
    """The loss returns after a revolution of the wheel, and is that of the cracked tooth solved alone."""
    phases = np.arange(31 * 32) / 32
    k = np.array([running("k", phi_1=2 * math.pi * phase / 21)[0] for phase in phases])
    healthy = gf.solve(gf.Case(PAIR, 2000.0, STEEL, flanks=case_of().flanks), HOW)
    worst = phases[np.argmin(k / np.tile(healthy.k, 31))]
    span = (31 - 5, 31 - 5 + PAIR.eps_alpha)
    assert span[0] <= worst <= span[1]
    hurt = gf.solve(case_of(0), gf.Solve(phases=32, span="tooth"))
    inside = (phases >= span[0]) & (phases <= span[0] + hurt.phase.max())
    assert k[inside] == pytest.approx(np.interp(phases[inside] - span[0], hurt.phase, hurt.k), rel=1e-9)


@pytest.mark.slow
def test_a_resonance_of_the_fmu_is_that_of_simulate(tmp_path):
    """A mass on the mesh under a constant force; speeds around the mesh frequency at which its vibration is largest."""
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
    case, mass, force = gf.Case(pair, 2000.0, STEEL), 0.5, 2000.0
    curve, fine = gf.solve(case, HOW), gf.mesh_cycle(case, HOW, fine=True).healthy
    r_1, own = 1e-3 * pair.gear_1.r_b, math.sqrt(curve.k.mean() / mass) / (2 * math.pi)
    damping = 0.1 * math.sqrt(curve.k.mean() * mass)
    gf.write_fmu(tmp_path / "healthy.fmu", case, HOW)
    healthy = Running(tmp_path / "healthy.fmu")
    r_2 = 1e-3 * pair.gear_2.r_b
    speeds, sizes = own * np.linspace(0.92, 1.04, 7), {"fmu": [], "simulate": []}
    for mesh in speeds:

        def slope(t, y, mesh=mesh):
            phi_1 = 2 * math.pi * mesh * t / 21
            values = {"phi_1": phi_1, "phi_2": (r_1 * phi_1 - y[0]) / r_2, "w_1": 0.0, "w_2": -y[1] / r_2, "damping": damping}
            return np.array([y[1], (force - healthy("force", **values)[0]) / mass])

        y, step, track = np.array([force / curve.k.mean(), 0.0]), 1 / (128 * mesh), []
        for i in range(40 * 128):  # Runge and Kutta
            t = i * step
            a = slope(t, y)
            b = slope(t + step / 2, y + step / 2 * a)
            c = slope(t + step / 2, y + step / 2 * b)
            y = y + step / 6 * (a + 2 * b + 2 * c + slope(t + step, y + step * c))
            track.append(y[0])
        sizes["fmu"].append(np.ptp(track[-5 * 128 :]))
        machine = gf.single_mesh(mass, fine, mesh, force=force, damping=damping)
        sizes["simulate"].append(np.ptp(gf.simulate(machine, 40 / mesh, rate=128 * mesh)["pair.x"][-5 * 128 :]))
    peaks = []
    for values in sizes.values():
        a, b, _ = np.polyfit(speeds / own, values, 2)
        peaks.append(-b / (2 * a))
    assert 0.93 < peaks[1] < 1.03
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-3)
    assert sizes["fmu"] == pytest.approx(sizes["simulate"], rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".mat", ".txt"])
def test_tables_are_read_back(tmp_path, suffix):
    path = tmp_path / f"table{suffix}"
    gf.write_mesh_table(path, case_of(), HOW)
    table = mesh_table(case_of(), HOW)
    if suffix == ".mat":
        read = loadmat(path)
        angle, k, unloaded = (read[name].ravel() for name in ("angle_rad", "k_N_per_m", "unloaded_m"))
    else:
        lines = path.read_text(encoding="utf-8").splitlines()
        assert lines[:2] == ["#1", f"double mesh({table.phase.size + 1},3) # angle_rad, k_N_per_m, unloaded_m"]
        angle, k, unloaded = np.loadtxt(lines[2:]).T
    assert angle[-1] == pytest.approx(2 * math.pi * 31 / 21, rel=1e-15)
    assert np.array_equal(k, np.append(table.k, table.k[0]))
    assert np.array_equal(unloaded, np.append(table.unloaded, table.unloaded[0]))


def test_outlines_have_missing_teeth_chips_and_cracks(tmp_path):
    import ezdxf

    gear = PAIR.gear_1
    damage = [gf.Crack(level=0.4, tooth=5), gf.MissingTooth(tooth=9), gf.Chip(depth=1.0, tooth=12)]
    teeth, lines, _ = outline_lines(gear, damage)
    radius, tooth = np.hypot(*teeth), np.arctan2(*teeth) % (2 * math.pi) / (2 * math.pi / 21)
    near = {which: radius[np.abs((tooth - which + 10.5) % 21 - 10.5) < 0.2].max() for which in (0, 9, 12)}
    assert near[0] == pytest.approx(gear.r_a)
    assert near[9] == pytest.approx(gear.r_f)
    assert gear.r_a - 1.0 < near[12] < gear.r_a + 1e-9
    assert np.hypot(*lines[0]).min() < gear.r_f + 2
    assert np.arctan2(*lines[0][:, -1]) == pytest.approx(2 * math.pi * 5 / 21, abs=0.15)
    gf.write_outline(tmp_path / "gear.dxf", gear, damage)
    shapes = [(one.dxftype(), one.dxf.layer) for one in ezdxf.readfile(tmp_path / "gear.dxf").modelspace()]
    assert shapes == [("LWPOLYLINE", "TEETH"), ("CIRCLE", "HELD"), ("LWPOLYLINE", "DAMAGE")]
    gf.write_outline(tmp_path / "gear.svg", gear, damage)
    assert (tmp_path / "gear.svg").read_text(encoding="utf-8").count('stroke="red"') == 1


@pytest.mark.parametrize("gear", [
    gf.Gear(z=18, r_bore=7.0, x=0.2, **RACK),
    pytest.param(gf.Gear(z=12, x=0.4, r_bore=4.0, beta=0.4, **RACK), marks=pytest.mark.slow),
    pytest.param(gf.Gear(z=40, r_rim=50.0, addendum=0.8, rack_tip_radius=0.2, beta=-0.2, **RACK), marks=pytest.mark.slow),
], ids=["spur", "helical", "ring"])  # fmt: skip
def test_a_solid_has_the_volume_of_its_section(tmp_path, gear, capfd):
    path = tmp_path / "gear.step"
    volume = gf.write_step(path, gear)
    x, y = outline_lines(gear).teeth
    area = abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2
    assert volume == pytest.approx(abs(area - math.pi * gear.held**2) * gear.b, rel=2e-4)
    assert capfd.readouterr().out == ""
    from gearfe.geometry.mesh.mesher import gmsh_session

    with gmsh_session() as gmsh:
        shapes = gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        assert gmsh.model.occ.getMass(*shapes[0]) == pytest.approx(volume, rel=1e-6)


@pytest.mark.parametrize("scene", ["planetary_pitting", "compound_planetary", "helical_pitting"])
def test_gears_come_back_from_rexs(tmp_path, scene):
    made = gf.load_scene(scene)
    gf.write_rexs(tmp_path / "unit.rexs", made)
    back = gf.import_rexs(tmp_path / "unit.rexs").scene
    for one, two in zip(made.pairs.values(), back.pairs.values(), strict=True):
        assert two.materials == one.materials
        assert two.force == pytest.approx(one.force, rel=1e-9)
        assert two.pair.a == one.pair.a
        for first, second in zip((one.pair.gear_1, one.pair.gear_2), (two.pair.gear_1, two.pair.gear_2), strict=True):
            numbers = [[getattr(gear, name) or 0.0 for name in gear.__dataclass_fields__] for gear in (first, second)]
            assert numbers[1] == pytest.approx(numbers[0], rel=1e-9, abs=1e-9)


@pytest.mark.quick
def test_the_command_writes_what_the_suffix_says(tmp_path, capsys):
    common = ["export", "planetary_pitting", "--phases", "8", "-o"]
    for name in ("a.fmu", "a.txt", "a.svg"):
        assert main([*common, str(tmp_path / name)]) == 0
    assert "sources/gear_pair.c" in zipfile.ZipFile(tmp_path / "a.fmu").namelist()
    capsys.readouterr()
    assert main([*common, str(tmp_path / "a.exe")]) == 1
    assert "give a file .fmu, .mat, .txt, .rexs, .dxf, .svg, .step, .stp" in capsys.readouterr().err
