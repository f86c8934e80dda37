"""Whatever comes to the server is answered in a sentence, and the page lives: dead solvers, queues, foreign sites, nonsense."""

import asyncio
import http.client
import json
import math
import os
import random
import re
import signal
import socket
import sys
import threading
import time

import pytest

pytest.importorskip("starlette")
from gearfe.app import workers
from gearfe.app.cli import main
from gearfe.app.fields import START
from gearfe.app.guard import AWAY, LARGEST, Guard, Limits
from gearfe.app.server import application, opened, running, serve
from gearfe.app.workers import Pool

NAME = "gears.example.org"


class Client:
    """A server of its own in a thread, asked over HTTP."""

    def __init__(self, pool, limits=None):
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.host = f"127.0.0.1:{self.socket.getsockname()[1]}"
        self.server = running(application((self.host, NAME), pool, limits=limits), proxy=bool(limits))
        self.thread = threading.Thread(target=self.server.run, kwargs={"sockets": [self.socket]})
        self.thread.start()

    def end(self):
        self.server.should_exit = True
        self.thread.join()
        self.socket.close()

    def __call__(self, path, body=None, **headers):
        """Status, headers and text; `body` as bytes, of a dictionary as JSON."""
        line = http.client.HTTPConnection(self.host, timeout=60)
        headers = {name.replace("_", "-"): value for name, value in headers.items()}
        text = json.dumps(body) if isinstance(body, dict) else body
        line.request("GET" if body is None else "POST", path, text, headers)
        found = line.getresponse()
        out = found.status, dict(found.getheaders()), found.read().decode()
        line.close()
        return out

    def last(self, kind, state=None, **more):
        """The last line of an answer."""
        return json.loads(self(f"/task/{kind}", {"page": "a", "state": state or {}} | more)[2].splitlines()[-1])


@pytest.fixture(scope="module")
def pool():
    made = Pool(2)
    yield made
    made.end()


@pytest.fixture(scope="module")
def client(pool):
    made = Client(pool)
    yield made
    made.end()


async def nothing(_):
    pass


@pytest.fixture
def rested(pool):
    """The pool when all its processes are free, also one that was started anew."""
    end = time.monotonic() + 30
    while len(pool.free) < pool.count:
        assert time.monotonic() < end
        time.sleep(0.02)
    return pool


def test_the_page_and_its_files_are_there_and_load_nothing_else(client):
    for path, kind in {
        "/": "text/html",
        "/page.js": "text/javascript",
        "/page.css": "text/css",
        "/plotly.js": "text/javascript",
    }.items():
        status, headers, text = client(path)
        assert status == 200
        assert headers["content-type"].startswith(kind)
        policy = dict(one.split(" ", 1) for one in headers["content-security-policy"].split("; "))
        assert policy["default-src"] == "'none'"
        assert policy["script-src"] == policy["connect-src"] == "'self'"
        assert path == "/plotly.js" or "http://" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "<script>" not in client("/")[2]


def test_a_picture_is_answered(client):
    found = client.last("quick")
    assert found["headline"].startswith("2 mm crack at 60 degrees: the mesh is")
    assert all(math.isfinite(k) for curve in found["curves"] for k in curve["k"])


@pytest.mark.parametrize("path", ["/../pyproject.toml", "/page.py", "/task/quick", "/%2e%2e/etc/passwd", "/static/page.js"])
def test_no_other_file_is_given(client, path):
    assert client(path)[0] in (404, 405)


FOREIGN = {
    "another name": ({"Host": "evil.example"}, 421),
    "another port": ({"Host": "127.0.0.1:1"}, 421),
    "another site": ({"Sec_Fetch_Site": "cross-site"}, 403),
    "a sister site": ({"Sec_Fetch_Site": "same-site"}, 403),
    "the page": ({"Sec_Fetch_Site": "same-origin"}, 200),
    "a program": ({}, 200),
}


@pytest.mark.parametrize("who", FOREIGN)
def test_only_the_page_itself_may_ask(client, who):
    headers, wanted = FOREIGN[who]
    status, _, text = client("/task/toml", {"page": "a", "state": {}}, **headers)
    assert status == wanted
    assert status == 200 or json.loads(text)["refused"]


def test_a_link_from_another_site_opens_the_page_and_asks_nothing(client):
    foreign = {"Sec_Fetch_Site": "cross-site", "Sec_Fetch_Mode": "navigate"}
    assert client("/", **foreign)[0] == 200
    assert client("/form", **foreign)[0] == 403


NONSENSE = {
    "no JSON": b"}{",
    "not UTF-8": b"\xff\xfe\x00",
    "deep": b"[" * 50_000,
    "a list": b"[1, 2]",
    "NaN": b'{"page": "a", "state": {"force": NaN}}',
    "infinity": b'{"page": "a", "state": {"force": -Infinity}}',
    "no state": b'{"page": "a"}',
    "a state of the wrong kind": b'{"page": "a", "state": [3]}',
    "100 kB": random.Random(1).randbytes(LARGEST),
}


@pytest.mark.parametrize("name", NONSENSE)
def test_nonsense_is_refused_in_a_sentence(client, name):
    status, _, text = client("/task/quick", NONSENSE[name])
    assert status == (200 if "state" in name else 400)
    assert len(json.loads(text)["refused"]) > 10


def test_what_is_too_large_is_not_read(client):
    assert client("/task/load", b"a" * (LARGEST + 1))[0] == 413
    assert client("/task/load", iter([b"a"]))[0] == 411
    zeros = str(LARGEST + 1).zfill(20)
    assert client("/task/load", b"a" * (LARGEST + 1), Content_Length=zeros)[0] == 413
    chunk = b"%x\r\n%b\r\n0\r\n\r\n" % (LARGEST + 1, b"a" * (LARGEST + 1))
    assert client("/task/load", chunk, Content_Length="9", Transfer_Encoding="chunked")[0] == 411


def test_a_client_that_hangs_up_within_its_request_leaves_no_traceback(client, caplog):
    for _ in range(3):
        line = socket.create_connection(client.socket.getsockname())
        line.sendall(f"POST /task/quick HTTP/1.1\r\nHost: {client.host}\r\nContent-Length: 99\r\n\r\n{{".encode())
        line.close()
    assert client("/form")[0] == 200
    assert not [record for record in caplog.records if record.exc_info]


@pytest.mark.parametrize("text", ["", "a = [" * 5000, "\x00", "z = 1\n" * 9000, None, 3])
def test_a_scene_that_is_none_is_refused_and_the_page_lives(client, text):
    assert "refused" in client.last("load", name="x.toml", text=text)
    assert "refused" in client.last("load", name="x.toml", text="", pair=[1])


def test_a_built_in_scene_is_loaded_by_name_and_no_file_is(client, tmp_path):
    found = client.last("load", name="helical_pitting", pair="pinion_wheel", case="minor")
    assert found["state"]["z_2"] == 60
    assert any("hand of the wheel" in one for one in found["notes"])
    file = tmp_path / "own.toml"
    file.write_text("title = 'a'")
    assert "no scene" in client.last("load", name=str(file))["refused"]


def test_a_solver_that_dies_is_replaced(client, rested):
    worker = rested.free[-1]  # the next to be asked
    os.kill(worker.process.pid, signal.SIGKILL)
    worker.process.join(10)
    assert "a new one is started" in client.last("toml")["refused"]
    assert "text" in client.last("toml")
    assert worker not in rested.free


def test_a_task_that_takes_too_long_is_ended(client, monkeypatch):
    assert "text" in client.last("toml")
    monkeypatch.setattr(workers, "QUICK_LIMIT", 0.01)
    assert "more than 0.01 s" in client.last("fine", {"z_1": 29})["refused"]
    monkeypatch.undo()
    assert "text" in client.last("toml")


def test_the_newest_of_a_page_wins_and_a_full_queue_is_told(rested):
    """While both solvers are taken: of three questions of one page the last is answered; others wait, or are refused."""

    async def run():
        taken, rested.free = rested.free, []
        try:
            said = []

            async def tell(known):
                said.append(known)

            one = [asyncio.ensure_future(rested.ask("a now", "toml", START, tell)) for _ in range(3)]
            other = asyncio.ensure_future(rested.ask("b now", "toml", START, tell))
            await asyncio.sleep(0.7)
            assert [task.done() for task in one] == [True, True, False]
            assert said == [{"waiting": 0}, {"waiting": 1}]
            most, rested.most = rested.most, 2
            full = await rested.ask("c now", "toml", START, tell)
            rested.most = most
        finally:
            rested.free = taken
        rested._deal()
        return [json.loads(found) for found in [*await asyncio.gather(*one), await other, full]]

    first, second, last, other, full = asyncio.run(run())
    assert first == second == {"stale": True}
    assert last == other
    assert "[pair.stage]" in last["text"]
    assert "2 others wait" in full["refused"]


def test_who_goes_away_gives_his_place_up_and_slow_tasks_leave_a_solver_free(rested):
    async def run():
        before = {worker.process.pid for worker in rested.free}
        slow = [
            asyncio.ensure_future(rested.ask(f"{page} solid", "solid", START | {"beta": 9.0, "z_1": 23}, nothing))
            for page in "ab"
        ]
        await asyncio.sleep(0.3)
        assert len(rested.waiting) == 1
        assert b"[pair.stage]" in await rested.ask("c toml", "toml", START, nothing)
        for one in slow[::-1]:
            one.cancel()
        await asyncio.wait(slow)
        end = time.monotonic() + 20
        while len(rested.free) < 2 and time.monotonic() < end:
            await asyncio.sleep(0.05)
        return before, {worker.process.pid for worker in rested.free}

    before, after = asyncio.run(run())
    assert len(after) == 2
    assert len(after - before) == 1
    assert rested.waiting == []
    assert rested.slow == 0


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited where the system can")
def test_a_solver_without_memory_says_so():
    small = Pool(2, memory=300 * 2**20)

    async def run():
        return json.loads(await small.ask("a now", "quick", START | {"z_1": 33}, nothing))

    try:
        assert re.search("memory|GB are free", asyncio.run(run())["refused"])
    finally:
        small.end()


def test_limits_of_a_course():
    limits = Limits(users=2, tasks=3)
    assert [bool(limits.refused("a", t)) for t in (0.0, 1.0, 2.0, 3.0, 61.0)] == [False, False, False, True, False]
    assert limits.refused("b", 62.0) == ""
    assert "2 users are connected" in limits.refused("c", 63.0)
    assert limits.refused("c", 62.0 + AWAY + 1.0) == ""
    assert len(limits.seen) == 1


def test_a_course_is_limited_and_answers_its_name(pool):
    public = Client(pool, Limits(3, 1))
    try:
        found = [
            public("/task/toml", {"page": "a", "state": {}}, Host=NAME, X_Forwarded_For=who)
            for who in ("1.1.1.1", "2.2.2.2", "1.1.1.1")
        ]
    finally:
        public.end()
    assert [status for status, *_ in found] == [200, 200, 429]
    assert "please wait" in json.loads(found[2][2])["refused"]


def test_what_cannot_be_served_is_refused(tmp_path):
    with pytest.raises(ValueError, match="workers = 0"):
        serve(workers=0)
    with pytest.raises(ValueError, match="port = 1000000"):
        serve(port=10**6)
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(ValueError, match="another --port"):
        serve(port=taken.getsockname()[1])
    large = tmp_path / "large.toml"
    large.write_text(f"title = '{'a' * 100_000}'")
    with pytest.raises(ValueError, match="at most 90000"):
        opened(str(large))
    with pytest.raises(ValueError, match="no scene 'none'"):
        opened("none")


def test_without_the_extra_one_line_names_it(monkeypatch, capsys):
    monkeypatch.delitem(sys.modules, "gearfe.app.server")
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    assert main(["app", "--no-browser"]) == 1
    told = capsys.readouterr().err.strip()
    assert "\n" not in told
    assert "pip install uvicorn" in told


def test_a_rejected_request_without_end_is_answered(monkeypatch):
    """A client that sends a rejected request in tiny parts, or pauses, is answered after the time that the guard waits."""
    monkeypatch.setattr("gearfe.app.guard.PATIENCE", 0.05)
    sent = []

    async def receive():
        await asyncio.sleep(1.0 if len(sent) else 0.001)
        return {"type": "http.request", "body": b"x", "more_body": True}

    async def send(message):
        sent.append(message)

    scope = {
        "type": "http",
        "method": "POST",
        "path": "/task/load",
        "headers": [(b"host", b"here"), (b"transfer-encoding", b"chunked")],
    }
    asyncio.run(asyncio.wait_for(Guard(None, ("here",))(scope, receive, send), 5.0))
    assert sent[0]["status"] == 411
