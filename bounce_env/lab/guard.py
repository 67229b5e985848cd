"""Who may talk to the lab: pages that this server itself has served, to the person who started it."""

import ipaddress
import secrets
from collections.abc import MutableMapping
from typing import Any, TypeAlias
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse

App: TypeAlias = Any  # of ASGI

LOCAL = ("localhost", "127.0.0.1", "[::1]")

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cache-control": "no-store",
}

_REFUSED = 1008  # WebSocket's code: policy violation


class Guard:
    """An ASGI application around another one, which gets only what is allowed.

    The Host must be one of `hosts`, with any port: a page that has made its own name point here is refused. The Origin,
    where there is one, and on a WebSocket always, must be that Host. And there must be the cookie, which only the first
    address gives: http://HOST/?token=...

    hosts: names that may stand in the Host header. by_address: any IP address may, too; a page cannot make it its own.
    name: of the cookie; two servers on one host need two.
    """

    def __init__(self, app: App, hosts: tuple[str, ...], name: str, *, by_address: bool = False) -> None:
        self._app = app
        self._hosts = tuple(map(str.lower, hosts))
        self._by_address = by_address
        self._cookie = name
        self.token = secrets.token_urlsafe(24)
        self._secret = secrets.token_urlsafe(24)

    async def __call__(self, scope: MutableMapping[str, Any], receive: Any, send: Any) -> None:
        """Pass on what is allowed, and refuse the rest with a reason."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        reason = self._wrong_address(headers, needs_origin=scope["type"] == "websocket")
        app = self._app
        if not reason and scope["type"] == "http" and self._has_token(scope):
            app = RedirectResponse("/" + scope["path"].lstrip("/"), status_code=303)  # //x would lead to another host
            app.set_cookie(self._cookie, self._secret, httponly=True, samesite="strict", path="/")
        elif reason := reason or self._without_cookie(headers):
            if scope["type"] == "websocket":
                await send({"type": "websocket.close", "code": _REFUSED, "reason": reason[:120]})
                return
            app = PlainTextResponse(f"refused: {reason}\n", status_code=403)
        await app(scope, receive, _with_headers(send))

    def _wrong_address(self, headers: Headers, *, needs_origin: bool) -> str:
        host, origin = headers.get("host", ""), headers.get("origin")
        name = _without_port(host)
        if name.lower() not in self._hosts and not (self._by_address and _is_address(name)):
            return f"Host {host!r}: must be one of {', '.join(self._hosts)}"
        if origin is None and not needs_origin:
            return ""
        if origin not in (f"http://{host}", f"https://{host}"):
            return f"Origin {origin!r}: must be the Host's own"
        return ""

    def _has_token(self, scope: MutableMapping[str, Any]) -> bool:
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [""])[0]
        return secrets.compare_digest(given.encode(), self.token.encode())

    def _without_cookie(self, headers: Headers) -> str:
        # Other servers on this host set cookies, too, and not all of them as the standard has it.
        for cookie in headers.get("cookie", "").split(";"):
            name, _, given = cookie.strip().partition("=")
            if name == self._cookie and secrets.compare_digest(given.encode(), self._secret.encode()):
                return ""
        return "no cookie of this lab: open the address that it printed"


def _with_headers(send: Any) -> Any:
    """Return what sends an answer with the headers that all of them have."""

    async def sending(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            MutableHeaders(scope=message).update(HEADERS)
        await send(message)

    return sending


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True


def _without_port(host: str) -> str:
    """Return a Host header's name: localhost of localhost:8000, [::1] of [::1]:8000."""
    name, _, port = host.rpartition(":")
    return name if name and port.isdigit() else host
