"""Workers that are killed, on this machine and on a Dask cluster: the rows are those of an undisturbed sweep, bit for bit."""

import os
import random
import signal
import subprocess
import sys
import time

import pandas as pd
import psutil
import pytest

import gearfe as gf
from gearfe.runs.store import folder as place

STUDY = {
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "case": "cracked",
    "crack": [{"case": "cracked", "gear": "sun", "level": 0.2}],
    "options": {"method": "ritz", "phases": 8},
    "vary": {
        "gear.sun.r_bore_mm": [6.0, 6.5, 7.0],
        "crack.cracked.level": [0.1, 0.2, 0.3, 0.4],
        "pair.sun_planet.force_N": [500.0, 1000.0, 1500.0, 2000.0],
    },
    "block": 2,
}
pytestmark = pytest.mark.slow


def rows(runs):
    return runs.table().drop(columns="seconds")


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    return gf.sweep(STUDY, tmp_path_factory.mktemp("sweep") / "runs", workers=1)


def same(found, undisturbed):
    pd.testing.assert_frame_equal(rows(found), rows(undisturbed), check_exact=True)
    assert found.curves().identical(undisturbed.curves())


def test_a_worker_process_killed_is_replaced(undisturbed, tmp_path):
    killed = []

    def kill(done, total):
        if done >= 8 and not killed:
            workers = [one for one in psutil.Process().children() if "spawn_main" in " ".join(one.cmdline())]
            killed.append(workers[0].pid)
            os.kill(workers[0].pid, signal.SIGKILL)

    found = gf.sweep(STUDY, tmp_path / "runs", workers=2, progress=kill)
    assert killed
    same(found, undisturbed)


def test_a_case_that_ends_its_process_is_recorded_as_lost(tmp_path, monkeypatch):
    """Every process that computes the level 0.3 is killed by it; all other cases are there."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    (tmp_path / "sitecustomize.py").write_text(
        "import os, sys\n"
        "if 'multiprocessing.spawn' in ' '.join(sys.orig_argv):\n"
        "    from gearfe.runs.sweeps import kinds\n"
        "    work = kinds.KINDS['stiffness'].work\n"
        "    def bad(case, options):\n"
        "        if case.damage['pinion'][0].level == 0.3:\n"
        "            os._exit(9)\n"
        "        return work(case, options)\n"
        "    kinds.KINDS['stiffness'] = kinds.KINDS['stiffness']._replace(work=bad)\n"
    )
    study = STUDY | {"options": {"method": "textbook", "phases": 8}, "vary": {"crack.cracked.level": [0.1, 0.2, 0.3, 0.4, 0.5]}}
    table = gf.sweep(study, tmp_path / "runs", workers=2).table()
    assert table["status"].tolist() == ["done", "done", "lost", "done", "done"]
    assert "killed, or out of memory" in table["error"][2]


def test_kills_of_everything(undisturbed, tmp_path):
    """Each time the process is killed at a random moment; what is in the folder then stays, and the end is the same."""
    drawn, folder = random.Random(7), tmp_path / "runs"
    code = f"import gearfe as gf; gf.sweep({STUDY!r}, {str(folder)!r}, workers=2)"
    kills, alone = 0, []
    while kills < 6:
        child = subprocess.Popen([sys.executable, "-c", code])
        time.sleep(drawn.uniform(0.5, 9.0))
        workers = psutil.Process(child.pid).children(recursive=True) if child.poll() is None else []
        child.kill()
        child.wait()
        kills += 1
        alone += workers
        for one in folder.glob("block*"):
            assert one.stat().st_size > 0
        if len(list(folder.glob("block*"))) == 24:
            for one in sorted(folder.glob("block*"))[::2]:
                one.unlink()
    psutil.wait_procs(alone, timeout=60)
    assert not any(one.is_running() and one.status() != psutil.STATUS_ZOMBIE for one in alone), "workers outlived their parent"
    same(gf.sweep(STUDY, folder, workers=2), undisturbed)
    assert not list(folder.glob(f"{place.PART}*"))


def test_cluster_with_a_worker_killed(undisturbed, tmp_path):
    """A scheduler and three workers as processes; one is killed when a third of the cases is done."""
    options = {"env": os.environ | {"OMP_NUM_THREADS": "1"}, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    address, told = tmp_path / "scheduler.json", "--scheduler-file"
    started = [
        subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_scheduler", told, str(address), "--port", "0", "--no-dashboard"],
            **options,
        )
    ]
    try:
        for i in range(3):
            worker = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(tmp_path / f"w{i}")]
            started.append(
                subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", told, str(address), *worker], **options)
            )
        where = _address(address, 3)

        def kill(done, total):
            if done >= total // 3 and started[1].poll() is None:
                started[1].kill()
                started[1].wait()

        found = gf.sweep(STUDY, tmp_path / "runs", scheduler=where, progress=kill)
    finally:
        for one in started[::-1]:
            one.kill()
            one.wait()
    same(found, undisturbed)


def _address(file, workers):
    """Address of the scheduler once it has so many workers."""
    import json

    from distributed import Client

    end = time.monotonic() + 120
    while not file.exists() and time.monotonic() < end:
        time.sleep(0.1)
    where = json.loads(file.read_text())["address"]
    with Client(where, set_as_default=False) as client:
        client.wait_for_workers(workers, timeout=120)
    return where


def test_no_scheduler_is_said(tmp_path, monkeypatch):
    from gearfe.runs import runner

    monkeypatch.setattr(runner, "TIMEOUT", "1s")
    with pytest.raises(ValueError, match="no Dask scheduler answers"):
        gf.sweep(STUDY, tmp_path / "runs", scheduler="tcp://127.0.0.1:9")
    assert len(gf.open_runs(tmp_path / "runs")) == 0
