"""Text of the page `sweeps.md`, from what `validation.make.sweeps` keeps."""


def page(kept):
    """The page, of the parts on file."""
    sections = {
        "grid": cost, "new_cracks": new_text, "kills": kills_text, "refusals": refusals_text, "cluster": cluster_text,
        "estimate": million,
    }  # fmt: skip
    needed = {"estimate": ("grid", "cluster")}
    lines = ["# Thousands of cases", "", "Made by `python -m validation sweeps`; each part is kept in `tables/sweeps.json`.", ""]
    for name, section in sections.items():
        own = [kept.get(part) for part in needed.get(name, (name,))]
        if all(own):
            lines += [*section(*own), ""]
    return "\n".join(lines).rstrip() + "\n"


def cost(found):
    """What the grid took."""
    total = found["parent_seconds"] + found["worker_seconds"]
    shown = found["memory"][:: max(1, len(found["memory"]) // 12)]
    last = found["memory"][-1]
    shown = shown if shown[-1] is last else [*shown, last]
    where = found["machine"].replace(", one thread used", "")
    part = (
        "" if found["cases"] == 10000 else f" Stopped by hand when {found['cases']} of them were done: the figures are of these."
    )
    return [
        "## What it costs",
        "",
        "10 000 cases of `planetary_pitting`, sun and planet: 25 crack levels, 5 angles, 8 loads, 10 bores; `ritz`, 32 phases",
        f"per mesh cycle over the engagement of the cracked tooth; 2 processes on {where}.{part}",
        f"The clock says {found['wall'] / 60:.1f} min, at a load average of {found['load_average']:.0f} on two cores",
        "(2: nothing else ran).",
        "",
        "| what | value |",
        "|---|---|",
        f"| processor time of a case, mean | {1e3 * found['case_seconds'] / found['cases']:.1f} ms |",
        f"| processor time of all processes | {total:.0f} s |",
        f"| of it in cases: what one process would need, over what two need | {100 * found['case_seconds'] / total:.1f} % |",
        f"| of it in the process that writes and hands out | {found['parent_seconds']:.1f} s |",
        f"| store | {found['bytes'] / 1e6:.1f} MB in {found['blocks']} files, {found['bytes'] / found['cases']:.0f} B a case |",
        f"| cases that failed | {found['failed']} |",
        "",
        "Resident memory of the three processes together. It rises while each process fills its store of solved gears, of 64 MB",
        "at most (here about 1 MB for each of its blocks); a run that ends before that does not show that it is flat then:",
        "",
        "| minutes | MB | blocks done |",
        "|---|---|---|",
        *(f"| {seconds / 60:.1f} | {size:.0f} | {blocks} |" for seconds, size, blocks in shown),
    ]


def new_text(found):
    """Cases that share nothing."""
    return [
        "## Cracked gears not solved before",
        "",
        f"{found['cases']} levels, each case another cracked gear, 32 phases per mesh cycle over its",
        "engagement, mate known. Median of",
        f"the sweep {1e3 * found['swept']:.0f} ms of processor time, least {1e3 * found['least']:.0f} ms; of single calls of",
        f"`gf.mesh_stiffness` in the same process just after, {1e3 * found['alone']:.0f} ms.",
        "45 ms were asked for; the speed page, of another machine, has 46 ms for 64 phases of one cycle.",
    ]


def kills_text(found):
    """Kill -9."""
    blocks = ", ".join(str(one["blocks"]) for one in found["kills"])
    kept = all(one["kept"] for one in found["kills"])
    return [
        "## Killed",
        "",
        f"A sweep of {found['cases']} cases, each its own block, on one and two processes in turn, killed (SIGKILL) at",
        f"{len(found['kills'])} random moments and each time",
        f"started again. Blocks in the folder after each kill: {blocks}. Every file there stayed as it was, byte for byte:",
        f"**{'yes' if kept else 'NO'}**. {found['left_for_the_last']} cases were left for the last start. The",
        "store is that of an",
        f"undisturbed sweep, all rows and curves bit for bit, {found['cases']} cases:",
        f"**{'yes' if found['same'] else 'NO'}**.",
    ]


def refusals_text(found):
    """Disks and folders."""
    said = ("full disk", "read-only folder", "foreign folder", "another study", "shard cut in half", "one bit turned")
    return [
        "## Full disks and other folders",
        "",
        "| what | message |",
        "|---|---|",
        *(f"| {name} | {found[name]} |" for name in said),
        "",
        f"The full disk kept {found['kept']} finished cases; with more space the same call went on, and its",
        "store is that of an",
        f"undisturbed sweep: **{'yes' if found['same'] else 'NO'}**. With the damaged file deleted, its block",
        "was computed again and",
        f"the store is the same: **{'yes' if found['mended'] else 'NO'}**.",
    ]


def cluster_text(found):
    """Dask."""
    return [
        "## A cluster that loses a worker",
        "",
        f"A Dask scheduler and three worker processes; one was killed when {found['killed_after']} of",
        f"{found['cases']} cases were done.",
        "Rows and curves are those of one local process, bit for bit:",
        f"**{'yes' if found['same'] else 'NO'}**. The scheduler spends",
        f"{1e3 * found['scheduler_seconds']:.2f} ms of processor time on a task.",
    ]


def million(grid, cluster):
    """The paper estimate."""
    cases, nodes, cores, block = 1e6, 100, 32, 32
    each = grid["case_seconds"] / grid["cases"]
    writing = grid["parent_seconds"] / grid["blocks"]
    tasks = cases / block
    work, handing, keeping = cases * each / (nodes * cores), tasks * cluster["scheduler_seconds"], tasks * writing
    first = max((work, "computing"), (handing, "the scheduler"), (keeping, "the one process that writes"))
    return [
        "## A million cases on 100 nodes, on paper",
        "",
        f"From the figures above, not tried: {nodes} nodes of {cores} cores, cases like those of the grid in",
        f"{tasks:.0f} blocks.",
        "",
        "| what | how much | seconds |",
        "|---|---|---|",
        f"| computing | {1e3 * each:.1f} ms a case, {cases * each / 3600:.1f} h on {nodes * cores} cores | {work:.0f} |",
        f"| scheduler | {1e3 * cluster['scheduler_seconds']:.2f} ms a task | {handing:.0f} |",
        f"| receiving, writing, flushing | {1e3 * writing:.1f} ms of processor time a block, start included | {keeping:.0f} |",
        f"| store | {grid['bytes'] / grid['cases'] * cases / 1e9:.2f} GB in {tasks:.0f} files | |",
        "",
        f"The three run side by side, so that the longest decides: {first[1]}, {first[0]:.0f} s, besides the",
        "start of the workers (some",
        "seconds of imports on each, more from a slow shared disk). Where writing comes first, larger blocks",
        "(`block = 512`) divide",
        "the cost by 16 and lose more at a kill; where cases take seconds (three dimensions, vibration) computing decides.",
    ]
