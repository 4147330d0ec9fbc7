"""The server of the viewer's data: whom it answers, and that data come as they are sent."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import pytest
from bridge_tools import TIMEOUT
from test_page_server import answer_to, serving

from rlv_ros_bridge.viewer.data_server import LARGEST_REQUEST, DataServer
from rlv_ros_bridge.viewer.page_server import LOOPBACK

ANSWER = b"HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n"


class _Source:
    """Stands for Rerun's program: keeps a request's bytes, and answers in parts when told to."""

    def __init__(self) -> None:
        self.listener = socket.create_server((LOOPBACK, 0))
        self.address = (LOOPBACK, self.listener.getsockname()[1])
        self.requests: list[bytes] = []
        self.go_on, self.left = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=self._answer, daemon=True)
        self.thread.start()

    def _answer(self) -> None:
        connection, _ = self.listener.accept()
        with connection:
            connection.settimeout(TIMEOUT)
            request = b""
            while not request.endswith(b"the body"):
                request += connection.recv(65536)
            self.requests.append(request)
            connection.sendall(ANSWER + b"first")
            if self.go_on.wait(TIMEOUT):
                connection.sendall(b" second")
                return
            self.left.set()


@pytest.fixture
def source() -> Iterator[_Source]:
    made = _Source()
    yield made
    made.listener.close()


@pytest.fixture
def port(source: _Source) -> Iterator[int]:
    with serving(server := DataServer(0, source.address)):
        yield server.server_port


def post(host: str, *headers: str, path: str = "/rerun.Service/ReadMessages") -> bytes:
    lines = [f"POST {path} HTTP/1.1", f"Host: {host}", *headers, "", "the body"]
    return "\r\n".join(lines).encode()


@pytest.mark.parametrize("host", ["127.0.0.1:9091", "localhost:9101", "[::1]:80"])
def test_a_request_of_this_machine_is_passed_on_and_answered_as_the_data_come(
    source: _Source, port: int, host: str
) -> None:
    with socket.create_connection((LOOPBACK, port), timeout=TIMEOUT) as connection:
        kept = ("Origin: http://127.0.0.1:9090", "Content-Type: application/grpc-web+proto")
        connection.sendall(post(host, "Connection: keep-alive", "Content-Length: 8", *kept))
        received = b""
        while not received.endswith(b"first"):
            received += connection.recv(65536)
        assert received == ANSWER + b"first"
        source.go_on.set()
        assert b"".join(iter(lambda: connection.recv(65536), b"")) == b" second"
    head, _, body = source.requests[0].partition(b"\r\n\r\n")
    assert body == b"the body"
    lines = head.decode().split("\r\n")
    assert lines[0] == "POST /rerun.Service/ReadMessages HTTP/1.1"
    assert f"Host: {host}" in lines
    assert set(kept) < set(lines)
    assert [line for line in lines if line.startswith("Connection")] == ["Connection: close"]


@pytest.mark.parametrize(
    ("request_bytes", "status"),
    [
        (post("evil.example", "Content-Length: 8"), b"403"),
        (post("127.0.0.1.evil.example:9091", "Content-Length: 8"), b"403"),
        (post("localhost", "Host: evil.example", "Content-Length: 8"), b"403"),
        (b"POST / HTTP/1.1\r\nContent-Length: 8\r\n\r\nthe body", b"403"),
        (post("localhost", "Transfer-Encoding: chunked"), b"411"),
        (post("localhost", "Content-Length: -8"), b"411"),
        (post("localhost", f"Content-Length: {LARGEST_REQUEST + 1}"), b"413"),
        (post("localhost", f"Content-Length: {'9' * 5000}"), b"413"),
        (b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", b"505"),
        (b"DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"501"),
    ],
)
def test_what_names_another_host_or_is_no_request_of_a_browser_never_reaches_the_source(
    source: _Source, port: int, request_bytes: bytes, status: bytes
) -> None:
    assert b"Error code: " + status in answer_to(port, request_bytes)
    assert not source.requests
