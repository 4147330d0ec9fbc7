"""SIGINT at any time of a command's life ends it once, without a traceback; a log is complete."""

from __future__ import annotations

import ctypes
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from bridge_tools import ROOT, TIMEOUT, command, environment
from terminal import Terminal

from rlv_landing.signals.handlers import Handlers, Hold
from rlv_landing.signals.interrupts import Interrupts, answer, interrupts
from rlv_ros_bridge.logs.reader import LogReader

MAIN = (sys.executable, "-c", "from rlv_landing.cli import main; main()")
# of a command's life after its first line [s]
SECONDS = 0.6


def beginning(arguments: list[str]) -> subprocess.Popen[str]:
    """A command of which the first line has run.

    Before it SIGINT is Python's to answer, whose handler the first line replaces.
    """
    process = subprocess.Popen(
        arguments, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    for handled in (True, False):
        while handles(process.pid) is not handled:
            assert process.poll() is None, process.communicate()
            time.sleep(1e-3)
    return process


def handles(pid: int) -> bool:
    """Whether a process handles SIGINT."""
    (caught,) = (
        line.split()[1]
        for line in Path(f"/proc/{pid}/status").read_text().splitlines()
        if line.startswith("SigCgt")
    )
    return bool(int(caught, 16) >> (signal.SIGINT - 1) & 1)


def test_ctrl_c_at_any_time_ends_a_command_once_without_a_traceback_and_with_a_complete_log(
    tmp_path: Path, fmu: Path, many: Callable[[int], int]
) -> None:
    seed = random.randrange(10**6)
    moments = random.Random(seed)
    for i in range(many(8)):
        log = tmp_path / f"log{i}"
        commands = (
            [*MAIN, "validate"],
            [
                *MAIN,
                "envelope",
                str(ROOT / "examples/envelope.toml"),
                "--work",
                str(tmp_path / f"e{i}"),
            ],
            command("node", "--fmu", fmu, "--record", log),
        )
        running = [(beginning(list(words)), moments.uniform(0.0, SECONDS)) for words in commands]
        start = time.monotonic()
        for process, moment in sorted(running, key=lambda r: r[1]):
            time.sleep(max(0.0, start + moment - time.monotonic()))
            process.send_signal(signal.SIGINT)
        for process, moment in running:
            _, err = process.communicate(timeout=TIMEOUT)
            told = f"seed {seed}, round {i}, {moment:.3f} s: {process.args}\n{err}"
            assert process.returncode in (-signal.SIGINT, 130), told
            assert "Traceback" not in err, told
            assert "Exception ignored" not in err, told
        if log.exists():
            assert_complete(log)


def assert_complete(log: Path) -> None:
    reader = LogReader(log)
    reader.read_through()
    assert not reader.cut


def test_a_closed_terminal_ends_a_node_with_a_complete_log(
    tmp_path: Path, fmu: Path, domain: int
) -> None:
    log = tmp_path / "log"
    with Terminal(
        "node", "--fmu", fmu, "--record", log, "--stop-time", 20, domain=domain
    ) as terminal:
        terminal.until("landing   1%")
        assert os.waitstatus_to_exitcode(terminal.close()) == 129
    assert_complete(log)


def raises(number: int) -> None:
    """Send a signal to this process, and wait for what comes of it."""
    signal.raise_signal(number)
    wait_for_interrupt()


def wait_for_interrupt() -> None:
    end = time.monotonic() + TIMEOUT
    while time.monotonic() < end:
        time.sleep(1e-3)
    pytest.fail("no interrupt")


class Losing:
    """Its destructor is interrupted, where Python loses an exception."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)
        for _ in range(1000):
            pass


def lost_in_a_destructor() -> None:
    Losing()


def lost_by_others() -> None:
    # as a library may do
    with suppress(BaseException):
        signal.raise_signal(signal.SIGINT)


def lost_where_it_is_printed() -> None:
    # PyErr_Print, as in functions of Cython that cannot raise; sys.last_value keeps the exception
    ctypes.pythonapi.PyRun_SimpleString(b"__import__('signal').raise_signal(2)")


@pytest.fixture
def open_interrupts() -> Iterator[Interrupts]:
    with interrupts() as come:
        come.open()
        yield come


@pytest.mark.parametrize("lose", [lost_in_a_destructor, lost_by_others, lost_where_it_is_printed])
def test_an_interrupt_that_is_lost_is_raised_again_and_nothing_is_printed(
    open_interrupts: Interrupts, lose: Callable[[], None], capfd: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(KeyboardInterrupt):  # noqa: PT012
        lose()
        wait_for_interrupt()
    assert answer() == 130
    assert capfd.readouterr() == ("", "")


def test_an_import_is_not_interrupted(
    open_interrupts: Interrupts, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "interrupted_module.py").write_text(
        "import signal, time\nsignal.raise_signal(signal.SIGINT)\ntime.sleep(0.05)\nWHOLE = True\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(KeyboardInterrupt):  # noqa: PT012
        import interrupted_module  # type: ignore[import-not-found]

        wait_for_interrupt()
    assert interrupted_module.WHOLE
    answer()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_only_the_first_signal_interrupts_and_gives_the_exit_code(
    open_interrupts: Interrupts, number: signal.Signals
) -> None:
    with pytest.raises(KeyboardInterrupt):
        raises(number)
    code = answer()
    signal.raise_signal(signal.SIGINT)
    time.sleep(0.05)
    assert code == answer() == 128 + number


def test_a_signal_that_is_held_back_follows_and_an_ignored_one_stays_ignored() -> None:
    came: list[int] = []
    outer = Handlers(lambda number, _: came.append(number))
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        outer.set()
        with Hold() as hold:
            for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGINT):
                signal.raise_signal(number)
            assert hold.number == signal.SIGTERM
            assert came == []
        assert came == [signal.SIGTERM]
    finally:
        outer.restore()
        signal.signal(signal.SIGHUP, before)
