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
    """(claim, whether it holds, numbers) for what the formulas do on these synthetic lines."""
    s0, s1 = found[..., 0], found[..., 1]
    rises = [bool((np.diff(s0[i], axis=0) > 0.1).all()) for i in range(len(LEAN))]
    fault = (s1[:, -1] / s1[:, 0]).mean(axis=1)[0] - 1
    impact = (s1[:, :, -1] / s1[:, :, 0]).mean(axis=1)[0] - 1
    edge = F_M + F_FAULT
    beyond = sorted(value for row in PRINTED.values() for value in row if value > edge)
    yield (
        "S0's formula rises with the sidebands",
        all(rises),
        f"only {sum(rises)} of {len(LEAN)}: it follows the lean of the sidebands",
    )
    yield (
        "S0's printed values follow from its definition",
        not beyond,
        f"{beyond} Hz lie beyond {edge:g} Hz, the end of the sum",
    )
    yield "S1's formula rises with the sidebands", bool((np.diff(s1, axis=1) > 0).all()), f"mild to severe {100 * fault:+.0f} %"
    yield (
        "S1's formula hardly follows impacts",
        bool(abs(impact) < 0.1 * fault),
        f"none to strong {100 * impact:+.0f} %: their sidebands lie inside the sum",
    )


def section():
    """Tables of the page."""
    found = study()
    lines = [
        f"| sidebands | severity | {' | '.join(f'{form}, impacts {name}' for form in ('S0', 'S1') for name in IMPACT)} |",
        "|---|---|" + "---|" * 2 * len(IMPACT),
    ]
    for i, lean in enumerate(LEAN):
        for j, severity in enumerate(SEVERITY):
            cells = [f"{value:.1f}" for value in found[i, j, :, 0]] + [f"{value:.3f}" for value in found[i, j, :, 1]]
            lines.append(f"| {lean} | {severity} | {' | '.join(cells)} |")
    lines += ["", "Only the size of the sidebands changes:", "", "| property | verdict | why |", "|---|---|---|"]
    lines += [f"| {claim} | {'holds' if holds else 'does not hold'} | {why} |" for claim, holds, why in verdicts(found)]
    return [*lines, ""]
