"""Trials of sweeps: processes killed, disks full, folders that are not ours, a cluster that loses a worker; what each gives."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

import gearfe as gf

BASE = {
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "case": "cracked",
    "crack": [{"case": "cracked", "gear": "sun", "level": 0.2}],
}
SMALL = BASE | {  # 160 cases
    "options": {"method": "ritz", "phases": 8},
    "vary": {
        "gear.sun.r_bore_mm": [6.0, 6.5, 7.0, 7.4],
        "crack.cracked.level": {"from": 0.1, "to": 0.5, "count": 10},
        "pair.sun_planet.force_N": [500.0, 1000.0, 1500.0, 2000.0],
    },
    "block": 8,
}
QUICK = SMALL | {"options": {"method": "textbook", "phases": 8}}
ONES = QUICK | {"block": 1}
CODE = "import gearfe as gf, json, sys; gf.sweep(json.load(open(sys.argv[1])), sys.argv[2], workers=int(sys.argv[3]))"
ALONE = os.environ | {"OMP_NUM_THREADS": "1"}


def started(study, folder, workers):
    """Process that sweeps a study into a folder."""
    file = Path(f"{folder}.json")
    file.write_text(json.dumps(study), encoding="utf-8")
    return subprocess.Popen([sys.executable, "-c", CODE, str(file), str(folder), str(workers)], env=ALONE)


def same(one, other):
    """Whether two stores hold the same rows and curves bit for bit, the processor's seconds left out."""
    tables = [runs.table().drop(columns="seconds") for runs in (one, other)]
    return tables[0].equals(tables[1]) and one.curves().identical(other.curves())


def kills(count=10):
    """A sweep, each case its own block, killed at random moments, each time continued, beside an undisturbed one."""
    drawn = random.Random(20)
    with tempfile.TemporaryDirectory() as name:
        whole = gf.sweep(ONES, Path(name) / "whole", workers=1)
        folder, seen, before = Path(name) / "killed", [], {}
        for number in range(count):
            process = started(ONES, folder, 1 + number % 2)
            first = len(list(folder.glob("block*")))
            end = time.monotonic() + 300  # a start takes seconds of its own: count from the first sign of life
            while len(list(folder.glob("block*"))) == first and process.poll() is None and time.monotonic() < end:
                time.sleep(0.01)
            time.sleep(drawn.uniform(0.0, 0.15))
            process.send_signal(signal.SIGKILL)
            process.wait()
            there = {one.name: one.read_bytes() for one in folder.glob("block*")}
            kept = all(there.get(one) == content for one, content in before.items())
            seen.append({"blocks": len(there), "kept": kept})
            before = there
        told = []
        found = gf.sweep(ONES, folder, workers=1, progress=lambda done, total: told.append(done))
        return {"kills": seen, "cases": len(found), "left_for_the_last": len(found) - told[0], "same": same(found, whole)}


def refused(work):
    """Message with which `work` is refused."""
    try:
        work()
    except (ValueError, RuntimeError) as error:
        return str(error)
    return "not refused"


def refusals():
    """Full disk, read-only folder, foreign and damaged folders: messages, and whether all that was there stays."""
    out = {}
    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        whole = gf.sweep(QUICK, place / "whole", workers=1)
        disk = place / "disk"
        disk.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=160k", "tmpfs", str(disk)], check=True)
        try:
            out["full disk"] = refused(lambda: gf.sweep(QUICK, disk / "runs", workers=1)).replace(name, "...")
            kept = len(gf.open_runs(disk / "runs"))
            subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
            out["read-only folder"] = refused(lambda: gf.sweep(QUICK, disk / "runs", workers=1)).replace(name, "...")
            subprocess.run(["mount", "-o", "remount,rw,size=20m", str(disk)], check=True)
            found = gf.sweep(QUICK, disk / "runs", workers=1)
            out["kept"], out["same"] = kept, same(found, whole)
        finally:
            subprocess.run(["umount", str(disk)], check=True)
        (place / "letters").mkdir()
        (place / "letters" / "one.txt").write_text("dear", encoding="utf-8")
        out["foreign folder"] = refused(lambda: gf.sweep(QUICK, place / "letters")).replace(name, "...")
        other = QUICK | {"options": {"method": "ritz", "phases": 16}}
        out["another study"] = refused(lambda: gf.sweep(other, place / "whole")).replace(name, "...")
        file = place / "whole" / "block-000002.parquet"
        content = file.read_bytes()
        file.write_bytes(content[: len(content) // 2])
        out["shard cut in half"] = refused(lambda: gf.sweep(QUICK, place / "whole")).replace(name, "...")
        file.write_bytes(content[:300] + bytes([content[300] ^ 1]) + content[301:])
        out["one bit turned"] = refused(lambda: gf.open_runs(place / "whole").table()).replace(name, "...")
        file.unlink()
        out["mended"] = same(gf.sweep(QUICK, place / "whole", workers=1), gf.sweep(QUICK, place / "again", workers=1))
    return out


def cluster():
    """Scheduler and three worker processes, one killed when a third is done; and what 1000 empty tasks cost the scheduler."""
    from distributed import Client

    with tempfile.TemporaryDirectory() as name:
        place = Path(name)
        whole = gf.sweep(SMALL, place / "whole", workers=1)
        quiet = {"env": ALONE, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        file = place / "scheduler.json"
        scheduler = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--scheduler-file", str(file), "--port", "0"]
        processes = [subprocess.Popen([*scheduler, "--no-dashboard"], **quiet)]
        try:
            for i in range(3):
                worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(file), "--nthreads", "1"]
                own = ["--no-nanny", "--no-dashboard", "--local-directory", str(place / f"worker{i}")]
                processes.append(subprocess.Popen([*worker, *own], **quiet))
            while not file.exists():
                time.sleep(0.1)
            address = json.loads(file.read_text(encoding="utf-8"))["address"]
            with Client(address, set_as_default=False) as client:
                client.wait_for_workers(3, timeout=300)
            killed = []

            def progress(done, total):
                if done >= total // 3 and not killed:
                    processes[1].kill()
                    processes[1].wait()
                    killed.append(done)

            found = gf.sweep(SMALL, place / "runs", scheduler=address, progress=progress)
            with Client(address, set_as_default=False) as client:
                before = processor_seconds(processes[0].pid)
                client.gather(client.map(_nothing, range(1000), pure=False))
                each = (processor_seconds(processes[0].pid) - before) / 1000
            return {"same": same(found, whole), "killed_after": killed[0], "cases": len(found), "scheduler_seconds": each}
        finally:
            for one in processes[::-1]:
                one.kill()
                one.wait()


def _nothing(number):
    return number


def processor_seconds(pid):
    """Processor time of a process so far [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory_of(pid):
    """Resident memory of a process and its children [bytes]."""
    total = 0
    for one in (pid, *_children(pid)):
        try:
            total += int(Path(f"/proc/{one}/statm").read_text(encoding="utf-8").split()[1]) * os.sysconf("SC_PAGE_SIZE")
        except OSError:
            continue
    return total


def _children(pid):
    try:
        return [int(one) for one in Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()]
    except OSError:
        return []


def watched(study, folder, workers, every=10.0):
    """Sweep in a process of its own; memory of all its processes over time and the processor time of each."""
    shutil.rmtree(folder, ignore_errors=True)
    process, memory, spent = started(study, folder, workers), [], {}
    begun, done = time.monotonic(), threading.Event()

    def watch():
        while not done.wait(1.0):
            for one in (process.pid, *_children(process.pid)):
                try:
                    spent[one] = processor_seconds(one)
                except OSError:
                    continue
            if not memory or time.monotonic() - begun >= len(memory) * every:
                memory.append((time.monotonic() - begun, memory_of(process.pid) / 1e6, len(list(Path(folder).glob("block*")))))

    thread = threading.Thread(target=watch)
    thread.start()
    process.wait()
    done.set()
    thread.join()
    runs = gf.open_runs(folder)
    seconds = runs.table(["seconds"])["seconds"]
    parent = spent.pop(process.pid)
    return {
        "cases": len(runs),
        "wall": time.monotonic() - begun,
        "case_seconds": float(seconds.sum()),
        "case_median": float(np.median(seconds)),
        "parent_seconds": parent,
        "worker_seconds": sum(spent.values()) if workers > 1 else 0.0,
        "memory": memory,
        "bytes": sum(one.stat().st_size for one in Path(folder).glob("block*")),
        "blocks": len(list(Path(folder).glob("block*"))),
        "failed": int((runs.table(["status"])["status"] != "done").sum()),
    }
