"""Serves a Rerun viewer to browsers on this machine, without connections to other machines.

Rerun's program, from its wheel, keeps the data and the viewer's files. It sends no statistics, and
listens at one of this machine's own addresses only, a random one of 127.0.0.0/8, since it answers
every site's page that finds it. The viewer in a browser would fetch news and report its use. So a
server here passes on its files with a content security policy, by which the browser connects it to
the data only, and another passes on the data.
"""

from __future__ import annotations

import ctypes
import os
import random
import re
import signal
import socket
import subprocess
import threading
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from urllib.parse import quote

import rerun_cli

from rlv_landing.errors import LandingError, reason_of

from ..fmu.folder import ProcessFolder
from .data_server import DataServer
from .page_server import LOOPBACK, PageServer

PR_SET_PDEATHSIG = 1
FOLDER_PREFIX = "rlv-landing-view-"
# What Rerun's program prints with the address of the viewer's files.
ADDRESS_LINE = re.compile(r"web-viewer at (http://127\.\d+\.\d+\.\d+:\d+)")
# Memory for the data that a browser gets which connects late.
MEMORY_LIMIT = "1GiB"
# Longest wait for Rerun's program to end [s].
TERMINATE_SECONDS = 5.0


def private_environment(folder: Path) -> dict[str, str]:
    """The environment of Rerun's program.

    Its configuration, in `folder`, has the program send no statistics.
    """
    kept = ("PATH", "TMPDIR", "LANG", "LD_LIBRARY_PATH")
    return {
        **{name: os.environ[name] for name in kept if name in os.environ},
        "HOME": str(folder),
        "XDG_CONFIG_HOME": str(folder),
        "NO_COLOR": "1",
        "TELEMETRY_ENABLED": "false",
        "RUST_LOG": "info",
    }


def rerun_program() -> str:
    """The path of Rerun's program."""
    return str(Path(rerun_cli.__file__).with_name("rerun"))


def content_security_policy(data_port: int) -> str:
    """The policy of the viewer's page: files from its own server, data from `data_port`."""
    own = "'self' 'unsafe-inline'"
    return (
        f"default-src {own} 'wasm-unsafe-eval' data: blob:; "
        f"connect-src 'self' http://{LOOPBACK}:{data_port}; "
        "form-action 'none'; base-uri 'none'; frame-ancestors 'none'"
    )


class ViewerServer:
    """A viewer at `address`, to be entered, for the data that is sent to `data`.

    `data` is Rerun's own address. A browser gets them at the data's port of the loopback address.

    Args:
        port: of the page, on the loopback address; the data's port is the next one.

    Raises:
        LandingError: a port is in use, or Rerun's program does not start.
    """

    def __init__(self, port: int) -> None:
        self.port, self.data_port = port, port + 1
        for wanted in (self.port, self.data_port):
            require_free(wanted)
        address = _own_address()
        self._source = address, _free_port(address)
        self.data = _data_address(*self._source)
        shown = _data_address(LOOPBACK, self.data_port)
        self._query = f"url={quote(shown, safe='')}&hide_welcome_screen&theme=light"
        self.address = f"http://{LOOPBACK}:{self.port}/?{self._query}"
        self._folder = ProcessFolder(FOLDER_PREFIX)
        self._process: subprocess.Popen[str] | None = None
        self._servers: list[PageServer | DataServer] = []

    def __enter__(self) -> ViewerServer:
        try:
            environment = private_environment(self._folder.path)
            subprocess.run(
                [rerun_program(), "analytics", "disable"],
                env=environment,
                capture_output=True,
                check=True,
            )
            files = self._start(environment)
            policy = content_security_policy(self.data_port)
            self._serve(PageServer(self.port, files, policy, self._query))
            self._serve(DataServer(self.data_port, self._source))
        except (OSError, subprocess.CalledProcessError) as e:
            self.close()
            raise LandingError(
                f"Rerun's viewer does not start: {reason_of(e)}; "
                'install it again with pip install "rlv-landing[view]"'
            ) from None
        except BaseException:
            self.close()
            raise
        return self

    def _serve(self, server: PageServer | DataServer) -> None:
        self._servers.append(server)
        threading.Thread(target=server.serve_forever, name="viewer", daemon=True).start()

    def _start(self, environment: Mapping[str, str]) -> str:
        """Starts Rerun's program; the address of the viewer's files."""
        options = {
            "--bind": self._source[0],
            "--port": str(self._source[1]),
            "--web-viewer-port": "0",
            "--server-memory-limit": MEMORY_LIMIT,
        }
        arguments = [text for option in options.items() for text in option]
        self._process = subprocess.Popen(
            [rerun_program(), "--serve-web", *arguments],
            env=environment,
            cwd=self._folder.path,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            # Ctrl-C reaches this command only, which then ends the program.
            start_new_session=True,
            preexec_fn=_end_with_parent,
        )
        output = self._process.stdout
        assert output is not None
        last_line = ""
        for line in output:
            if found := ADDRESS_LINE.search(line):
                threading.Thread(target=output.read, name="viewer output", daemon=True).start()
                return found[1]
            last_line = line.strip() or last_line
        raise LandingError(f"Rerun's viewer does not start: {last_line}")

    def check_running(self) -> bool:
        """Returns true while Rerun's program runs.

        Raises:
            LandingError: it has ended by itself.
        """
        if self._process is not None and self._process.poll() is not None:
            raise LandingError(
                f"Rerun's viewer ended with {self._process.returncode}; start the view again"
            )
        return True

    def close(self) -> None:
        """Ends everything that was started."""
        for server in self._servers:
            server.shutdown()
            server.server_close()
        self._servers.clear()
        if self._process is not None:
            self._process.terminate()
            try:
                self._process.wait(TERMINATE_SECONDS)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._folder.remove()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _own_address() -> str:
    """An address of 127.0.0.0/8, all of which are this machine's, that none can guess."""
    drawn = random.SystemRandom()
    return ".".join(["127", *(str(drawn.randint(1, 254)) for _ in range(3))])


def _free_port(address: str) -> int:
    """A port of `address` that is free."""
    with socket.socket() as probe:
        probe.bind((address, 0))
        return int(probe.getsockname()[1])


def _data_address(address: str, port: int) -> str:
    return f"rerun+http://{address}:{port}/proxy"


def require_free(port: int) -> None:
    """Checks that `port` of the loopback address can be listened on.

    Raises:
        LandingError: it cannot, or is out of bounds.
    """
    if not 1024 <= port <= 65534:
        raise LandingError(f"port = {port} is outside [1024, 65534]")
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((LOOPBACK, port))
            probe.listen()
        except OSError as e:
            raise LandingError(
                f"port {port} cannot be listened on: {e.strerror}; "
                "name another by --port, it and the next are used"
            ) from None


def _end_with_parent() -> None:
    # `kill -9` of this command would otherwise leave the viewer's program running.
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
