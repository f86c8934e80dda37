"""A headless Chromium by the DevTools protocol over its two pipes: what it shows, asks for and complains of."""

import base64
import contextlib
import json
import os
import select
import subprocess
import sys
import time

OPTIONS = ("--headless", "--no-sandbox", "--remote-debugging-pipe", "--disable-gpu", "--no-first-run", "--hide-scrollbars")
WAIT = 60.0  # seconds for an answer
START = """import os, sys
own = [os.dup2(int(one), high) for one, high in zip(sys.argv[1:3], (90, 91))]
for one, wanted in zip(own, (3, 4)):
    os.dup2(one, wanted)
    os.close(one)
os.execvp(sys.argv[3], sys.argv[3:])"""  # the browser wants its pipes as files 3 and 4


class Browser:
    """One browser; `errors` are what its pages complain of, `asked` the addresses they asked for."""

    def __init__(self, folder):
        (own_in, its_out), (its_in, own_out) = os.pipe(), os.pipe()
        words = ["chromium", *OPTIONS, f"--user-data-dir={folder}", "about:blank"]
        start = [sys.executable, "-c", START, str(its_in), str(its_out), *words]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.process = subprocess.Popen(start, pass_fds=(its_in, its_out), **quiet)
        os.close(its_in)
        os.close(its_out)
        self.reading, self.writing, self.rest, self.number = own_in, own_out, b"", 0
        self.errors, self.asked = [], []

    def __enter__(self):
        return self

    def __exit__(self, *error):
        with contextlib.suppress(AssertionError, OSError):
            self("Browser.close")
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(10)
        self.process.kill()
        self.process.wait()
        os.close(self.reading)
        os.close(self.writing)

    def page(self, address, *, width=1280, height=900, touch=False):
        """Open a page of its own; returns its session."""
        target = self("Target.createTarget", url="about:blank", newWindow=True)["targetId"]
        session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Network", "Page"):
            self(f"{domain}.enable", session)
        self("Emulation.setDeviceMetricsOverride", session, width=width, height=height, deviceScaleFactor=1, mobile=touch)
        self("Page.navigate", session, url=address)
        return session

    def __call__(self, method, session=None, **given):
        self.number += 1
        message = {"id": self.number, "method": method, "params": given} | ({"sessionId": session} if session else {})
        os.write(self.writing, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + WAIT
        while True:
            found = self._next(end)
            if found.get("id") == self.number:
                assert "error" not in found, found
                return found["result"]

    def _next(self, end):
        while b"\0" not in self.rest:
            assert select.select([self.reading], [], [], max(0.0, end - time.monotonic()))[0], "the browser does not answer"
            more = os.read(self.reading, 1 << 16)
            assert more, "the browser has ended"
            self.rest += more
        line, _, self.rest = self.rest.partition(b"\0")
        found = json.loads(line)
        given = found.get("params", {})
        if found.get("method") == "Runtime.exceptionThrown":
            self.errors.append(given["exceptionDetails"].get("exception", {}).get("description", str(given)))
        elif found.get("method") == "Log.entryAdded" and given["entry"]["level"] in ("error", "warning"):
            self.errors.append(given["entry"]["text"])
        elif found.get("method") == "Runtime.consoleAPICalled" and given["type"] in ("error", "warning"):
            self.errors.append(str(given["args"]))
        elif found.get("method") == "Network.requestWillBeSent":
            self.asked.append(given["request"]["url"])
        return found

    def run(self, session, code):
        """Value of an expression in the page, waited for if it is a promise."""
        found = self("Runtime.evaluate", session, expression=code, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def until(self, session, code, seconds=30.0):
        """Wait until an expression is true."""
        end = time.monotonic() + seconds
        while not self.run(session, code):
            assert time.monotonic() < end, f"never: {code}; {self.errors}"
            time.sleep(0.05)

    def picture(self, session, path):
        """Write a PNG of what is seen."""
        path.write_bytes(base64.b64decode(self("Page.captureScreenshot", session)["data"]))
