"""Serves a Rerun viewer to browsers on this machine, and keeps it from talking to anybody else.

Rerun's own program, from its wheel, keeps the data and the viewer's files; it is told to listen on
the loopback address only and to send no statistics. The viewer itself, once in a browser, would ask
for news and report its use; so its files are handed on from here, with a content security policy
that has the browser connect it to nothing but the data.
"""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
import threading
from collections.abc import Mapping
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import TracebackType
from urllib.error import URLError
from urllib.parse import quote, urlsplit
from urllib.request import urlopen

import rerun_cli

from rlv_landing.errors import LandingError

LOOPBACK = "127.0.0.1"
PR_SET_PDEATHSIG = 1
HOSTING = re.compile(rf"web-viewer at (http://{re.escape(LOOPBACK)}:\d+)")
# What late viewers still get, of a landing that is watched for hours.
KEPT = "1GiB"
END_SECONDS = 5.0


def quiet_environment(folder: Path) -> dict[str, str]:
    """The environment in which Rerun's program collects no statistics: with a configuration of its
    own in `folder` that says so.
    """
    kept = ("PATH", "TMPDIR", "LANG", "LD_LIBRARY_PATH")
    mine = {name: os.environ[name] for name in kept if name in os.environ}
    return {
        **mine,
        "HOME": str(folder),
        "XDG_CONFIG_HOME": str(folder),
        "NO_COLOR": "1",
        "TELEMETRY_ENABLED": "false",
        "RUST_LOG": "info",
    }


def program() -> str:
    """Rerun's program."""
    return str(Path(rerun_cli.__file__).with_name("rerun"))


def policy(data_port: int) -> str:
    """The content security policy of the viewer's page: files from where it came from, data from
    `data_port`, and nothing else.
    """
    own = "'self' 'unsafe-inline'"
    return (
        f"default-src {own} 'wasm-unsafe-eval' data: blob:; connect-src 'self' http://{LOOPBACK}:{data_port}; "
        "form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
    )


class ViewerServer:
    """A viewer at `address`, on `port` of the loopback address, for what is sent to `data`; the
    data's port is the next one.

    To be entered. Raises LandingError: a port is taken, or Rerun's program does not run.
    """

    def __init__(self, port: int) -> None:
        self.port, self.data_port = port, port + 1
        for wanted in (self.port, self.data_port):
            require_free(wanted)
        self.data = f"rerun+http://{LOOPBACK}:{self.data_port}/proxy"
        self.address = f"http://{LOOPBACK}:{self.port}/?url={quote(self.data, safe='')}&hide_welcome_screen&theme=light"
        self._folder = Path(tempfile.mkdtemp(prefix="rlv-landing-view-"))
        self._process: subprocess.Popen[str] | None = None
        self._front: ThreadingHTTPServer | None = None

    def __enter__(self) -> ViewerServer:
        try:
            environment = quiet_environment(self._folder)
            subprocess.run(
                [program(), "analytics", "disable"],
                env=environment,
                capture_output=True,
                check=True,
            )
            self._front = front(self.port, self._start(environment), policy(self.data_port))
            threading.Thread(target=self._front.serve_forever, name="viewer", daemon=True).start()
        except (OSError, subprocess.CalledProcessError) as e:
            self.close()
            raise LandingError(
                f'Rerun\'s viewer does not start: {e}; install it again with pip install "rlv-landing[view]"'
            ) from None
        except BaseException:
            self.close()
            raise
        return self

    def _start(self, environment: Mapping[str, str]) -> str:
        """Starts Rerun's program; where it hosts the viewer's files."""
        ports = (
            "--port",
            str(self.data_port),
            "--web-viewer-port",
            "0",
            "--server-memory-limit",
            KEPT,
        )
        self._process = subprocess.Popen(
            [program(), "--serve-web", "--bind", LOOPBACK, *ports],
            env=environment,
            cwd=self._folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            # Ctrl-C is for this command, which ends it in order.
            start_new_session=True,
            preexec_fn=_end_with_parent,
        )
        assert self._process.stdout is not None
        said = ""
        for line in self._process.stdout:
            if found := HOSTING.search(line):
                threading.Thread(
                    target=self._process.stdout.read, name="viewer's words", daemon=True
                ).start()
                return found[1]
            said = line.strip() or said
        raise LandingError(f"Rerun's viewer does not start: {said}")

    def runs(self) -> bool:
        """True. Raises LandingError where Rerun's program has ended by itself."""
        if self._process is not None and self._process.poll() is not None:
            raise LandingError(
                f"Rerun's viewer ended with {self._process.returncode}; start the view again"
            )
        return True

    def close(self) -> None:
        """Ends everything that was started here."""
        if self._front is not None:
            self._front.shutdown()
            self._front.server_close()
        if self._process is not None:
            self._process.terminate()
            try:
                self._process.wait(END_SECONDS)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        shutil.rmtree(self._folder, ignore_errors=True)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def front(port: int, files: str, security: str) -> ThreadingHTTPServer:
    """A server on `port` that hands on what is at `files`, with the content security policy
    `security`.
    """

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            try:
                with urlopen(files + urlsplit(self.path).path) as answer:
                    self.send_response(200)
                    self.send_header("Content-Type", answer.headers["Content-Type"])
                    self.send_header("Content-Security-Policy", security)
                    self.send_header("Referrer-Policy", "no-referrer")
                    self.end_headers()
                    shutil.copyfileobj(answer, self.wfile)
            except URLError:
                self.send_error(404)
            except ConnectionError:
                # The browser has left.
                self.close_connection = True

        def log_message(self, format: str, *args: object) -> None:
            """Nobody wants to read what a browser asks for."""

    return ThreadingHTTPServer((LOOPBACK, port), Handler)


def require_free(port: int) -> None:
    """Raises LandingError where nothing can listen on `port` of the loopback address."""
    if not 1024 <= port <= 65534:
        raise LandingError(f"port = {port} is outside [1024, 65534]")
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
            probe.listen()
        except OSError as e:
            raise LandingError(
                f"port {port} cannot be listened on: {e.strerror}; name another by --port, it and the next are used"
            ) from None


def _end_with_parent() -> None:
    # Else `kill -9` of this command would leave the viewer's program behind.
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
