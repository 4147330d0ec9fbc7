"""Tools for tests of nodes and logs: commands and listeners as processes, ROS domains, fixtures."""

from __future__ import annotations

import itertools
import os
import pickle
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import pytest
from forked import run_forked

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
TIMEOUT = 60.0
# Domains 1 to 100 keep their ports below the ephemeral ones. Each of pytest's workers has its share
# of them; runs of the suite side by side begin at different ones.
_WORKER, _WORKERS = (
    int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:]),
    int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1")),
)
_SHARE = 100 // _WORKERS
_DOMAINS = itertools.cycle(
    _WORKER * _SHARE + (os.getpid() * 37 + i) % _SHARE + 1 for i in range(_SHARE)
)


def new_domain() -> int:
    """A ROS domain that no other test of this run uses at the same time."""
    return next(_DOMAINS)


def environment(domain: int | None = None, **more: str) -> dict[str, str]:
    """The environment of a child process, on the ROS domain `domain` of this machine only."""
    paths = [str(ROOT / "fmu_src"), str(ROOT / "ros_bridge"), os.environ.get("PYTHONPATH", "")]
    return {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(p for p in paths if p),
        "ROS_DOMAIN_ID": str(domain if domain is not None else new_domain()),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        **more,
    }


def command(*arguments: object) -> list[str]:
    """The command line of the bridge's command `arguments`."""
    return [sys.executable, "-m", "rlv_ros_bridge", *map(str, arguments)]


def run(
    *arguments: object, domain: int | None = None, cwd: Path | None = None
) -> subprocess.CompletedProcess[str]:
    """Run a command of the bridge to its end."""
    return run_forked(
        *arguments,
        program="rlv_ros_bridge",
        environment=environment(domain),
        cwd=cwd,
        timeout=TIMEOUT,
    )


def start(*arguments: object, domain: int, **more: str) -> subprocess.Popen[str]:
    """Start a command of the bridge, with `more` in its environment."""
    return subprocess.Popen(
        command(*arguments),
        env=environment(domain, **more),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def record(fmu: Path, folder: Path, *arguments: object) -> Path:
    """A log of a landing as fast as possible."""
    done = run("node", "--fmu", fmu, "--realtime-factor", "0", "--record", folder, *arguments)
    assert done.returncode == 0, done.stderr
    return folder


@dataclass(frozen=True)
class ReceivedMessage:
    """A message that the listener received; both times are Fast DDS's own [ns]."""

    topic: str
    source_time: int
    receive_time: int
    data: bytes


class Listener:
    """Another process that subscribes to topics, reliably, and keeps the bytes that it receives.

    With `expected` it ends once it has received them all. Otherwise it ends when `finish` is called
    and no more messages come.

    Args:
        topics: name -> type.
        folder: where it writes them.
        domain: ROS domain.
        expected: name -> number of messages.
        announce: number of messages of the last topic for `wait_for_announcement`.
    """

    def __init__(
        self,
        topics: Mapping[str, str],
        folder: Path,
        domain: int,
        expected: Mapping[str, int] | None = None,
        announce: int = 0,
    ) -> None:
        self.output = folder / f"received-{domain}.pickle"
        pairs = [f"{name}={kind}={(expected or {}).get(name, 0)}" for name, kind in topics.items()]
        self.process = subprocess.Popen(
            [sys.executable, str(HERE / "listener.py"), str(self.output), str(announce), *pairs],
            env=environment(domain),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self._line() == "listening"

    def _line(self) -> str:
        output: IO[str] | None = self.process.stdout
        assert output is not None
        return output.readline().strip()

    def wait_for_announcement(self) -> None:
        """Waits until `announce` messages of the last topic have been received."""
        assert self._line() == "announced"

    def finish(self, *, may_crash: bool = False) -> list[ReceivedMessage]:
        """The received messages, in the order in which they were sent.

        Args:
            may_crash: Fast DDS may crash a subscriber whose publisher was killed (2 of 200 times).
                What it had received and written counts.
        """
        self.process.communicate(timeout=TIMEOUT)
        code = self.process.returncode
        assert code == 0 or may_crash, f"the listener ended with {code}"
        received = []
        with self.output.open("rb") as file, suppress(EOFError, pickle.UnpicklingError):
            while True:
                received.append(ReceivedMessage(*pickle.load(file)))
        return sorted(received, key=lambda m: m.source_time)

    def stop(self) -> None:
        """Ends the process if it still runs."""
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate(timeout=TIMEOUT)


def by_topic(messages: Sequence[ReceivedMessage]) -> dict[str, list[bytes]]:
    """The bytes of each topic, in order."""
    found: dict[str, list[bytes]] = {}
    for m in messages:
        found.setdefault(m.topic, []).append(m.data)
    return found


def complaints(stderr: str) -> list[str]:
    """The lines on stderr that are not ROS's own information."""
    return [line for line in stderr.splitlines() if line.strip() and not line.startswith("[INFO]")]


def only_stalls(stderr: str) -> bool:
    """Whether nothing is on stderr but warnings of lost wall time, as on a busy machine."""
    return all(
        line.startswith("warning: ") and "lost to stalls" in line for line in complaints(stderr)
    )


def one_error_line(done: subprocess.CompletedProcess[str]) -> str:
    """The only line on stderr, which must be an error for people."""
    lines = complaints(done.stderr)
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("error: ")
    assert "Traceback" not in done.stderr + done.stdout
    return lines[0]


@pytest.fixture
def domain() -> int:
    """A ROS domain of the test's own."""
    return new_domain()


@pytest.fixture
def processes() -> Iterator[list[subprocess.Popen[str]]]:
    """Processes put in here are ended with the test."""
    started: list[subprocess.Popen[str]] = []
    yield started
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate(timeout=TIMEOUT)


@pytest.fixture(scope="session")
def log(fmu: Path, mode: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A complete log of the drop test of `mode`, 1 s at 1 kHz."""
    return record(fmu, tmp_path_factory.mktemp("logs") / f"log-{mode}", "--mode", mode)


@pytest.fixture(scope="session")
def one_log(fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A complete log, for what does not depend on the mode."""
    return record(fmu, tmp_path_factory.mktemp("logs") / "log", "--mode", "2-2")
