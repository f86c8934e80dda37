"""Access rules of the server and its pages: only this computer, or a class behind a proxy."""

import asyncio
import contextlib
import json
import time
from collections import OrderedDict, deque
from typing import Any

LARGEST = 100_000  # largest request (a state or a scene) [bytes]
DRAINED = 10 * LARGEST  # largest part of a rejected request that is read and discarded [bytes]
PATIENCE = 1.0  # longest time for which such a request is read [s]; tiny parts take long to read, and a client may pause
SAFE = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; "
    "img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}  # plotly writes styles into the page, but no scripts
MINUTE, AWAY = 60.0, 300.0  # [s] window of the request count; idle time after which a client is forgotten


class Limits:
    """Limits of a public server: `users` addresses at the same time, and `tasks` per address and minute.

    An address without requests for `AWAY` seconds is no longer counted. A class behind one router has one address.
    """

    def __init__(self, users: int, tasks: int):
        self.users, self.tasks = users, tasks
        self.seen: OrderedDict[str, deque[float]] = OrderedDict()

    def refused(self, address: str, now: float | None = None) -> str:
        """Return the reason why a task of an address is rejected. The result is empty if the task is accepted."""
        now = time.monotonic() if now is None else now
        while self.seen and now - next(iter(self.seen.values()))[-1] > AWAY:
            self.seen.popitem(last=False)
        if address not in self.seen and len(self.seen) >= self.users:
            return f"{self.users} users are connected, the maximum of this server: please try again in some minutes"
        times = self.seen.setdefault(address, deque())
        self.seen.move_to_end(address)
        while times and now - times[0] > MINUTE:
            times.popleft()
        if len(times) >= self.tasks:
            return f"{self.tasks} tasks per minute is the maximum of this server for one address: please wait a little"
        times.append(now)
        return ""


class Guard:
    """ASGI middleware: rejects requests that do not come from the page itself, and adds the headers `SAFE` to responses.

    `hosts` are the accepted values of the ``Host`` header. Requests under any other name are rejected, because they can be a
    DNS rebinding attack.
    """

    def __init__(self, app: Any, hosts: tuple[str, ...], limits: Limits | None = None):
        self.app, self.hosts, self.limits = app, hosts, limits

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        """Answer a request, or pass it on."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        status, why = self._refused(scope, headers)

        async def safe(message):
            if message["type"] == "http.response.start":
                added = [(name.encode(), value.encode()) for name, value in SAFE.items()]
                message = message | {"headers": [*message.get("headers", ()), *added]}
            await send(message)

        if not why:
            await self.app(scope, receive, safe)
            return
        read, more = 0, scope["method"] == "POST"
        # The rest of the request is read, because a client that still writes does not read the answer.
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(PATIENCE):
                while more and read <= DRAINED:
                    message = await receive()
                    read, more = read + len(message.get("body", b"")), message.get("more_body", False)
        kind = [(b"content-type", b"application/json"), (b"connection", b"close")]
        await safe({"type": "http.response.start", "status": status, "headers": kind})
        await safe({"type": "http.response.body", "body": json.dumps({"refused": why}).encode()})

    def _refused(self, scope, headers):
        host, site = headers.get("host", ""), headers.get("sec-fetch-site", "none")
        if host not in self.hosts:
            return 421, f"Host {host[:80]!r} is not this server: open http://{self.hosts[0]}/"
        link = scope["method"] == "GET" and scope["path"] == "/" and headers.get("sec-fetch-mode") == "navigate"
        if site not in ("none", "same-origin") and not link:
            return 403, f"a request from another site ({site[:20]}): only the page itself may ask"
        if scope["method"] != "POST":
            return 0, ""
        length = headers.get("content-length", "")
        if not (length.isascii() and length.isdigit()) or "transfer-encoding" in headers:
            return 411, "a request without its length"
        length = length.lstrip("0")[:12] or "0"
        if int(length) > LARGEST:
            return 413, f"{length} bytes, but a scene has at most {LARGEST}: this is not one"
        if self.limits:
            why = self.limits.refused((scope.get("client") or ("",))[0])
            return (429, why) if why else (0, "")
        return 0, ""
