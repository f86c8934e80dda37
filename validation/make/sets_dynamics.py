"""A part of the page `sets`: the machines of the articles with the stiffness that their meshes have in the set."""

import math
from dataclasses import replace
from unittest.mock import patch

import numpy as np

import gearfe as gf
from gearfe.planetary_sets.standing import standing

from ..shared.joint_inputs import Draw
from ..shared.kept_rows import kept, stored
from ..shared.simulated import amplitude, record, scene, signal, spectrum
from . import compound_planetary as compound
from . import herringbone_runs as herringbone
from . import planetary_repeats as repeats
from . import planetary_runs as planetary

TABLE, PHASES = "sets_machines", 64
ALONE, TOGETHER = "alone", "in the set"
QUIET = Draw("herringbone_machine", 0, (("noise", 1e-9),))  # all that an article does not print as its scene assumes it
SIMPLE = ("sun_planet{}", "planet_ring{}")
NAMES = {  # meshes of each machine: with the sun, with the ring; of several simple stages or halves
    "planetary_pitting": (SIMPLE,),
    "compound_planetary": (("sun1_p{}", "p{}_ring"),),
    "herringbone": tuple(tuple(f"{one}{half}" for one in SIMPLE) for half in "LR"),
}
RING = {"compound_planetary": "planet_ring_1"}  # pair of the ring, where it is another
PADS = (3, 6)
PAD = 5.0  # mm
FINE, FINE_SECONDS = 256 * 280.0, 1.5  # Hz, s: nothing folds; whole turns of the sun and of the pads
SPECTRUM = {"planetary_pitting": "force sun_planet1", "compound_planetary": "force sun1_p1", "herringbone": "force sun_planet1L"}
MEANT = {"planetary_pitting": "S0, S1", "compound_planetary": "S2", "herringbone": "S4"}
INTRO = """
## What it does to the machines of the articles

Each machine is simulated twice by the code of its page: with its own curves, those of isolated pairs, and with what the set
adds to their compliance, 1/k in the set less 1/k alone, added at every mesh phase, in healthy and in damaged teeth. Both k are
of one plane-strain section of the scene's gears, with their bores and the rim of the ring held, under the forces that the
meshes have at rest. S0 and S1 are taken with linear stiffness: their own impact law has coefficients at one point of contact
and no mesh stiffness that a set could change. S4 is a trial: what is added is the mean over a cycle of the transverse section,
as wide as a half. S2 has it in stage 1 only: in its stage 2 planets mesh with each other, which the set does not know.
"""
HOW = """
Natural frequencies: the one that changes most, and how many of all by more than 1 %. Force: RMS of the force of the first mesh
about its mean, healthy. Sidebands: amplitude beside the mesh line at the fault's frequency, as the page of the machine takes
it; the healthy ones of S0 and S1 are harmonics that fold at the articles' rate. Bearings of 1e8 N/m are softer than any mesh, so
that modes in which bodies move on them hardly feel it; only modes of the meshes do. Far below these the mesh forces follow from
the torque, however stiff the meshes are.
"""


def set_of(name, force, ring="held"):
    """`PlanetaryCase` of a scene: of helical gears the transverse section, as wide as a half."""
    pairs = scene(name).pairs
    outer, inner = pairs["sun_planet"], pairs[RING.get(name, "planet_ring")]
    gears = [_section(gear, outer.face) for gear in (outer.pair.gear_1, outer.pair.gear_2, inner.pair.gear_2)]
    made = gf.PlanetarySet(*gears, scene(name).machine["n_planets"], outer.pair.a)
    return gf.PlanetaryCase(made, force, (*outer.materials, inner.materials[1]), ring=ring)


def _section(gear, face):
    """The spur gear with the transverse section of a gear, as wide as one half of a herringbone gear."""
    if not gear.beta:
        return gear
    turn = math.cos(gear.beta)
    sizes = {word: getattr(gear, word) * turn for word in ("x", "addendum", "dedendum", "tip_radius")}
    width = gear.b / 2 if face == "herringbone" else gear.b
    return replace(gear, beta=0.0, m_n=gear.m_n / turn, alpha_n=math.atan(math.tan(gear.alpha_n) / turn), b=width, **sizes)


def softer(made, name, found):
    """A machine with what a set adds to the compliance of isolated pairs [m/N], over the phase of each mesh."""
    case, meshes = found.meta["case"], {mesh.name: mesh for mesh in made.meshes}
    stand = standing(case.gears, np.array(case.angles), found.position)
    more = 1 / found.k - 1 / found.k_alone
    if scene(name).gears["sun"].beta:
        more = np.broadcast_to(more.mean(axis=1, keepdims=True), more.shape)
    for names in NAMES[name]:
        for inner, phases in enumerate((stand.outer, stand.inner)):
            for planet in range(case.planets):
                one = names[inner].format(planet + 1)
                meshes[one] = _added(meshes[one], phases[:, planet] % 1.0, more[inner, :, planet])
    return replace(made, meshes=tuple(meshes.values()))


def _added(mesh, phase, more):
    def added(curve):
        own = np.asarray(curve.phase)
        return gf.Samples(own, 1 / (1 / np.asarray(curve.k) + np.interp(own % 1.0, *_sorted(phase, more), period=1.0)))

    damage = tuple(replace(one, curve=added(one.curve)) for one in mesh.damage)
    return replace(mesh, stiffness=added(mesh.stiffness), damage=damage)


def _sorted(phase, values):
    order = np.argsort(phase)
    return phase[order], values[order]


def plain(name):
    """Healthy machine as its page builds it."""
    return {"planetary_pitting": lambda: planetary.linear(None), "compound_planetary": lambda: compound._made(None),
            "herringbone": lambda: herringbone.made(None)}[name]()  # fmt: skip


def curves(name):
    """`SetCurves` of a scene under the forces of its machine at rest."""
    own = plain(name).notes["mesh forces at rest [N]"]["sun_planet"]
    return gf.planetary_stiffness(set_of(name, own), PHASES)


def both(name):
    """Row of a machine: everything with isolated pairs and in the set."""
    found = curves(name)
    homes = {
        "planetary_pitting": (planetary, "linear"),
        "compound_planetary": (compound, "_made"),
        "herringbone": (herringbone, "made"),
    }
    home, maker = homes[name]
    old = getattr(home, maker)
    out = {"k": means(found)}
    out[ALONE] = heard(name)
    made = {}

    def changed(case):
        made[case] = made[case] if case in made else softer(old(case), name, found)
        return made[case]

    forget()
    with patch.object(home, maker, changed):
        out[TOGETHER] = heard(name)
    forget()
    return out


def means(found):
    """Mean stiffness of both kinds of mesh [N/m], of isolated pairs and in the set."""
    return {"alone": found.k_alone.mean(axis=(1, 2)).tolist(), "set": found.k.mean(axis=(1, 2)).tolist()}


def forget():
    """Drop the records that pages keep."""
    planetary.forget()
    for one in (
        *(getattr(compound, word) for word in ("_response", "_whole", "heard", "_noisy", "_kurtogram")),
        *(getattr(herringbone, word) for word in ("record_of", "heard", "clean", "found_in", "range_of", "section_of")),
    ):
        one.cache_clear()  # fmt: skip


def heard(name):
    """Natural frequencies [Hz], force [N], sidebands and statements of a machine as its page has it now."""
    sides, says, response = {
        "planetary_pitting": _pitting,
        "compound_planetary": _compound,
        "herringbone": _herringbone,
    }[name]()
    force = signal(response, SPECTRUM[name]).values
    return {
        "frequencies": gf.natural_frequencies(response.machine)[0].tolist(),
        "force": float(force.std()),
        "sidebands": {word: float(one) for word, one in sides.items()},
        "says": {word: bool(one) for word, one in says.items()},
    }


def _pitting():
    law = planetary.LINEAR
    sides = {f"{case} [N]": planetary.sidebands_of(case, law) for case in ("healthy", *repeats.CASES)}
    return sides, repeats.about_spectra(law) | repeats.about_impacts(law), planetary.record_of("healthy", False, law)


def _compound():
    mesh, fault = compound.frequencies()
    cases = {"sun 1, 80 % [rad/s^2]": ("sun 1", 0), "sun 2, 50 % [rad/s^2]": ("crack50", 1)}
    sides = {word: compound._sideband(case, mesh[stage], fault[stage]) for word, (case, stage) in cases.items()}
    return sides, compound.statements(), compound._response(None)


def _herringbone():
    _, _, mesh, fault = herringbone.speeds()
    cases = {f"{word} [rad/s^2]": herringbone.STATES[word] for word in ("crack 30 %", "6 pits", "case 4")}
    sides = {word: herringbone.line_of(case, mesh + fault, QUIET) for word, case in cases.items()}
    return sides, herringbone.about_motion(QUIET), herringbone.record_of(None, QUIET)


def padded(count):
    """Row: the healthy stage of S0 and S1 with its ring on rigid pads, k of whole periods of the set."""
    made = planetary.linear(None)
    own = made.notes["mesh forces at rest [N]"]["sun_planet"]
    case = set_of("planetary_pitting", own, gf.RimSupports(count, PAD))
    found = gf.planetary_stiffness(case, PHASES // 4, cycles=case.ring_gear.z // count)
    made = gf.with_set(made, found, ring="body")
    return {
        "k": [float(one) for one in (found.k[1].mean(), found.k[1].min(), found.k[1].max())],
        "passing": planetary.speeds()[2] * count / case.ring_gear.z,
        "healthy": _lines(made),
        "severe": _lines(planetary.linear("severe")),
        "frequencies": gf.natural_frequencies(made)[0].tolist(),
    }


def _lines(made):
    """Amplitudes of the force of a sun mesh at the fault's frequency below the mesh line, at it, and above [N]."""
    found = spectrum(signal(record(made, FINE_SECONDS, FINE, planetary.SETTLE), planetary.FORCE))
    mesh, fault = planetary.speeds()[2:]
    return [amplitude(found, mesh + side * fault) for side in (-1, 0, 1)]


def compute(again):
    """Rows of all machines, those missing or asked for computed."""
    for name in NAMES:
        kept(TABLE, name, lambda name=name: both(name), again)
    for count in PADS:
        kept(TABLE, f"ring on {count} pads", lambda count=count: padded(count), again)


def section():
    """Lines of the page."""
    rows = stored(TABLE)
    return [*INTRO.splitlines(), "", *_table(rows), *HOW.splitlines(), "", *_verdicts(rows), "", *_pads(rows)]


def _table(rows):
    lines = ["| quantity | article | alone | in the set | change |", "|---|---|---|---|---|"]
    for name, article in MEANT.items():
        row = rows[name]
        before, after = row[ALONE], row[TOGETHER]
        for kind, word in enumerate(("sun and planet", "planet and ring")):
            pair = (row["k"][one][kind] / 1e6 for one in ("alone", "set"))
            lines.append(_line(f"k {word}, section [N/um]", article, *pair))
        most, one, two, beyond = moved(before["frequencies"], after["frequencies"])
        told = f"natural frequency {most}, {beyond} by more than 1 % [Hz]"
        lines += [_line(told, article, one, two), _line("force, RMS [N]", article, before["force"], after["force"])]
        lines += [
            _line(f"sidebands, {word}", article, value, after["sidebands"][word])
            for word, value in before["sidebands"].items()
            if value > 1e-6 * max(before["sidebands"].values())
        ]
    return lines


def moved(before, after):
    """Which natural frequency changes most, ``"15 of 18"``; it before and after [Hz]; how many change by more than 1 %."""
    one, two = np.array(before), np.array(after)
    change = np.abs(two / np.where(one > 0, one, np.inf) - (one > 0))
    most = int(np.argmax(change))
    return f"{most + 1} of {one.size}", float(one[most]), float(two[most]), int((change > 0.01).sum())


def largest():
    """Largest change of a natural frequency of a machine [%], verdicts that change, and of how many."""
    rows = stored(TABLE)
    parts = [moved(*(rows[name][part]["frequencies"] for part in (ALONE, TOGETHER)))[1:3] for name in NAMES]
    found, count = changed(rows)
    return max(abs(100 * (two / one - 1)) for one, two in parts), len(found), count


def _line(told, article, before, after):
    return f"| {told} | {article} | {before:.4g} | {after:.4g} | {100 * (after / before - 1):+.1f} % |"


def changed(rows):
    """Statements by article whose verdict is another one in the set, and how many there are."""
    out, count = [], 0
    for name, article in MEANT.items():
        before, after = (rows[name][part]["says"] for part in (ALONE, TOGETHER))
        count += len(before)
        out += [
            f"{article}, '{word}': {'holds' if after[word] else 'does not hold'} in the set"
            for word, held in before.items()
            if after[word] != held
        ]
    return out, count


def _verdicts(rows):
    found, count = changed(rows)
    if not found:
        return [f"None of {count} statements on these signals changes its verdict."]
    return [f"{len(found)} of {count} statements on these signals change their verdict: {'; '.join(found)}."]


def _pads(rows):
    lines = [
        "**Supports make lines of a fault.** The healthy stage of S0 and S1 with its ring on rigid pads of "
        f"{PAD:g} mm (`gf.with_set`, k over whole periods of the set) has lines beside 280 Hz, where planets pass pads; some of "
        "them stand where a fault of the sun is looked for. Amplitudes of the force of a sun mesh, beside those of severe pits "
        "with the ring held, sampled so finely that nothing folds:",
        "",
        "| stage | k planet-ring, mean (least to largest) [N/um] | natural frequency that changes most [Hz] | pads passed [Hz] | "
        "240 Hz [N] | 280 Hz [N] | 320 Hz [N] |",
        "|---|---|---|---|---|---|---|",
    ]
    for count in PADS:
        row = rows[f"ring on {count} pads"]
        mean, least, most = (one / 1e6 for one in row["k"])
        force = " | ".join(f"{one:.3g}" for one in row["healthy"])
        which, before, after, _ = moved(rows["planetary_pitting"][ALONE]["frequencies"], row["frequencies"])
        told = f"{which}: {before:.4g} to {after:.4g}"
        lines.append(
            f"| healthy, {count} pads | {mean:.0f} ({least:.0f} to {most:.0f}) | {told} | {row['passing']:.4g} | {force} |"
        )
    force = " | ".join(f"{one:.3g}" for one in rows[f"ring on {PADS[0]} pads"]["severe"])
    return [*lines, f"| severe pits, held | {rows['planetary_pitting']['k']['alone'][1] / 1e6:.0f} | | | {force} |"]
