"""Seconds of the live page: change to picture in headless Chromium, several users at once, cold start, memory while dragging.

    python tests/app/bench.py [MINUTES of dragging, default 10]

Prints lines; to be run on a machine that does nothing else.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request

import psutil
from browser import Browser

READY = "typeof shown === 'object' && shown !== null && !document.body.classList.contains('dim')"
CRACK = "damage_0_length_mm"
CHANGES = {"force": ("force", 1500, 7), "crack": (CRACK, 1.0, 0.013), "teeth": ("z_2", 25, 1)}
COUNT, EIGHT = 60, 15.0  # changes of each kind; seconds of several users
DRAWN = """(async () => {{
  const before = performance.now();
  change(every().find((one) => one.name === {name!r}), {value});
  while (document.body.classList.contains("dim")) await new Promise((done) => requestAnimationFrame(done));
  await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  return performance.now() - before;
}})()"""


def told(name, values):
    """A line of percentiles."""
    values = sorted(values)
    at = [values[min(len(values) - 1, int(part * len(values)))] for part in (0.5, 0.95)]
    print(f"{name}: p50 {at[0]:.0f} ms, p95 {at[1]:.0f} ms, largest {values[-1]:.0f} ms of {len(values)}", flush=True)


def users(place, count, seconds):
    """So many users who drag all the time: answers a second of all of them, and the longest wait."""
    waits, end = [], time.monotonic() + seconds

    def drag(number):
        step = 0
        while time.monotonic() < end:
            step += 1
            state = {
                "force": 1000.0 + 10 * step + number,
                "damage": [{"kind": "crack", "gear": "pinion", "length_mm": 1.0 + 0.01 * (step % 100) + 0.001 * number}],
            }
            began = time.monotonic()
            body = json.dumps({"page": str(number), "state": state}).encode()
            urllib.request.urlopen(f"{place}task/quick", body, 60).read()
            waits.append(1e3 * (time.monotonic() - began))

    threads = [threading.Thread(target=drag, args=(number,)) for number in range(count)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    told(f"{count} users, {len(waits) / seconds:.1f} answers a second, wait", waits)


def memory(server):
    """Of the server and all its solvers [MB], pages that they share counted once."""
    every = [server, *server.children(recursive=True)]
    return sum(one.memory_full_info().pss for one in every) / 2**20


def main(minutes):
    """All of it."""
    words = [sys.executable, "-m", "gearfe", "app", "--port", "0", "--no-browser"]
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, Browser(folder) as browser:
        browser.page("about:blank")
        began = time.monotonic()
        served = subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=os.environ | {"OMP_NUM_THREADS": "1"})
        try:
            place = re.search("http://[0-9.:]+/", served.stdout.readline())[0]
            session = browser.page(place)
            browser.until(session, READY)
            print(f"cold start to the first picture in a browser that is open: {time.monotonic() - began:.1f} s", flush=True)
            for name, (field, start, step) in CHANGES.items():
                times = []
                for number in range(COUNT):
                    times.append(browser.run(session, DRAWN.format(name=field, value=start + step * number)))
                    time.sleep(0.05)
                told(f"change to picture, {name}", times[3:])
                browser.run(session, "become({...start}); 1")
                browser.until(session, READY)
            for count in (2, 8):
                users(place, count, EIGHT)
            server, end, number = psutil.Process(served.pid), time.monotonic() + 60 * minutes, 0
            print(f"memory before dragging: {memory(server):.0f} MB")
            while time.monotonic() < end:
                number += 1
                browser.run(session, DRAWN.format(name=CRACK, value=0.5 + 0.001 * (number % 2500)))
                if number % 500 == 0:
                    heap = browser.run(session, "performance.memory.usedJSHeapSize") / 2**20
                    print(f"after {number} pictures: solvers and server {memory(server):.0f} MB, page {heap:.0f} MB", flush=True)
            print(f"memory after dragging: {memory(server):.0f} MB, {number} pictures")
        finally:
            served.terminate()
            served.wait(30)


if __name__ == "__main__":
    main(float(sys.argv[1]) if sys.argv[1:] else 10.0)
