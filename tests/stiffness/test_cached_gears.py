"""Solved gears are read again, from memory and disk, and only for the same gear."""

import math
from dataclasses import replace
from functools import partial

import pytest
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements import fe
from gearfe.stiffness import cache

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "beta": math.radians(16), "b": 1.0}
PAIR = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **RACK), gf.Gear(z=27, r_bore=12.0, **RACK))
stiffness = partial(gf.mesh_stiffness, face="spur")  # transverse sections


@pytest.fixture
def counted(monkeypatch, tmp_path):
    """An empty cache folder, and a list that grows with every healthy and cracked solve."""
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    cache.clear()
    calls = []
    for name in ("flexibility", "damaged_flexibility"):
        real = getattr(fe, name)
        monkeypatch.setattr(fe, name, lambda *a, _real=real, _name=name, **k: (calls.append(_name), _real(*a, **k))[1])
    yield calls
    cache.clear()


def test_only_what_changed_is_solved_again(counted):
    run = {"phases": [0.3], "method": "fe", "refine": 0.3}
    stiffness(PAIR, 127.0, STEEL, **run)
    assert counted == ["flexibility"] * 2
    one = stiffness(PAIR, 127.0, STEEL, damage={"pinion": [gf.Crack(level=0.3)]}, **run)
    assert counted[2:] == ["damaged_flexibility"]
    cache.clear()  # a new process: from disk
    again = stiffness(PAIR, 127.0, STEEL, damage={"pinion": [gf.Crack(level=0.3)]}, **run)
    assert counted[3:] == []
    assert again.k == one.k


def test_a_wrong_hit_is_impossible(counted, tmp_path):
    run = {"phases": [0.3], "method": "fe", "refine": 0.3}
    stiffness(PAIR, 127.0, STEEL, **run)
    other = gf.GearPair(replace(PAIR.gear_1, r_bore=9.0000001), PAIR.gear_2)
    stiffness(other, 127.0, STEEL, **run)
    stiffness(PAIR, 127.0, gf.Material(E=207e3, nu=0.3000001), **run)
    assert counted == ["flexibility"] * 5
    # a file whose name matches but whose contents belong to another gear, or are damaged, is not used
    files = sorted(tmp_path.glob("*.gear"))
    first, second = (f.read_bytes() for f in files[:2])
    files[0].write_bytes(second)
    files[1].write_bytes(first[:100])
    cache.clear()
    for pair, material in ((PAIR, STEEL), (other, STEEL), (PAIR, gf.Material(E=207e3, nu=0.3000001))):
        stiffness(pair, 127.0, material, **run)
    assert counted[5:] == ["flexibility"] * 2
