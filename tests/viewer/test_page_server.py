"""The server of the viewer's page: whom it answers, with what, and that nothing upsets it."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import HTTPServer, SimpleHTTPRequestHandler
from pathlib import Path
from socketserver import BaseServer

import pytest
from bridge_tools import TIMEOUT

from rlv_ros_bridge.viewer.page_server import LOOPBACK, PageServer

QUERY = "url=here&theme=light"


class _Files(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def serving(server: BaseServer) -> Iterator[None]:
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    try:
        yield
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@pytest.fixture
def port(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The port of a page, whose files are served elsewhere, on a machine that has a proxy."""
    (tmp_path / "index.html").write_text("the page")
    (tmp_path / "viewer.wasm").write_bytes(b"\0asm")
    for name in ("http_proxy", "HTTP_PROXY", "all_proxy"):
        monkeypatch.setenv(name, f"http://{LOOPBACK}:1")
    with HTTPServer((LOOPBACK, 0), partial(_Files, directory=str(tmp_path))) as files:
        page = PageServer(0, f"http://{LOOPBACK}:{files.server_port}", "default-src 'self'", QUERY)
        with serving(files), serving(page):
            yield page.server_port


def answer_to(port: int, request: bytes) -> bytes:
    """What the server sends until it closes the connection."""
    with socket.create_connection((LOOPBACK, port), timeout=TIMEOUT) as connection:
        connection.sendall(request)
        connection.shutdown(socket.SHUT_WR)
        return b"".join(iter(lambda: connection.recv(65536), b""))


def ask(port: int, path: str, host: str = "localhost") -> bytes:
    return answer_to(port, f"GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode("latin-1"))


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost:9100", "LocalHost", "[::1]:80"])
def test_this_machine_gets_the_files_with_the_policy_and_no_proxy_is_asked(
    port: int, host: str
) -> None:
    head, _, body = ask(port, f"/?{QUERY}", host).partition(b"\r\n\r\n")
    assert head.split(b" ")[1] == b"200"
    assert b"\r\nContent-Security-Policy: default-src 'self'\r\n" in head
    assert body == b"the page"
    assert ask(port, "/viewer.wasm", host).endswith(b"\0asm")


def test_the_bare_address_leads_to_the_landing(port: int) -> None:
    head = ask(port, "/")
    assert head.split(b" ")[1] == b"302"
    assert f"\r\nLocation: /?{QUERY}\r\n".encode() in head


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1.evil.example", "localhost.evil.example:9090", "0.0.0.0", ""]
)
def test_other_names_are_refused_though_they_lead_here(port: int, host: str) -> None:
    assert ask(port, f"/?{QUERY}", host).split(b" ")[1] == b"403"


@pytest.mark.parametrize(
    ("request_bytes", "code"),
    [
        (b"GET / HTTP/1.1\r\n\r\n", b"403"),
        (b"GET / HTTP/1.1\r\nHost: localhost\r\nHost: evil.example\r\n\r\n", b"403"),
        (b"GET http://[::1 HTTP/1.1\r\nHost: localhost\r\n\r\n", b"400"),
        (b"GET @evil.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"GET //evil.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"GET http://evil.example/ HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"GET /\xff\x00\x07 HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"GET /../../etc/passwd HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"GET /missing HTTP/1.1\r\nHost: localhost\r\n\r\n", b"404"),
        (b"POST / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"501"),
        (b"GET /" + b"a" * 70_000 + b" HTTP/1.1\r\n\r\n", b"414"),
        (b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 200 + b"\r\n", b"431"),
    ],
)
def test_malformed_requests_are_answered_without_a_traceback(
    port: int, capfd: pytest.CaptureFixture[str], request_bytes: bytes, code: bytes
) -> None:
    assert answer_to(port, request_bytes).split(b" ")[1] == code
    assert ask(port, f"/?{QUERY}").endswith(b"the page")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("start", [b"", b"\r\n\r\n", b"\x16\x03\x01\x02\x00", b"GET / HT"])
def test_what_is_no_request_ends_the_connection_only(
    port: int, capfd: pytest.CaptureFixture[str], start: bytes
) -> None:
    answer_to(port, start)
    assert ask(port, f"/?{QUERY}").endswith(b"the page")
    assert capfd.readouterr() == ("", "")
