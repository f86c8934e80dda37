"""Every gear indicator of a tone and one impulse, worked out from its formula by hand and by plain sums, no transform."""

import math

from numpy.testing import assert_allclose

import gearfe as gf

N, Z, TONE, KNOCK = 64, 8, 2.0, 4.0  # samples, teeth, amplitudes of 2 cos(8 theta) and of the impulse at sample 0
SHAFT, MESH, BESIDE = (1, 2), (8, 16, 24, 32), (7, 9, 15, 17, 23, 25, 31)


def left(orders):
    """The impulse without its mean and these orders: each takes a cosine of 2/64 of it, order 32 one of 1/64."""
    out = []
    for i in range(N):
        taken = sum((1 if k == 32 else 2) * math.cos(2 * math.pi * k * i / N) for k in orders)
        out.append(KNOCK * ((i == 0) - (1 + taken) / N))
    return out


def moment(values, power):
    return sum(v**power for v in values) / N


def test_every_indicator_of_a_tone_and_an_impulse():
    x = [TONE * math.cos(2 * math.pi * Z * i / N) + KNOCK * (i == 0) for i in range(N)]
    got = gf.gear_indicators(x, Z)
    # from peak 2 + 4 to trough -2, over the mesh orders 2 + 8/64 and three of 8/64
    assert_allclose(got["FM0"], 8 / 2.5)
    # 26 of 64 parts of the impulse are regular: 1 mean, 4 of the shaft, 7 of the mesh, 14 beside it; all: 128 + 32 - 16/64
    assert_allclose(got["energy ratio"], math.sqrt(9.5 / (159.75 - 9.5)))
    assert_allclose(got["sideband level factor"], 2 * 8 / 64 / math.sqrt(159.75 / 64))
    difference, residual = left(SHAFT + MESH + BESIDE), left(SHAFT + MESH)
    assert_allclose([N * moment(difference, 2), N * moment(residual, 2)], [16 * 38 / 64, 16 * 52 / 64])
    for name, power in (("FM4", 4), ("M6A", 6), ("M8A", 8)):
        assert_allclose(got[name], moment(difference, power) / moment(difference, 2) ** (power // 2), err_msg=name)
    assert_allclose(got["NA4"], moment(residual, 4) / moment(residual, 2) ** 2)
    band = [[(TONE if k == Z else 0.0) + 2 * KNOCK / N for k in range(5, 12)], range(5, 12)]  # orders between 4 and 12
    envelope = [
        math.hypot(*(sum(a * turn(2 * math.pi * k * i / N) for a, k in zip(*band, strict=True)) for turn in (math.cos, math.sin)))
        for i in range(N)
    ]
    mean = sum(envelope) / N
    swing = [one - mean for one in envelope]
    assert_allclose(got["NB4"], moment(swing, 4) / moment(swing, 2) ** 2)


def test_na4_takes_the_mean_variance_of_all_records():
    """A knock three times as strong after two equal records: 3**4 over ((9 + 1 + 1) / 3)**2 times the kurtosis of one."""
    calm, hurt = ([TONE * math.cos(2 * math.pi * Z * i / N) + a * (i == 0) for i in range(N)] for a in (KNOCK, 3 * KNOCK))
    residual = left(SHAFT + MESH)
    one = moment(residual, 4) / moment(residual, 2) ** 2
    assert_allclose(gf.gear_indicators(hurt, Z, before=[calm, calm])["NA4"], one * 81 / (11 / 3) ** 2)
