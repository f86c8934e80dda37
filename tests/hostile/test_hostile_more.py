"""More hostile inputs: scenes and studies of wrong kinds, models of the user's own, averages, folders and options of verbs."""

import math

import numpy as np
from judge import CLEAR, judged, judged_command, tally
from usual import RACK, STEEL

import gearfe as gf
from gearfe.scene.load import read_tables, scene_of

GEAR = gf.Gear(z=21, r_bore=7.4, **RACK)
PAIR = gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK))
KINDS = [3, 10**400, math.nan, True, "x", [], [1], [[]], [{"gear": "sun"}], {"x": 1}, {"x": [1]}, {"x": {"x": {}}}]


def test_scenes_of_wrong_kinds():
    _, whole = read_tables("planetary_pitting")
    tables = (
        "material",
        "gear",
        "pair",
        "flank",
        "support",
        "shaft",
        "crack",
        "pits",
        "machine",
        "given",
        "assumption",
        "reference",
    )
    found = {}
    for name in tables:
        for k, value in enumerate(KINDS):
            if value == [] and name in ("crack", "pits", "assumption", "reference"):
                continue  # none of them
            found[f"{name} #{k}"] = judged(lambda n=name, v=value: scene_of("own.toml", whole | {n: v}), ["own.toml"])
    for key, value in (("speed_rpm", 0), ("speed_rpm", -1000), ("torque_Nm", -1.0), ("torque_Nm", 1e25), ("n_planets", 10**9)):
        machine = whole["machine"] | {key: value}
        found[f"machine {key} = {value}"] = judged(lambda m=machine: scene_of("own.toml", whole | {"machine": m}), [key])
    counts, wrong = tally(found)
    assert len(found) >= 140
    assert counts == {CLEAR: len(found)}, wrong


def test_loads_pits_and_signals():
    turn = np.cos(24 * np.linspace(0, 2 * math.pi, 512, endpoint=False))
    rows = [[], [[]], turn.reshape(2, -1), 1e200 * turn, 1j * turn, "abc", None, 3.0, np.where(turn > 0.999, math.nan, turn)]
    found = {f"average {k}": judged(lambda r=row: gf.gear_indicators(r, 24), ["average"]) for k, row in enumerate(rows)}
    found |= {f"teeth {z!r}": judged(lambda z=z: gf.gear_indicators(turn, z), ["teeth"]) for z in (24.0, True, "24", None, -3)}
    for rate in (True, None, "1", 1e-320, 10**400, math.nan, [1.0]):
        found[f"rate {str(rate)[:9]}"] = judged(lambda r=rate: gf.Signal(turn, r, "g"), ["rate"])
    for load in (1e30, 1e300, 3e4, True):
        for work in (gf.root_stress, gf.root_stress_along_width):
            found[f"{work.__name__} {load}"] = judged(lambda w=work, p=load: w(GEAR, 20.8, p, STEEL), ["line_load"])
    for axes in ((50.0, 500.0), (1e30, 1e30), (1e200, 1.0), (1e-200, 1.0)):
        found[f"pit {axes}"] = judged(
            lambda a=axes: gf.mesh_stiffness(
                PAIR, 2000.0, STEEL, method="ritz3d", refine=0.4, phases=[0.5], damage={"pinion": [gf.Pit(20.8, 10.0, a, 0.2)]}
            ),
            ["whole flank", "axes"],
        )
    counts, wrong = tally(found)
    assert counts == {CLEAR: len(found)}, wrong


def commands():
    scene = "planetary_pitting"
    for value in ("-1", "nan", "inf", "x", ""):
        yield ["report", scene, "-o", "x.html", "--duration", value], ["duration"]
    for value in ("", "x", "2.5", "0", "-3"):
        yield ["mesh", scene, "-o", "x.msh", "--teeth", value], ["teeth"]
    for options in (["-o", ""], ["-o", "x", "--scheduler", ""], ["-o", "x", "--workers", "0"], []):
        yield ["sweep", "s.toml", *options], ["folder", "scheduler", "workers", "required"]
    for verb in ("sweep", "dataset"):
        yield [verb, "none.toml", "-o", "x"], ["no study", "none.toml"]
        yield [verb, "b.toml", "-o", "x"], ["not readable as TOML"]
    for value in ("", "x", "none/x.toml", "s.toml"):
        yield ["new", value], ["toml", "cannot write"]
    for option in ("--mesh", "--fault", "--carrier", "--shaft", "--rate", "--scale"):
        for value in ("nan", "inf", "0", "x", ""):
            yield ["signal", "a.csv", "--column", "a", "--mesh", "40", option, value], [option[2:], "shaft_frequency", "Hz"]
    for option in ("--teeth", "--pulses"):
        for value in ("0", "-1", "2.5", "x"):
            yield ["signal", "a.csv", "--column", "a", "--shaft", "1", option, value], [option[2:]]
    for option in ("--case", "--pair", "--force", "--method", "--phases", "--refine"):
        yield ["stiffness", scene, f"{option}=--"], ["expected one argument", "invalid"]


def test_more_command_lines(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text('scene = "planetary_pitting"\n[vary]\n"gear.sun.r_bore_mm" = [7.0, 7.4]\n')
    (tmp_path / "b.toml").write_bytes(bytes(range(256)))
    (tmp_path / "a.csv").write_text("time [s],a [g]\n" + "".join(f"{i / 100},{(7919 * i) % 101}\n" for i in range(400)))
    before = sorted(path.name for path in tmp_path.iterdir())
    found = {" ".join(map(repr, line)): judged_command(line, words) for line, words in commands()}
    counts, wrong = tally(found)
    assert len(found) >= 60
    assert counts == {CLEAR: len(found)}, wrong
    assert sorted(path.name for path in tmp_path.iterdir()) == before
