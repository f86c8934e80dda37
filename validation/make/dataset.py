"""A part of the page `detection`: a small classifier trained on a simulated data set. Needs scikit-learn."""

import tempfile
from pathlib import Path

import numpy as np

import gearfe as gf

from ..shared.kept_rows import kept

SEVERITIES = [0.05, 0.1, 0.2, 0.4]
PLAN = {
    "title": "cracks of the sun among machines that differ",
    "scene": "planetary_pitting",
    "seed": 16,
    "repeats": 12,
    "healthy": 36,
    "window": {"seconds": 0.2, "count": 3, "rate_Hz": 12800.0, "harmonics": 5},
    "operation": {"speed_rpm": [800.0, 1000.0], "torque_Nm": [100.0], "spread": 0.03},
    "fault": [{"kind": "crack", "gear": "sun", "severity": SEVERITIES}],
    "sensor": [{"name": "ring", "channel": "ring.x acceleration", "noise": [0.0, 0.3, 1.0]}],
    "scatter": {
        "machine.profile_error_um": {"uniform": [0.2, 1.0]},
        "machine.runout_um": {"uniform": [5.0, 20.0]},
        "machine.misplaced_um": {"uniform": [0.0, 20.0]},
    },
    "split": {"train": 0.5, "validation": 0.25, "test": 0.25},
}
ALARMS = 0.05  # of healthy machines taken for faulty, set on the validation side


def section(again=False):
    """Lines of the page."""
    found = kept("detection", "classifier", classified, again)
    return [
        "## By vibration, with a classifier",
        "",
        "`gf.dataset` on the machine of `planetary_pitting`, a sensor on the ring:",
        f"{found['machines']} machines, {found['healthy']} of them healthy, that differ in speed and torque (3 % up and down),",
        "run-out (5 to 20 um), profile error (0.2 to 1 um) and the place of a planet (up to 20 um), each with three windows of",
        "0.2 s. Half of the machines train a random forest on line amplitudes, envelope lines and indicators of single windows;",
        f"a quarter sets the threshold at {100 * ALARMS:.0f} % false alarms of machines; on the rest:",
        "",
        *found["table"],
        "",
        "A machine is judged by the mean over its windows. In brackets: 95 % intervals for that many machines (Wilson). AUC is",
        "the chance that a cracked machine is rated above a healthy one; 0.5 is a guess. The loss is the largest loss of mesh",
        "stiffness.",
        "",
        "**It is easy here, and a bound.** The scatter of these machines makes lines at turning and mesh frequencies only, so",
        "that lines at the frequency of the fault are the crack's alone until noise covers them. Real flanks differ from tooth",
        "to tooth and put lines of their own there; rates on measured signals will be lower. Nothing here says how it would do",
        "on a real gearbox, whose path to the sensor, other machinery and scatter differ; with less scatter the same cracks are",
        "easier to find.",
        "",
        "What leakage would have claimed:",
        *found["leak"],
        "Where both agree, the classes lie so far apart that to know the machine adds nothing.",
    ]


def classified():
    """The tables, as lines."""
    with tempfile.TemporaryDirectory() as folder:
        made = gf.dataset(PLAN, Path(folder) / "set", workers=1, progress=said)
        labels = made.labels()
        losses = labels.groupby("severity")["loss_max"].mean()
        table, leak = _table(made, losses), _leak(made)
    healthy = labels.query("severity == 0")["condition"].nunique()
    return {"machines": labels["condition"].nunique(), "healthy": healthy, "table": table, "leak": leak}


def said(done, total):
    """Print how far it is."""
    if done % 20 == 0:
        print(f"{done} of {total}", flush=True)


def features(signal, label):
    """Numbers of one window: logarithms of lines and envelope lines, indicators. The speed is known, as from a tachometer."""
    one = gf.Signal(signal.astype(float), label["rate_Hz"], label["unit"])
    mesh, fault = label["mesh_Hz"], label["fault_Hz"]
    lines = gf.find_lines(gf.spectrum(one), gf.expected_lines(mesh, fault, count=2, harmonics=3))
    hull = gf.squared_envelope_spectrum(one)
    beats = gf.find_lines(hull, {f"{n}": n * fault for n in (1, 2, 3)} | {f"turn {n}": n * label["turning_Hz"] for n in (1, 2)})
    amplitudes = [amplitude for _, amplitude in (*lines.values(), *beats.values())]
    shape = [one.indicators()[name] for name in ("kurtosis", "crest factor", "shape factor")]
    return [*np.log10(np.maximum(amplitudes, 1e-12)), np.log10(signal.std()), *shape]


def learned(train, others):
    """Rating of the windows of `others` by a forest trained on `train`: each (features, faulty)."""
    from sklearn.ensemble import RandomForestClassifier

    forest = RandomForestClassifier(300, min_samples_leaf=3, class_weight="balanced", random_state=0, n_jobs=1)
    forest.fit(*train)
    return [forest.predict_proba(one)[:, 1] for one in others]


def of_noise(made, noise):
    """Features and labels of all windows with a level of noise."""
    signals, labels = made.windows({"noise": noise})
    rows = labels.to_dict("records")
    return np.array([features(signal, row) for signal, row in zip(signals, rows, strict=True)]), labels


def by_machine(labels, rating):
    """Mean rating, severity and number of each machine."""
    return labels.assign(rating=rating).groupby("condition").agg(rating=("rating", "mean"), severity=("severity", "first"))


def _table(made, losses):
    heads = [f"level {s:g} (loss {100 * losses[s]:.1f} %)" for s in SEVERITIES]
    rows = [["noise rms [m/s2]", "signal over noise", "false alarms", *heads], ["---"] * (3 + len(heads))]
    for noise in PLAN["sensor"][0]["noise"]:
        found, labels = of_noise(made, noise)
        side = {name: (labels["side"] == name).to_numpy() for name in ("train", "validation", "test")}
        faulty = (labels["severity"] > 0).to_numpy()
        train = found[side["train"]], faulty[side["train"]]
        watched, judged = learned(train, (found[side["validation"]], found[side["test"]]))
        calm = by_machine(labels[side["validation"]], watched).query("severity == 0")["rating"]
        limit = float(np.quantile(calm, 1 - ALARMS))
        tested = by_machine(labels[side["test"]], judged)
        healthy = tested.query("severity == 0")["rating"].to_numpy()
        cells = []
        for severity in SEVERITIES:
            own = tested["rating"][np.isclose(tested["severity"], severity)].to_numpy()
            cells.append(f"{share(own > limit)}, AUC {np.mean(own[:, None] > healthy[None, :]):.2f}")
        ratio = "none added" if not noise else f"{labels['snr_dB'].median():.0f} dB"
        rows.append([f"{noise:g}", ratio, share(healthy > limit), *cells])
    return [f"| {' | '.join(row)} |" for row in rows]


def share(hits):
    """Share of hits in percent with its 95 % interval."""
    n, p, z = hits.size, hits.mean(), 1.96
    middle, width = (p + z * z / (2 * n)) / (1 + z * z / n), z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return f"{100 * p:.0f} % ({max(0.0, 100 * (middle - width)):.0f} to {min(100.0, 100 * (middle + width)):.0f})"


def _leak(made):
    """The same forest with windows split at random, so that those of one machine lie on both sides."""
    from sklearn.metrics import balanced_accuracy_score

    noise = PLAN["sensor"][0]["noise"][1]
    found, labels = of_noise(made, noise)
    faulty = (labels["severity"] > 0).to_numpy()
    honest = (labels["side"] == "train").to_numpy()
    test = (labels["side"] == "test").to_numpy()
    mixed = np.random.default_rng(0).permutation(honest[honest | test])
    scores = []
    every = np.flatnonzero(honest | test)
    for train, other in ((np.flatnonzero(honest), np.flatnonzero(test)), (every[mixed], every[~mixed])):
        (rating,) = learned((found[train], faulty[train]), (found[other],))
        scores.append(balanced_accuracy_score(faulty[other], rating > 0.5))
    return [
        f"balanced accuracy over single windows (noise {noise:g} m/s2), trained on as many: {100 * scores[0]:.1f} % if all",
        f"windows of a machine lie on one side, {100 * scores[1]:.1f} % if windows are dealt out at random.",
    ]
