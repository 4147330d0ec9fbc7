"""The server of the viewer's page: it passes on the viewer's files, to this machine only.

A page of another site may reach a server on the loopback address by a name of its own that leads
there. So only requests that name this machine are answered.
"""

from __future__ import annotations

import re
import shutil
import sys
from email.message import Message
from http.client import HTTPException
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import urlsplit
from urllib.request import ProxyHandler, build_opener

LOOPBACK = "127.0.0.1"
# This machine's names in a request, with any port: that of the view may be forwarded by another.
OWN_NAME = re.compile(r"(?:127\.0\.0\.1|localhost|\[::1\])(?::\d{1,5})?", re.IGNORECASE)
# What the viewer's files are named.
FILE_NAME = re.compile(r"/[A-Za-z0-9_.-]*")
# Longest waits for a request, and for the viewer's program [s].
REQUEST_SECONDS = 10.0
ANSWER_SECONDS = 30.0


class LoopbackServer(ThreadingHTTPServer):
    """Serves at a port of the loopback address until it is shut down.

    Args:
        port: on the loopback address.
        handler: answers the requests of a connection.

    Raises:
        OSError: the port cannot be listened on.
    """

    daemon_threads = True

    def __init__(self, port: int, handler: type[BaseHTTPRequestHandler]) -> None:
        super().__init__((LOOPBACK, port), handler)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A connection that the browser has closed is no error; others are Python's to show."""
        if not isinstance(sys.exc_info()[1], OSError):
            super().handle_error(request, client_address)


class PageServer(LoopbackServer):
    """Serves the viewer's files at the loopback address until it is shut down.

    Args:
        port: on the loopback address.
        files: address of the viewer's files.
        security_policy: the content security policy of each answer.
        query: what the page is opened with; the bare address leads there.

    Raises:
        OSError: the port cannot be listened on.
    """

    def __init__(self, port: int, files: str, security_policy: str, query: str) -> None:
        self.files, self.security_policy, self.query = files, security_policy, query
        # An address of this machine is not asked for at a proxy.
        self.open = build_opener(ProxyHandler({})).open
        super().__init__(port, _Handler)


class _Handler(BaseHTTPRequestHandler):
    server: PageServer
    timeout = REQUEST_SECONDS

    def do_GET(self) -> None:
        if not names_this_machine(self.headers):
            self.send_error(403, "Ask by the address that the view has printed")
            return
        try:
            asked = urlsplit(self.path)
        except ValueError:
            self.send_error(400)
            return
        if asked.scheme or asked.netloc or not FILE_NAME.fullmatch(asked.path):
            self.send_error(404)
        elif asked.path == "/" and not asked.query:
            self.send_response(302)
            self.send_header("Location", f"/?{self.server.query}")
            self.send_header("Content-Length", "0")
            self.end_headers()
        else:
            self._pass_on(asked.path)

    def _pass_on(self, name: str) -> None:
        """Answers with the viewer's file of this name."""
        try:
            answer = self.server.open(self.server.files + name, timeout=ANSWER_SECONDS)
        except (OSError, HTTPException):
            self.send_error(404)
            return
        self.close_connection = True
        with answer:
            self.send_response(200)
            self.send_header("Content-Type", answer.headers["Content-Type"])
            self.send_header("Content-Security-Policy", self.server.security_policy)
            self.send_header("Referrer-Policy", "no-referrer")
            self.end_headers()
            shutil.copyfileobj(answer, self.wfile)

    def log_message(self, format: str, *args: object) -> None:
        """Requests are not printed."""


def names_this_machine(headers: Message) -> bool:
    """Whether a request's headers name this machine as the host, once."""
    hosts = headers.get_all("Host", [])
    return len(hosts) == 1 and OWN_NAME.fullmatch(str(hosts[0]).strip()) is not None
