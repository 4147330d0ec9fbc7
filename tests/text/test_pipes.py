"""Input files that are pipes: they are read, once or again, and never waited for without a word."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from rlv_landing import LandingError
from rlv_landing.signals.interrupts import answer
from rlv_landing.text import pipes
from rlv_landing.text.files import pipes_kept, read_csv, read_text

PIPE_TEXT = 'preset = "yue2022-figures"\n'


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    os.mkfifo(tmp_path / "p")
    return tmp_path / "p"


def write_later(pipe: Path, text: str, when: Callable[[], object] = lambda: None) -> None:
    """Write to the pipe in a thread of its own, after `when` has returned."""

    def write() -> None:
        when()
        pipe.write_text(text)

    threading.Thread(target=write, daemon=True).start()


def test_a_pipe_is_read_each_time_anew_unless_its_text_is_kept(pipe, capsys):
    for text in (PIPE_TEXT, "other = 1\n"):
        write_later(pipe, text)
        assert read_text(pipe, "parameter file") == text
    write_later(pipe, PIPE_TEXT)
    with pipes_kept():
        assert read_text(pipe, "parameter file") == PIPE_TEXT
        assert read_text(pipe, "parameter file") == PIPE_TEXT
    write_later(pipe, "new = 1\n")
    assert read_text(pipe, "parameter file") == "new = 1\n"
    assert capsys.readouterr().err == ""


def test_rows_come_from_a_pipe_and_a_wrong_encoding_of_it_is_reported(pipe):
    write_later(pipe, "a,b\n1,2\n")
    assert list(read_csv(pipe, "table")) == [(1, ["a", "b"]), (2, ["1", "2"])]
    threading.Thread(target=lambda: pipe.write_bytes(b"a,\xff\n"), daemon=True).start()
    with pytest.raises(LandingError, match="it is not UTF-8; save it as UTF-8"):
        list(read_csv(pipe, "table"))


def test_a_wait_for_a_writer_is_reported_once(pipe, monkeypatch, capsys):
    monkeypatch.setattr(pipes, "SILENT_SECONDS", 0.01)
    told, told_of = threading.Event(), []
    monkeypatch.setattr(pipes, "print", lambda *a, **_: (told_of.append(a[0]), told.set()), False)
    write_later(pipe, PIPE_TEXT, told.wait)
    assert read_text(pipe, "parameter file") == PIPE_TEXT
    assert told_of == [f"waiting for {pipe}, to which nothing is written yet; Ctrl-C ends this"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_end_the_wait_even_where_their_handler_only_notes_them(pipe, monkeypatch, number):
    monkeypatch.setattr(pipes, "SILENT_SECONDS", 0.01)
    monkeypatch.setattr(pipes, "print", lambda *_, **__: os.kill(os.getpid(), number), False)
    noted: list[int] = []
    before = signal.signal(number, lambda n, _: noted.append(n))
    try:
        with pytest.raises(KeyboardInterrupt):
            read_text(pipe, "parameter file")
        assert answer() == 128 + number
        os.kill(os.getpid(), number)
    finally:
        signal.signal(number, before)
    assert noted == [number, number]


def test_ctrl_c_ends_a_command_that_waits_with_130(pipe):
    code = "from rlv_landing.text import pipes; pipes.SILENT_SECONDS = 0.1\n"
    code += "from rlv_landing.cli import main; raise SystemExit(main())"
    run = subprocess.Popen(
        [sys.executable, "-c", code, "simulate", "--parameters", str(pipe)],
        stderr=subprocess.PIPE,
        text=True,
    )
    assert run.stderr is not None
    assert run.stderr.readline().startswith(f"waiting for {pipe}")
    run.send_signal(signal.SIGINT)
    assert "interrupted" in run.communicate(timeout=60)[1]
    assert run.returncode == 130


def test_vehicles_and_studies_come_by_process_substitution(tmp_path, command):
    """Each is a pipe by a name such as /dev/fd/63, read twice by `identify`."""

    def substituted(text: str) -> str:
        end, write = os.pipe()
        os.write(write, text.encode())
        os.close(write)
        return f"/dev/fd/{end}"

    vehicle = 'preset = "yue2022-table2"\n[ground]\nfriction = 0.31\n'
    axes = ("--x", "drop.tilt=0..0.1", "--y", "drop.horizontal_velocity=0..0.1")
    coarse = ("--cells", "2", "--levels", "0", "--until", "0.1", "--json")
    work = ("--work", str(tmp_path / "e"))
    done = command("envelope", "--parameters", substituted(vehicle), *axes, *coarse, *work)
    assert done.code in (0, 1), done.err
    assert '"failed": 0' in done.out
    few = ("--evaluations", "1", "--polish", "0", "--workers", "1", "--free", "ground.friction")
    work = ("--work", str(tmp_path / "i"))
    done = command("identify", "--parameters", substituted(vehicle), *few, *work)
    assert done.code in (0, 1), done.err
    assert "yue2022-table2" in (tmp_path / "i" / "identified.toml").read_text()


def test_parameter_files_of_ros_that_are_pipes_are_copied(pipe):
    setup = pytest.importorskip("rlv_ros_bridge.ros.setup")
    write_later(pipe, "/**:\n  ros__parameters:\n    step_size: 0.002\n")
    with setup._regular_files(["--ros-args", "--params-file", str(pipe)]) as own:
        assert own[:2] == ["--ros-args", "--params-file"]
        copy = Path(own[2])
        assert copy.is_file()
        assert "step_size: 0.002" in copy.read_text()
    assert not copy.exists()
