"""The server of the viewer's data: it passes requests on to Rerun's program, those of this machine.

Rerun's own server answers whatever host a request names, and so pages of other sites that reach it
by a name of their own. It listens at an address of this machine that no such page knows.
"""

from __future__ import annotations

import select
import socket
from http.server import BaseHTTPRequestHandler

from .page_server import REQUEST_SECONDS, LoopbackServer, names_this_machine

# A browser asks with a few hundred bytes; more is another's [bytes].
LARGEST_REQUEST = 4 * 1024 * 1024
COPY_BYTES = 64 * 1024
# Headers that are of one connection only.
OF_A_CONNECTION = {"connection", "keep-alive", "proxy-connection", "te", "upgrade", "expect"}


class DataServer(LoopbackServer):
    """Serves the viewer's data at the loopback address until it is shut down.

    Args:
        port: on the loopback address.
        source: address and port of Rerun's server.

    Raises:
        OSError: the port cannot be listened on.
    """

    def __init__(self, port: int, source: tuple[str, int]) -> None:
        self.source = source
        super().__init__(port, _Handler)


class _Handler(BaseHTTPRequestHandler):
    """One request of a connection, which is closed behind it."""

    server: DataServer
    timeout = REQUEST_SECONDS

    def do_GET(self) -> None:
        self._answer()

    def do_POST(self) -> None:
        self._answer()

    def do_OPTIONS(self) -> None:
        self._answer()

    def _answer(self) -> None:
        if not names_this_machine(self.headers):
            self.send_error(403, "Ask by the address that the view has printed")
            return
        length = self.headers.get("Content-Length", "0")
        if "Transfer-Encoding" in self.headers or not length.isdecimal():
            self.send_error(411)
            return
        if len(length) > 9 or int(length) > LARGEST_REQUEST:
            self.send_error(413)
            return
        body = self.rfile.read(int(length))
        try:
            source = socket.create_connection(self.server.source, timeout=REQUEST_SECONDS)
        except OSError:
            self.send_error(502)
            return
        with source:
            source.sendall(self._request() + body)
            _pass_on(source, self.connection)

    def _request(self) -> bytes:
        """The request's head, as of a connection that ends with it."""
        kept = [
            f"{name}: {value}"
            for name, value in self.headers.items()
            if name.lower() not in OF_A_CONNECTION
        ]
        lines = [f"{self.command} {self.path} HTTP/1.1", *kept, "Connection: close", "", ""]
        return "\r\n".join(lines).encode("latin-1")

    def log_message(self, format: str, *args: object) -> None:
        """Requests are not printed."""


def _pass_on(source: socket.socket, client: socket.socket) -> None:
    """Passes on what comes from `source` until it, or the client, ends."""
    # A browser that is slow, or waits for a landing, is waited for.
    source.settimeout(None)
    client.settimeout(None)
    while True:
        ready, _, _ = select.select([source, client], [], [])
        if source in ready:
            if not (data := source.recv(COPY_BYTES)):
                return
            client.sendall(data)
        elif not client.recv(COPY_BYTES):
            return
