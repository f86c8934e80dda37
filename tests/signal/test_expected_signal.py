"""A list in place of a signal is answered with the way to make one."""

import pytest

import gearfe as gf

pytestmark = pytest.mark.quick


@pytest.mark.parametrize(
    "function",
    [
        gf.spectrum,
        gf.order_spectrum,
        gf.synchronous_average,
        gf.spectrogram,
        gf.cepstrum,
        gf.fast_kurtogram,
        gf.squared_envelope_spectrum,
    ],
)
def test_a_list_is_answered_with_the_way_to_make_a_signal(function):
    with pytest.raises(TypeError, match=r"signal = \[1.0, 2.0, 3.0\], but give a Signal: gf.Signal\(values, rate, unit\)"):
        function([1.0, 2.0, 3.0])
