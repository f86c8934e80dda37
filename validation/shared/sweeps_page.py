"""Sections of the page `sweeps`, of what its parts keep."""


def cost(found):
    """What the grid took."""
    total = found["parent_seconds"] + found["worker_seconds"]
    first, most, last = found["memory"]
    where = found["machine"].replace(", one thread used", "")
    return [
        "## What it costs",
        "",
        f"{found['cases']:,} cases of `planetary_pitting`, sun and planet: crack levels, angles, loads and bores; `ritz`, 32",
        "phases per",
        f"mesh cycle over the engagement of the cracked tooth; 2 processes on {where}. The clock says",
        f"{found['wall'] / 60:.1f} min,",
        f"at a load average of {found['load_average']:.0f} on two cores (2: nothing else ran).",
        "",
        "| what | value |",
        "|---|---|",
        f"| processor time of a case, mean | {1e3 * found['case_seconds'] / found['cases']:.1f} ms |",
        f"| processor time of all processes | {total:.0f} s |",
        f"| of it in cases: what one process would need, over what two need | {100 * found['case_seconds'] / total:.1f} % |",
        f"| of it in the process that writes and hands out | {found['parent_seconds']:.1f} s |",
        f"| store | {found['bytes'] / 1e6:.1f} MB in {found['blocks']} files, {found['bytes'] / found['cases']:.0f} B a case |",
        f"| resident memory of the three processes: first, most, last | {first:.0f}, {most:.0f}, {last:.0f} MB |",
        f"| cases that failed | {found['failed']} |",
        "",
        "Memory rises while each process fills its store of solved gears, of 64 MB at most.",
    ]


def new(found):
    """Cases that share nothing."""
    return [
        "## Cracked gears not solved before",
        "",
        f"{found['cases']} levels, each case another cracked gear, 32 phases per mesh cycle over its engagement, mate known.",
        "Median of",
        f"the sweep {1e3 * found['swept']:.0f} ms of processor time, least {1e3 * found['least']:.0f} ms; of single calls of",
        f"`gf.mesh_stiffness` in the same process just after, {1e3 * found['alone']:.0f} ms.",
    ]


def kills(found):
    """Kill -9."""
    kept = all(one["kept"] for one in found["kills"])
    return [
        "## Killed",
        "",
        f"A sweep of {found['cases']} cases, each its own block, on one and two processes in turn, killed (SIGKILL) at",
        f"{len(found['kills'])} random moments and each time started again. Every file there stayed as it was, byte for byte:",
        f"{_yes(kept)}. {found['left_for_the_last']} cases were left for the last start. The store is that of an undisturbed",
        "sweep,",
        f"all rows and curves bit for bit: {_yes(found['same'])}.",
    ]


def refusals(found):
    """Disks and folders."""
    said = ("full disk", "read-only folder", "foreign folder", "another study", "shard cut in half", "one bit turned")
    return [
        "## Full disks and other folders",
        "",
        "| what | message |",
        "|---|---|",
        *(f"| {name} | {found[name]} |" for name in said),
        "",
        f"The full disk kept {found['kept']} finished cases; with more space the same call went on, and its store is that of an",
        f"undisturbed sweep: {_yes(found['same'])}. With the damaged file deleted, its block was computed again and the store",
        "is the",
        f"same: {_yes(found['mended'])}.",
    ]


def cluster(found):
    """Dask."""
    return [
        "## A cluster that loses a worker",
        "",
        f"A Dask scheduler and three worker processes; one was killed when {found['killed_after']} of {found['cases']} cases",
        "were",
        f"done. Rows and curves are those of one local process, bit for bit: {_yes(found['same'])}. The scheduler spends",
        f"{1e3 * found['scheduler_seconds']:.2f} ms of processor time on a task.",
    ]


def _yes(holds):
    return "**yes**" if holds else "**NO**"
