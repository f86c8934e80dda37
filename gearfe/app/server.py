"""Server of the live page: files, tasks, and `serve`, which runs the server on this computer."""

import asyncio
import contextlib
import json
import os
import socket
from collections.abc import AsyncIterator
from importlib import resources
from pathlib import Path
from typing import Any

from ..core.extras import missing

try:
    import uvicorn
    from starlette.applications import Starlette
    from starlette.requests import ClientDisconnect, Request
    from starlette.responses import Response
    from starlette.routing import Route
except ImportError as error:
    raise missing(error.name or "starlette", error) from error

from .fields import checked_state, form
from .guard import Guard, Limits
from .workers import LIMIT, SLOW, Pool

KINDS = {*LIMIT, "quick", "fine", "load", "toml", "python", "csv"}
FILES = {"/": ("page.html", "text/html"), "/page.css": ("page.css", "text/css"), "/page.js": ("page.js", "text/javascript")}
LANE = 40  # longest name of a page [characters]
PORT, LARGEST_SCENE = 8033, 90_000  # longest scene text [characters]; its request stays below the guard's limit


class Answer(Response):
    """Lines of JSON with the progress and then the result of a task. Closing the page cancels the task."""

    def __init__(self, pool: Pool, lane: str, kind: str, given: dict[str, Any]):
        super().__init__(media_type="application/x-ndjson")
        del self.headers["content-length"]
        self.headers["cache-control"] = "no-store"
        self.pool, self.lane, self.kind, self.given = pool, lane, kind, given

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Send the lines."""

        async def tell(known):
            await send({"type": "http.response.body", "body": json.dumps(known).encode() + b"\n", "more_body": True})

        async def left():
            while (await receive())["type"] != "http.disconnect":
                pass

        await send({"type": "http.response.start", "status": 200, "headers": self.raw_headers})
        work, gone = (asyncio.ensure_future(task) for task in (self.pool.ask(self.lane, self.kind, self.given, tell), left()))
        try:
            await asyncio.wait({work, gone}, return_when=asyncio.FIRST_COMPLETED)
            if work.done():
                await send({"type": "http.response.body", "body": work.result() + b"\n"})
        finally:
            for task in (work, gone):
                task.cancel()


def application(
    hosts: tuple[str, ...], pool: Pool, *, start: dict[str, Any] | None = None, limits: Limits | None = None
) -> Guard:
    """Return the ASGI application of the page.

    The page is served under the names `hosts` (with ports). The solver processes of `pool` solve its tasks, and end with the
    application. `start` is the argument of ``load`` when the page opens: name and text of a scene, its pair and case. `limits`
    apply to a public server.
    """

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        yield
        pool.end()

    async def task(request: Request) -> Response:
        kind = request.path_params["kind"]
        try:
            body = json.loads(await request.body(), parse_constant=_no_number)
        except ClientDisconnect:  # The client closed the connection.
            return _refused("the request is incomplete", 400)
        except (json.JSONDecodeError, UnicodeDecodeError, RecursionError):
            return _refused("this is no JSON", 400)
        except ValueError as error:
            return _refused(str(error), 400)
        if kind not in KINDS or not isinstance(body, dict):
            return _refused(f"no task {kind[:40]!r} of this page", 400)
        try:
            given = body if kind == "load" else checked_state(body.get("state"))
        except ValueError as error:
            return _refused(str(error))
        lane = "now" if kind in ("quick", "fine") else kind
        return Answer(pool, f"{str(body.get('page'))[:LANE]} {lane}", kind, given)

    routes = [Route(path, _file(name, kind)) for path, (name, kind) in FILES.items()]
    routes.append(Route("/plotly.js", _plotly))
    routes.append(Route("/form", _text(json.dumps(json.loads(form()) | {"open": start, "expected": SLOW}))))
    routes.append(Route("/task/{kind}", task, methods=["POST"]))
    return Guard(Starlette(routes=routes, lifespan=lifespan), hosts, limits)


def _refused(text, status=200):
    """Return the response to a rejected request.

    The page's own requests get status 200, because browsers log other statuses as errors.
    """
    return Response(json.dumps({"refused": text}), status, media_type="application/json")


def _no_number(name):
    raise ValueError(f"{name} is not a number: give a finite number")


def _text(text, kind="application/json"):
    async def answer(_):
        return Response(text, media_type=kind, headers={"cache-control": "no-cache"})

    return answer


def _file(name, kind):
    return _text((resources.files("gearfe.app") / name).read_text(encoding="utf-8"), kind)


async def _plotly(_):
    text = (resources.files("plotly") / "package_data" / "plotly.min.js").read_bytes()
    return Response(text, media_type="text/javascript", headers={"cache-control": "max-age=86400"})


def opened(scene: str, pair: str | None = None, case: str | None = None) -> dict[str, Any]:
    """Return the initial state of the page: a built-in scene or a scene file, with pair and case.

    ValueError if there is no such scene, or it is too large for the page.
    """
    from ..scene.load import read_tables, scene_names

    read_tables(scene)
    out: dict[str, Any] = {"name": scene, "pair": pair, "case": case}
    if scene in scene_names():
        return out
    text = Path(scene).read_text(encoding="utf-8-sig")
    if len(text) > LARGEST_SCENE:
        raise ValueError(f"{scene}: {len(text)} characters, but a scene on the page has at most {LARGEST_SCENE}")
    return out | {"name": Path(scene).name, "text": text}


def serve(
    *,
    port: int = PORT,
    start: dict[str, Any] | None = None,
    public: str | None = None,
    users: int = 40,
    tasks: int = 600,
    workers: int | None = None,
    browser: bool = True,
) -> None:
    """Serve the page on 127.0.0.1 until it is interrupted.

    Parameters
    ----------
    port : int
        TCP port; 0: any free one.
    start : dict, optional
        Result of `opened`.
    public : str, optional
        Host name under which a reverse proxy on this computer shows the page to others.
    users, tasks : int
        Limits with `public`, see `gearfe.app.guard.Limits`.
    workers : int, optional
        Number of solver processes, default one per core; at least 2.
    browser : bool
        Open it in the browser.

    Raises
    ------
    ValueError
        If the port is taken, or a number is out of its range.
    """
    for name, value in (("workers", workers), ("users", users), ("tasks", tasks)):
        if value is not None and value < 1:
            raise ValueError(f"{name} = {value}, but give a whole number from 1 on")
    if not 0 <= port < 2**16:
        raise ValueError(f"port = {port}, but give a number from 0 to 65535")
    try:
        listening = socket.create_server(("127.0.0.1", port))
    except OSError as error:
        raise ValueError(
            f"port {port} of 127.0.0.1 cannot be used ({error}): give another --port, or --port 0 for any"
        ) from error
    port = listening.getsockname()[1]
    hosts = (f"127.0.0.1:{port}", f"localhost:{port}", *([public] if public else []))
    app = application(hosts, Pool(workers or os.cpu_count() or 2), start=start, limits=Limits(users, tasks) if public else None)
    print(f"gearfe app: http://{hosts[0]}/ (Ctrl+C ends it)", flush=True)
    if browser:
        import webbrowser

        webbrowser.open(f"http://{hosts[0]}/")
    running(app, proxy=bool(public)).run(sockets=[listening])


def running(app: Any, *, proxy: bool = False) -> uvicorn.Server:
    """Return a server of an application for a socket.

    Behind a `proxy` on this computer, the server uses the client address that the proxy states.
    """
    config = uvicorn.Config(
        app, log_level="warning", ws="none", server_header=False, proxy_headers=proxy, forwarded_allow_ips="127.0.0.1",
        limit_concurrency=400, timeout_graceful_shutdown=2,
    )  # fmt: skip
    return uvicorn.Server(config)
