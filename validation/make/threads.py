"""A part of the page `sweeps`: threads of a caller change no bit and end no process; cost with threads of linear algebra."""

import json
import os
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from math import radians

import numpy as np

import gearfe as gf
from gearfe.core.threads import CHOSEN
from gearfe.flexibility.solved import SolvedGears
from gearfe.stiffness import cache

from ..shared.places import ROOT

METHODS = {"ritz": 4, "fe": 1}  # of the linear algebra's threads, and how often
THREADS = 8  # of a caller
STEEL = gf.Material(E=207e3, nu=0.3)
# who runs the threads, method, its options, new pairs, repetitions
RUNS = (
    ("ThreadPoolExecutor", "ritz", {}, 50, 6),
    ("ThreadPoolExecutor", "fe", {}, 10, 2),
    ("ThreadPoolExecutor", "ritz3d", {"order": 2}, 10, 2),
    ("dask.threaded", "ritz", {}, 50, 2),
    ("dask LocalCluster, processes=False", "ritz", {}, 50, 2),
)
IMPORTS = 5  # processes whose first import comes from all threads at once
FIRST = """
import random, sys, threading
import gearfe as gf
sys.setswitchinterval(1e-5)
start, failed = threading.Barrier(8), []
def work(seed):
    names = random.Random(seed).sample(gf.__all__, len(gf.__all__))
    start.wait()
    try:
        for name in names:
            getattr(gf, name)
    except BaseException as error:
        failed.append(repr(error))
threads = [threading.Thread(target=work, args=(seed,)) for seed in range(8)]
for one in threads: one.start()
for one in threads: one.join()
sys.exit("; ".join(failed) or 0)
"""


def pair():
    """A spur pair."""
    return gf.GearPair(*(gf.Gear(z=z, m_n=2.0, alpha_n=radians(20), b=20.0, r_bore=0.45 * z) for z in (18, 27)))


def measure():
    """Processor and clock seconds of a pair by each method, in this process."""
    out = {}
    for method, often in METHODS.items():
        one = {"material": STEEL, "method": method, "phases": 64, "cache": False}
        gf.mesh_stiffness(pair(), 4000.0, **one | {"phases": 1})  # imports
        cpu, clock = time.process_time(), time.perf_counter()
        for _ in range(often):
            gf.mesh_stiffness(pair(), 4000.0, **one)
        out[method] = [(time.process_time() - cpu) / often, (time.perf_counter() - clock) / often]
    return out


def new_pairs(count, seed):
    """Random spur pairs with a cracked pinion; every second has the wheel of the one before, so that threads meet at it."""
    rng, out = np.random.default_rng(seed), []
    for i in range(count):
        rack = {"m_n": 2.0, "alpha_n": radians(20), "b": 20.0}
        z, x, bore = int(rng.integers(18, 40)), rng.uniform(0.0, 0.4), rng.uniform(0.4, 0.8)
        pinion = gf.Gear(z=z, x=x, r_bore=bore * (z - 2.5 + 2 * x), **rack)
        if i % 2 == 0:
            wheel = gf.Gear(z=int(rng.integers(30, 60)), r_bore=rng.uniform(8.0, 20.0), **rack)
        out.append((gf.GearPair(pinion, wheel), gf.Crack(level=rng.uniform(0.1, 0.5))))
    return out


def stiffness(case, method, options):
    """Stiffness of a pair with its crack [N/m], four phases."""
    gears, crack = case
    return gf.mesh_stiffness(gears, 4000.0, STEEL, damage={"pinion": [crack]}, method=method, phases=4, **options).k


def over_threads(who, work, cases):
    """What `work` gives of each case, by as many threads as `THREADS`."""
    if who == "ThreadPoolExecutor":
        with ThreadPoolExecutor(THREADS) as pool:
            return list(pool.map(work, cases))
    if who == "dask.threaded":
        import dask

        return list(dask.compute(*(dask.delayed(work)(case) for case in cases), scheduler="threads", num_workers=THREADS))
    from dask.distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=THREADS // 2, processes=False, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        return client.gather(client.map(work, cases, pure=False))


def compared(number):
    """One of `RUNS`: values that differ from those of one thread, solves and those done twice, clock seconds of both."""
    who, method, options, count, often = RUNS[number]
    solved, real, out = Counter(), SolvedGears.get, {"differ": 0, "twice": 0, "solved": 0, "one": 0.0, "many": 0.0}

    def counted(self, key, solve):
        return real(self, key, lambda: (solved.update([key]), solve())[1])

    stiffness(*new_pairs(1, [number, often]), method, options)  # imports
    for seed in range(often):
        cases, found = new_pairs(count, [number, seed]), {}
        for name in ("many", "one"):
            cache.clear()
            solved.clear()
            SolvedGears.get = counted
            clock = time.perf_counter()
            work = lambda case: stiffness(case, method, options)  # noqa: E731
            found[name] = over_threads(who, work, cases) if name == "many" else list(map(work, cases))
            SolvedGears.get = real
            if not seed:
                out[name] = time.perf_counter() - clock
            if name == "many":
                out["twice"] += sum(times > 1 for times in solved.values())
                out["solved"] += len(solved)
        sys.setswitchinterval(1e-4)  # from the second repetition on threads change 50 times as often as usual
        out["differ"] += sum(int((a != b).sum()) for a, b in zip(found["many"], found["one"], strict=True))
    return out


def _apart(code, chosen):
    """Run code in a process of its own; `chosen` of the environment, nothing stored."""
    # the package sets one thread where nothing is set: an empty value stays
    env = {name: value for name, value in os.environ.items() if name not in CHOSEN} | {"GEARFE_CACHE": ""}
    env |= dict.fromkeys(CHOSEN, "") | chosen
    return subprocess.run([sys.executable, "-X", "faulthandler", "-c", code], env=env, capture_output=True, text=True, cwd=ROOT)


def _answer(done):
    """What a process printed as JSON in its last line."""
    if done.returncode:
        raise RuntimeError(f"a process ended with {done.returncode}: {done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1])


def callers():
    """Lines of what `RUNS` gave, and what first imports in new processes failed with; RuntimeError if threads change anything."""
    lines, ratios = [], []
    for number, (who, method, options, count, often) in enumerate(RUNS):
        code = f"import json; from validation.make.threads import compared; print(json.dumps(compared({number})))"
        one = _answer(_apart(code, {}))
        more = "".join(f", {name} {value}" for name, value in options.items())
        told = f"| {who} | `{method}`{more} | {often} x {count} | 0 | {one['differ']} | "
        lines.append(f"{told}{one['solved']}, {one['twice']} | {one['one']:.3g} | {one['many']:.3g} |")
        ratios.append(one["many"] / one["one"])
        if one["differ"]:
            raise RuntimeError(f"threads of the caller change something: {lines[-1]}")
    first = [_apart(FIRST, {}) for _ in range(IMPORTS)]
    failed = [one.stderr.splitlines()[-1] for one in first if one.returncode]
    return {"lines": lines, "ratios": ratios, "imports": IMPORTS, "failed": failed}


def callers_told(found):
    """Lines of the page."""
    return [
        "## Threads of the caller",
        "",
        f"New pairs with a cracked pinion, {THREADS} threads against one, nothing kept from before; every wheel belongs to",
        "two pairs, so",
        "that two threads ask for it at once. A process that ends, a value with other bits, a gear solved twice: each would be",
        "counted here. From the second repetition on threads change 50 times as often as usual; the seconds are those of the",
        "first.",
        "gmsh has one model for the whole process and Python runs one thread at a time, so threads work in turns and lose time",
        f"at each: use processes (`gearfe.batch`) for speed. On {found['machine'].replace(', one thread used', '')}:",
        "",
        "| threads by | method | pairs | processes ended | values that differ | solves, twice | clock s, 1 thread | "
        f"{THREADS} threads |",
        "|---" * 8 + "|",
        *found["lines"],
        "",
        f"First import of all public names from {THREADS} threads at once, in {found['imports']} new processes: "
        f"{len(found['failed'])} failed{': ' + '; '.join(found['failed']) if found['failed'] else ''}.",
    ]


def algebra():
    """Lines: what a pair costs with threads of the linear algebra."""
    cores = os.cpu_count()
    settings = {"not set: one inside of gearfe": {}, "1": {"OMP_NUM_THREADS": "1"}, f"{cores}": {"OMP_NUM_THREADS": f"{cores}"}}
    code = "import json; from validation.make.threads import measure; print(json.dumps(measure()))"
    found = {said: _answer(_apart(code, chosen)) for said, chosen in settings.items()}
    rows = {said: " | ".join(f"{cpu:.3g} | {clock:.3g}" for cpu, clock in row.values()) for said, row in found.items()}
    return {"lines": [f"| {said} | {cells} |" for said, cells in rows.items()]}


def algebra_told(found):
    """Lines of the page."""
    return [
        "## Threads of the linear algebra",
        "",
        "The section of a pair 18/27 at 64 phases, nothing cached. gearfe uses one thread unless an environment variable says",
        "how",
        "many; the last row is what it did before it had that limit. On a machine that does other work too, threads wait for",
        "each",
        f"other. On {found['machine'].replace(', one thread used', '')}:",
        "",
        "| OMP_NUM_THREADS | " + " | ".join(f"`{method}` CPU s | clock s" for method in METHODS) + " |",
        "|---" * (1 + 2 * len(METHODS)) + "|",
        *found["lines"],
    ]
