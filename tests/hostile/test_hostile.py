"""More than 500 hostile or clumsy inputs through the functions and the command line: each gets a clear answer.

`judge` says for each what became of it; wanted are 0 tracebacks, 0 hangs and 0 numbers that mean nothing.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from judge import CLEAR, judged, judged_command, tally
from usual import RACK, STEEL

import gearfe as gf

NO_NUMBER = [None, "2000", "", True, False, 1j, [], {}, "nan", b"2", object()]
NOT_FINITE = [math.nan, math.inf, -math.inf]
NEGATIVE = [-1.0, -1e30]


@pytest.fixture(scope="module")
def small():
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))


def told(words):
    """How many inputs of this kind the page of clear answers counts."""
    text = (Path(__file__).parents[2] / "gearfe" / "docs" / "invalid_input.md").read_text(encoding="utf-8")
    return int(re.search(rf"^\| (\d+) {words}", text, re.M)[1])


def shown(value):
    text = repr(value)
    return text if len(text) < 60 else f"{type(value).__name__}"


def asked(table, call):
    """Judge ``call(**{name: value})`` for each (name, values, words) of a table; `words` None: the name itself."""
    found = {}
    for name, values, words, must_say in table:
        for k, value in enumerate(values):
            names = words or [name]
            found[f"{name} = {shown(value)} #{k}"] = judged(lambda n=name, v=value: call(**{n: v}), names, must_say=must_say)
    return found


def gear_inputs():
    lengths = [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, *NEGATIVE, 0.0]
    rows = [(name, [*lengths, None], None, True) for name in ("m_n", "b")]
    rows += [("z", [*NO_NUMBER, *NOT_FINITE, -21, 0, 1, 4, 20.5, 10**400], None, True)]
    rows += [("alpha_n", [*NO_NUMBER, *NOT_FINITE, -0.3, 0.0, 20.0, 1.5], None, True)]
    rows += [("r_bore", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, -1.0, 0.0, 25.0, 1e30], None, True)]
    rows += [("x", [*NO_NUMBER, *NOT_FINITE, 5.0, -5.0, 1e30], ["x = ", "x or", "base circle", "tip circle"], True)]
    rows += [("beta", [*NO_NUMBER, *NOT_FINITE, 20.0, math.pi / 2, -2.0], None, True)]
    rows += [("addendum", [*NO_NUMBER, *NOT_FINITE, -1.0, 0.0, 5.0, 1e30], None, True)]
    rows += [("dedendum", [*NO_NUMBER, *NOT_FINITE, -1.0, 0.0, 50.0], ["dedendum", "r_bore", "root"], True)]
    rows += [("rack_tip_radius", [*NO_NUMBER, *NOT_FINITE, -1.0, 1e30], ["rack_tip_radius", "tip radius"], True)]
    return rows


@pytest.mark.quick
def test_gears():
    found = asked(gear_inputs(), lambda **own: gf.Gear(**({"z": 21, "r_bore": 7.4} | RACK | own)))
    found |= asked([("a", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, -52.0, 0.0, 1.0, 60.0, 1e30], None, True)],
                   lambda a: gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK), a))  # fmt: skip
    found |= asked([("E", [*NO_NUMBER, *NOT_FINITE, *NEGATIVE, 0.0, 207.0, 207e9, 1e-300], None, True),
                    ("nu", [*NO_NUMBER, *NOT_FINITE, -0.1, 0.5, 0.6, 30.0], None, True)],
                   lambda **own: gf.Material(**({"E": 207e3, "nu": 0.3} | own)))  # fmt: skip
    counts, wrong = tally(found)
    assert len(found) == told("for gears, pairs and materials")
    assert counts == {CLEAR: len(found)}, wrong


@pytest.mark.quick
def test_damage(small):
    crack = [("level", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, -0.3, 0.0, 1.5, 1e30], None, True),
             ("angle", [*NO_NUMBER, *NOT_FINITE, 45.0, -2.0], None, True),
             ("tooth", [None, "1", 1.5, math.nan, True], None, True),
             ("start", [None, "", "tip", 3], None, True),
             ("width", ["all", (1.0,), (5.0, 1.0), (math.nan, 3.0), 3.0], ["width", "open from"], True),
             ("ends", ["x", (0.5,), (2.0, 1.0), (-1.0, 1.0), 3.0], ["ends", "part"], True),
             ("turning", ["no", 1, None], None, True)]  # fmt: skip
    pit = [("radius", [*NO_NUMBER, *NOT_FINITE, -21.0, 0.0, 1.0, 210.0], None, True),
           ("z", [*NO_NUMBER, *NOT_FINITE, -1.0, 21.0, 1e30], None, True),
           ("axes", [*NO_NUMBER, (1.0,), (0.0, 1.0), (-1.0, 1.0), (math.nan, 1.0), (1.0, math.inf), ("1", "2")], None, True),
           ("depth", [*NO_NUMBER, *NOT_FINITE, -0.1, 0.0, 5.0, 1e30], None, True),
           ("angle", [*NO_NUMBER, *NOT_FINITE, 45.0], None, True),
           ("tooth", [None, "1", 1.5, math.nan, True], None, True),
           ("side", [None, "", "left", 1], None, True)]  # fmt: skip
    run = {"pair": small, "force": 2000.0, "material": STEEL, "phases": [0.5], "method": "textbook"}
    found = asked(crack, lambda **own: gf.mesh_stiffness(**run, damage={"pinion": [gf.Crack(**({"level": 0.3} | own))]}))
    pits = asked(pit, lambda **own: gf.mesh_stiffness(
        **run, damage={"pinion": [gf.Pit(**({"radius": 20.8, "z": 10.0, "axes": (1.0, 2.0), "depth": 0.2} | own))]}))  # fmt: skip
    found = {f"crack {k}": v for k, v in found.items()} | {f"pit {k}": v for k, v in pits.items()}
    bare = [
        gf.Crack(level=0.3),
        [gf.Crack(level=0.3)],
        "crack",
        3,
        {"sun": []},
        {"pinion": "crack"},
        {"pinion": 3},
        {"wheel": [1]},
    ]
    found |= asked([("damage", bare, None, True)], lambda damage: gf.mesh_stiffness(**run, damage=damage))
    counts, wrong = tally(found)
    assert len(found) == told("for cracks and pits")
    assert counts == {CLEAR: len(found)}, wrong


def stiffness_inputs():
    forces = [
        *[v for v in NO_NUMBER if v is not None],
        *NOT_FINITE,
        *NEGATIVE,
        0.0,
        1e7,
        1e9,
        [2000.0, True],
        [[1.0]],
        [1.0, "2"],
    ]
    yield "force", forces, ["force"], True
    yield "force", [1e5, 60_000.0], ["of the module", "press"], True
    yield "torque", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, -40.0, 0.0, 1e9, 40.0], ["torque"], True
    yield "pair", [None, "planetary_pitting", 3, (21, 31)], None, True
    yield "material", [*NO_NUMBER, (STEEL,), (STEEL, STEEL, STEEL), (STEEL, "steel")], None, True
    yield "method", [None, "", "Ritz", "fem", 3, True, ["ritz"]], None, True
    yield "phases", [*NO_NUMBER, *NOT_FINITE, 0, -4, 2.5, 10**6, 1e13, [1e13], [0.0, 1e6], [math.nan], [[0.1]], ["a"]], None, True
    yield "span", [None, "", "turn", 1], None, True
    yield "refine", [*NO_NUMBER, *NOT_FINITE, 0.0, -1.0, 1e-9, 0.1, 1e9, 300], None, True
    yield "order", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, -1, 0, 1, 3.5, 9, 10**6], None, True
    yield "teeth", [*[v for v in NO_NUMBER if v is not None], *NOT_FINITE, 0, -1, 2.5, 10**6], None, True
    yield "state", [None, "", "stress", 1], None, True
    yield "face", ["", "straight", 3, "helical", "herringbone"], ["face"], True
    yield "groove", [*NO_NUMBER, *NOT_FINITE, 5.0, -5.0, 1e30], ["groove"], True
    yield "variants", [3, "x", {"theta_f": math.nan}, {"nothing": 1}, {"foundation": "x"}, {"root": 3}], ["variants"], True
    for name in ("error", "extended", "cache"):
        yield name, ["no", "False", 0, 1, None, 2.5, []], None, True


def test_stiffness(small):
    base = {"pair": small, "force": 2000.0, "material": STEEL, "phases": [0.5], "method": "ritz"}
    found = asked(stiffness_inputs(), lambda **own: gf.mesh_stiffness(**(base | own)))
    closed = [("refine", [0.5, 2.0], None, True), ("order", [3, 4], None, True), ("error", [True, "no"], None, True),
              ("state", ["plane stress"], None, True), ("teeth", [5], None, True), ("face", ["helical", "herringbone"], None, True),  # noqa: E501
              ("variants", [{"theta_f": math.nan}, {"theta_f": -1.0}, {"theta_f": 1e30}, {"theta_f": "x"}, {"foundation": 3},
                            {"root": "x"}, {"lever": 1}, {"contact": "x"}, {"lost": "x"}, {"crack_model": "x"}, {"phase": 1}],
               ["variants", "theta_f", "foundation", "root", "lever", "contact", "lost", "crack_model"], True),
              ("force", [1e5, 1e7, 1e30, 1e300], ["module"], True)]  # fmt: skip
    found |= {
        f"textbook {k}": v
        for k, v in asked(closed, lambda **own: gf.mesh_stiffness(**(base | {"method": "textbook"} | own))).items()
    }
    hurt = {"damage": {"pinion": [gf.Crack(level=0.3)]}}
    mixed = {
        "crack with coupled": ({"method": "coupled", **hurt}, ["crack", "damage"]),
        "helical with ritz": ({"face": "helical"}, ["face"]),
        "groove of a section": ({"groove": 1.0}, ["groove"]),
        "teeth with ritz": ({"teeth": 5}, ["teeth"]),
        "fe too fine": ({"method": "fe", "refine": 60}, ["GB"]),
        "force and torque": ({"torque": 40.0}, ["torque"]),
        "neither": ({"force": None}, ["force"]),
    }
    found |= {name: judged(lambda o=own: gf.mesh_stiffness(**(base | o)), words) for name, (own, words) in mixed.items()}
    sound = [("force", [1e-3, 1.0, 20_000.0, np.float32(2000), np.int64(2000)], None, False), ("phases", [1, [-7.3, 99.9]], None, False),  # noqa: E501
             ("refine", [0.2, 0.5], None, False), ("order", [2, 8], None, False)]  # fmt: skip
    found |= {f"sound {k}": v for k, v in asked(sound, lambda **own: gf.mesh_stiffness(**(base | own))).items()}
    counts, wrong = tally(found)
    assert len(found) == told("for loads, phases")
    assert counts == {CLEAR: len(found)}, wrong


def test_comparison_curves_and_motion(small):
    found = {}
    for k, given in enumerate([None, 3, "nope", "", small, [small], "planetary", Path("none.toml")]):
        found[f"compare {k}"] = judged(lambda g=given: gf.compare(g), ["scene", "needs its load", "pair"])
    curve = gf.mesh_stiffness(small, 2000.0, STEEL, phases=16)
    for k, given in enumerate(["x", None, True, [math.nan], math.inf, 1j]):
        found[f"curve {k}"] = judged(lambda g=given: curve(g), ["phase"])
    for k, given in enumerate([None, 3, "machine", small]):
        found[f"simulate {k}"] = judged(lambda g=given: gf.simulate(g, 0.1), ["Machine"])
    for k, given in enumerate([3, None, "textbook", "herringbone_article", "none", [1.0], STEEL]):
        found[f"own {k}"] = judged(lambda g=given: gf.OwnFlexibility(g), ["pinion", "give"])
    counts, wrong = tally(found)
    assert len(found) == told("for comparisons, curves and motion")
    assert counts == {CLEAR: len(found)}, wrong


def files(tmp_path):
    """Damaged files of every format that is read."""
    contents = {"empty": b"", "zeros": bytes(100), "text": b"hello\nworld\n", "latin": "µ;é\n1;2".encode("latin-1"),
                "bomb": b"PK\x03\x04" + bytes(50), "nan": b"time [s],a [m/s2]\n0,nan\n1,2\n", "one": b"time [s],a [m/s2]\n0,1\n",
                "comma": b"time [s];a [m/s2]\n0,5;1.2\n1,5;2,2\n", "uneven": b"time [s],a [m/s2]\n0,1\n1,2\n5,1\n",
                "matlab": b"MATLAB 5.0 MAT-file" + bytes(109), "hdf": b"\x89HDF\r\n\x1a\n" + bytes(64)}  # fmt: skip
    for suffix in (".csv", ".txt", ".npz", ".mat", ".h5", ".wav", ".uff", ".tdms", ".parquet"):
        for name, content in contents.items():
            path = tmp_path / f"{name}{suffix}"
            path.write_bytes(content)
            yield path
    yield tmp_path / "none.csv"
    yield tmp_path / "x.xlsx"
    yield tmp_path


def test_files(tmp_path):
    found = {}
    for path in files(tmp_path):
        for reader in (gf.read_signal, gf.read_model, gf.load_scene, gf.StiffnessCurve.from_csv):
            name = getattr(reader, "__qualname__", str(reader))
            found[f"{name} {path.name}"] = judged(lambda p=path, r=reader: r(p), [path.name.split(".")[0], "no format", "scene"])
    counts, wrong = tally(found)
    assert len(found) == told("files of every format")
    assert counts == {CLEAR: len(found)}, wrong


def commands(tmp_path):
    """Command lines that cannot be, with the words an answer must hold."""
    bad = str(tmp_path / "none" / "x.csv")
    numbers = ["nan", "inf", "-1", "0", "x", ""]
    scene = "planetary_pitting"
    for verb in ("stiffness", "compare", "dynamics", "render"):
        out = ["-o", str(tmp_path / "x.png")] if verb == "render" else []
        for name in ("nope", "", "/", "none.toml", "planetary pitting"):
            yield [verb, name, *out], ["scene"]
        yield [verb, scene, "--case", "nope", *out], ["case"]
        yield [verb], ["required"]
        yield [verb, scene, "--nothing", *out], ["unknown argument"]
    for verb in ("stiffness", "compare", "render"):
        out = ["-o", str(tmp_path / "x.png")] if verb == "render" else []
        yield [verb, scene, "--pair", "nope", *out], ["pair"]
        for value in [*numbers, "1e-9", "300", "1e9"]:
            yield [verb, scene, "--refine", value, *out], ["refine"]
    for verb in ("stiffness", "compare"):
        for value in [*numbers, "1000000", "2.5"]:
            yield [verb, scene, "--phases", value], ["phases"]
        for value in ("", bad, "x.xlsx", "x", str(tmp_path)):
            yield [verb, scene, "--plot", value], ["file name", "no format", "cannot write"]
    for value in [*numbers, "1e7", "1e30"]:
        yield ["stiffness", scene, "--force", value], ["force"]
    for value in ("", bad, "x.xlsx", "x", str(tmp_path), "/proc/x.csv"):
        yield ["stiffness", scene, "-o", value], ["file name", "no format", "cannot write"]
        yield ["dynamics", scene, "-o", value], ["file name", "no format", "cannot write"]
        yield ["render", scene, "-o", value], ["file name", "no format", "cannot write"]
    for value in ("", "Ritz", "fem", "textbook,ritz"):
        yield ["stiffness", scene, "--method", value], ["method"]
    for method in ("textbook", "herringbone_article", "coupled"):
        yield ["stiffness", scene, "--method", method, "--error"], ["error"]
        yield ["stiffness", scene, "--method", method, "--refine", "2"], ["refine"]
    for value in numbers[:4]:
        yield ["dynamics", scene, "--duration", value], ["duration"]
    yield ["dynamics", scene, "--contact", "soft"], ["contact"]
    yield ["compare", scene, "--cases", "--case", "mild"], ["cases"]
    yield ["compare", scene, "--model", str(tmp_path / "none.csv")], ["cannot read", "none.csv"]
    yield ["signal", str(tmp_path / "none.csv")], ["cannot read"]
    yield ["signal", str(tmp_path)], ["no records"]
    yield ["signal", "x.xlsx"], ["no format"]
    yield [], ["required"]
    yield ["stifness", scene], ["unknown choice"]
    for value in ("nan", "inf", "x"):
        yield ["render", scene, "--phase", value, "-o", str(tmp_path / "x.png")], ["phase"]


def test_command_lines(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = {" ".join(map(repr, line)): judged_command(line, words) for line, words in commands(tmp_path)}
    counts, wrong = tally(found)
    assert len(found) == told("command lines")
    assert counts == {CLEAR: len(found)}, wrong
    assert [path.name for path in tmp_path.iterdir()] == []
