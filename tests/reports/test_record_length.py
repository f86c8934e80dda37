"""Length of the vibration record of a report."""

import pytest

import gearfe as gf
from gearfe.reports import findings


@pytest.mark.parametrize(("name", "stated", "used"), [
    ("phm2009_spur", None, [None]), ("planetary_pitting", None, [0.2]), ("phm2009_spur", 0.7, [0.7]), ("phm2009_spur", 0, []),
])  # fmt: skip
def test_a_gearbox_is_recorded_until_its_damage_is_resolved(monkeypatch, name, stated, used):
    """At 10 Hz of the 48-tooth gear, 0.2 s have bins that cover its sidebands. A length of None resolves them."""
    asked = []
    for part in ("compare", "_tooth"):
        monkeypatch.setattr(findings, part, lambda *_, **__: None)
    monkeypatch.setattr(findings, "responses", lambda *_, duration, **__: asked.append(duration))
    monkeypatch.setattr(findings, "analysis", lambda _: "lines")
    found = findings.find(gf.load_scene(name), duration=stated)
    assert asked == used
    assert found.vibration == ("lines" if used else None)
