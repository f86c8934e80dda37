"""The frozen page `sideband_centroid`: the sideband centroid SC of S0 and S1, in both definitions, on synthetic lines."""

import numpy as np

import gearfe as gf
from gearfe.signal import indicators as ind

RATE, SECONDS = 1000.0, 10.0  # S0: 10 s, which sets the distance of the bins
F_M, F_FAULT, F_IMPACT = 280.0, 40.0, 2.0  # Hz; the articles print no frequency of their impacts
SEVERITY = {"mild": 0.1, "moderate": 0.2, "severe": 0.4}  # amplitude of the fault sidebands, of the mesh line
IMPACT = {"none": 0.0, "weak": 0.1, "strong": 0.3}  # amplitude of the first impact sidebands, of the mesh line
LEAN = {"symmetric": 0.0, "leaning up": 0.5, "leaning down": -0.5}
PRINTED = {"S0, simulated": (285.3, 312.7, 349.8), "S0, measured": (290.1, 315.4, 352.9)}


def family(severity, impact, lean):
    """Mesh line of amplitude 1 with fault sidebands, the upper ``1 + lean`` times `severity`, and impact sidebands."""
    t = np.arange(round(RATE * SECONDS)) / RATE
    lines = {F_M: 1.0, F_M - F_FAULT: severity * (1 - lean), F_M + F_FAULT: severity * (1 + lean), F_FAULT: severity / 2}
    lines |= {F_M + k * F_IMPACT: impact / abs(k) for k in range(-5, 6) if k}
    noise = 0.006 * np.random.default_rng(0).standard_normal(t.size)
    return gf.Signal(noise + sum(a * np.cos(2 * np.pi * f * t + f) for f, a in lines.items()), RATE, "N")


def study():
    """SC by S0 [Hz] and by S1 [mN]; shape (leans, severities, impacts, 2)."""
    out = np.empty((len(LEAN), len(SEVERITY), len(IMPACT), 2))
    for i, lean in enumerate(LEAN.values()):
        for j, severity in enumerate(SEVERITY.values()):
            for k, impact in enumerate(IMPACT.values()):
                found = gf.spectrum(family(severity, impact, lean))
                out[i, j, k, 0] = ind.sideband_centroid_s0(found, F_M, F_FAULT)
                out[i, j, k, 1] = 1e3 * ind.sideband_centroid_s1(found, F_M, F_FAULT)
    return out


def verdicts(found):
    """Whether S0's form rises with the sidebands; has its printed values; S1's rises; S1's hardly follows impacts."""
    s0, s1 = found[..., 0], found[..., 1]
    fault, impact = ((most / least).mean(axis=1)[0] - 1 for most, least in ((s1[:, -1], s1[:, 0]), (s1[..., -1], s1[..., 0])))
    printed = max(value for row in PRINTED.values() for value in row) <= F_M + F_FAULT
    return [(np.diff(s0, axis=1) > 0.1).all(), printed, (np.diff(s1, axis=1) > 0).all(), abs(impact) < 0.1 * fault]


def rows(found):
    """Rows of the page."""
    for i, lean in enumerate(LEAN):
        for j, severity in enumerate(SEVERITY):
            cells = [f"{value:.1f}" for value in found[i, j, :, 0]] + [f"{value:.3f}" for value in found[i, j, :, 1]]
            yield f"| {lean} | {severity} | {' | '.join(cells)} |"
