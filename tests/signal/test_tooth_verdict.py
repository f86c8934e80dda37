"""The verdict on a tooth: seen where a tooth is hurt, at its angle, and rarely where none is."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.vibration import analyse
from gearfe.signal.tooth_verdict import ToothVerdict, tooth_verdict

TEETH, TURNING, RATE = 23, 20.0, 10240.0


def record(seed, impulse=0.0, at=3.8, seconds=2.0, *, bound=True):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * TURNING * np.arange(round(seconds * RATE)) / RATE
    x = np.cos(TEETH * angle) + 0.3 * np.cos(angle) + 0.2 * rng.standard_normal(angle.size)
    place = np.mod(angle - at + math.pi, 2 * np.pi) - math.pi
    turns = np.floor(angle / (2 * np.pi))
    burst = impulse * np.exp(-((place / 0.04) ** 2)) * np.cos(90 * place)
    x += burst if bound else np.where(turns == 7, 30 * burst, 0.0)
    return gf.Signal(x, RATE, "m/s^2", shaft_frequency=TURNING)


def test_a_hurt_tooth_is_found_at_its_angle():
    found = tooth_verdict(record(1, impulse=1.0), TEETH, record(2))
    assert found.level == "likely"
    assert_allclose(found.angle, 3.8, atol=0.03)
    assert "at 218 degrees" in found.told(TEETH)
    assert f"FM4 {found.FM4:.3g} against {found.healthy:.3g}" in found.told(TEETH)


def test_rounding_errors_of_a_healthy_record_do_not_hide_a_fault():
    """A simulated healthy record has a difference signal of rounding errors, whose FM4 is large and states nothing."""
    angle = 2 * np.pi * TURNING * np.arange(round(2 * RATE)) / RATE
    errors = 1e-6 * (np.abs(np.mod(angle - 1.0 + math.pi, 2 * np.pi) - math.pi) < 0.02)
    healthy = gf.Signal(np.cos(TEETH * angle) + errors, RATE, "N", shaft_frequency=TURNING)
    found = tooth_verdict(record(1, impulse=1.0), TEETH, healthy)
    assert found.healthy > found.FM4
    assert found.level == "likely"
    large = gf.Signal(healthy.values + 1e7 * errors, RATE, "N", shaft_frequency=TURNING)
    assert tooth_verdict(record(1, impulse=1.0), TEETH, large).level == "not seen", "deviations as large as the fault"


def test_one_impulse_of_a_record_is_no_likely_fault():
    found = tooth_verdict(record(1, impulse=1.0, bound=False), TEETH)
    assert found.level == "possible"
    assert "record longer" in found.told(TEETH)


def test_healthy_gears_are_not_called_faulty():
    levels = [tooth_verdict(record(seed), TEETH, record(1000 + seed)).level for seed in range(40)]
    assert levels == ["not seen"] * 40
    assert "rests on FM4 alone" in tooth_verdict(record(0), TEETH, record(1000)).told(TEETH)


def test_the_envelope_stands_next_to_the_verdict():
    sound, hurt = record(1), record(2, impulse=1.0)
    assert (
        "lines of the fault: fault frequency at"
        in analyse({"sound": sound, "hurt": hurt}, TEETH * TURNING, TURNING).beside_verdict()
    )
    assert analyse({"a": sound, "b": record(3)}, TEETH * TURNING, TURNING).beside_verdict() == " The envelope shows no fault."
    assert not analyse({"a": sound}, TEETH * TURNING).beside_verdict()


@pytest.mark.parametrize(("turning", "teeth"), [(1.003 * TURNING, TEETH), (TURNING, 31)])
def test_a_smeared_average_and_that_of_another_gear_have_no_verdict(turning, teeth):
    wrong = replace(record(1, impulse=1.0), shaft_frequency=turning)
    with pytest.raises(ValueError, match="smeared, or is not of a gear of"):
        tooth_verdict(wrong, teeth)


def test_a_verdict_needs_revolutions():
    with pytest.raises(ValueError, match="3 revolutions, but a verdict needs 4"):
        tooth_verdict(record(1, seconds=0.16), TEETH)


def test_a_possible_fault_states_which_half_of_the_record_differs():
    """Equal angles of both halves are no reason for the verdict."""
    verdict = ToothVerdict("possible", FM4=8.7, limit=7.3, healthy=3.1, angle=1.0, apart=0.0, revolutions=50)
    assert "but FM4 of one half of the record is below the limit" in verdict.told(23)
    assert "the largest impulse moves by 57 degrees" in verdict._replace(apart=1.0).told(23)
