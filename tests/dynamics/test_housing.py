"""Housing sensor: lines of forces known in closed form, and what equal planets leave of them."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

F_M, F_C, RATE, SECONDS = 280.0, 10 / 3, 4000.0, 3.0


def response(forces, notes=None):
    """A response of three planets with the forces of their ring meshes as functions of time."""
    time = np.arange(round(RATE * SECONDS)) / RATE
    channels = {f"force planet_ring{i + 1}": force(time) for i, force in enumerate(forces)}
    meshes = tuple(SimpleNamespace(name=name.removeprefix("force ")) for name in channels)

    class Made(gf.Response):
        def __init__(self):
            object.__setattr__(self, "time", time)

        stated = {"carrier frequency [Hz]": F_C} if notes is None else notes
        machine = SimpleNamespace(turned=lambda t: t, meshes=meshes, notes=stated)

        def __getitem__(self, name):
            return channels[name]

    return Made()


def amplitudes(signal, frequencies):
    """Amplitudes of whole-period lines by the discrete sum itself."""
    time = np.arange(signal.values.size) / signal.rate
    return [2 * abs(np.mean(signal.values * np.exp(-2j * np.pi * f * time))) for f in frequencies]


@pytest.mark.parametrize(
    ("sizes", "lags", "want"),
    [
        ((8, 0, 0), (0, 0, 0), [2.0, 4.0, 2.0, 0.0]),
        ((1, 1, 1), (0, 0, 0), [0.0, 1.5, 0.0, 0.0]),
        ((1, 1, 1), (0, 1, 2), [0, 0, 0.75, 0]),
    ],
    ids=["one planet", "equal planets in phase", "meshes a third of a cycle apart"],
)
def test_carrier_sidebands_are_those_of_the_windowed_cosines(sizes, lags, want):
    """Products of (1 + cos) / 2 and cosines: one planet has both sidebands, three in phase none, three a third apart one."""
    forces = [
        lambda t, size=size, lag=lag: size * np.cos(2 * np.pi * (F_M * t - lag / 3))
        for size, lag in zip(sizes, lags, strict=True)
    ]
    heard = gf.housing_signal(response(forces))
    assert heard.unit == "N"
    assert_allclose(amplitudes(heard, [F_M - F_C, F_M, F_M + F_C, F_M + 2 * F_C]), want, atol=1e-9)


def test_the_sensor_only_shifts_phases_and_the_nearest_planet_is_loudest():
    forces = [lambda t, p=p: np.full_like(t, float(p == 0)) for p in range(3)]
    heard = gf.housing_signal(response(forces), sensor=np.pi / 3)
    assert_allclose(heard.values[0], 0.75)
    assert np.argmax(heard.values[:1200]) == pytest.approx(RATE / F_C / 6, abs=1)


def test_what_cannot_be_heard_is_refused():
    made = response([lambda t: t] * 3, notes={})
    with pytest.raises(ValueError, match="give carrier"):
        gf.housing_signal(made)
    with pytest.raises(ValueError, match="planet_ring1"):
        gf.housing_signal(made, kind="sun_planet", carrier=1.0)
    with pytest.raises(ValueError, match="3 planets"):
        gf.housing_signal(made, carrier=1.0, planet_angles=[0.0])


def test_modes_of_the_housing_amplify_as_an_oscillator_does():
    """A steady force line comes out as its receptance times the squared frequency, in closed form."""
    frequency, mode = 50.0, (80.0, 0.05, 12.0)
    forces = [lambda t: 8 * np.cos(2 * np.pi * frequency * t)] * 3
    heard = gf.housing_signal(response(forces), window=np.ones_like, modes=[mode])
    assert heard.unit == "m/s^2"
    settled = gf.Signal(heard.values[round(RATE) :], RATE, "m/s^2")
    r = frequency / mode[0]
    want = 24 / mode[2] * r**2 / abs(1 - r**2 + 2j * mode[1] * r)
    assert_allclose(amplitudes(settled, [frequency])[0], want, rtol=2e-3)  # forces are straight between samples
    with pytest.raises(ValueError, match="half the rate"):
        gf.housing_signal(response(forces), modes=[(3000.0, 0.05, 1.0)])
