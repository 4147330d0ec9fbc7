"""Landings as moving pictures: what is in the files, as PIL and ffmpeg see them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from bridge_tools import TIMEOUT, environment, one_error_line, run
from log_tools import in_attachment, rewrite
from numpy.typing import NDArray
from PIL import Image

from rlv_landing.errors import LandingError
from rlv_landing.figures.animation import Film, frame_rows, save_animation
from rlv_landing.figures.wireframe import wireframe
from rlv_landing.history import History
from rlv_ros_bridge.logs.history import log_history
from rlv_ros_bridge.logs.reader import LogReader

FILM = ("--fps", "10", "--slow-motion", "2", "--end", "0.6", "--width", "480")
FRAMES = 13
DARK = 110


def frames_of(path: Path) -> NDArray[np.uint8]:
    """Every frame (n, height, width, 3), by PIL or by ffmpeg."""
    if path.suffix == ".gif":
        with Image.open(path) as image:
            found = []
            for i in range(image.n_frames):
                image.seek(i)
                found.append(np.asarray(image.convert("RGB")))
            return np.stack(found)
    reader = imageio_ffmpeg.read_frames(str(path))
    width, height = next(reader)["size"]
    return np.stack([np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader])


def places_of_the_mark(frames: NDArray[np.uint8]) -> NDArray[np.intp]:
    """The pixel column of the time mark in each frame.

    It is the one in the right half that is darkest beyond what is dark in all frames.
    """
    half = frames.shape[2] // 2
    dark = (255.0 - frames[:, :, half:].max(axis=3)).sum(axis=1)
    return half + np.argmax(dark - dark.min(axis=0), axis=1)


@pytest.mark.parametrize("ending", [".gif", ".mp4"])
def test_a_log_becomes_an_animation_whose_mark_moves_evenly_and_whose_vehicle_moves(
    log: Path, tmp_path: Path, ending: str
) -> None:
    film = tmp_path / f"landing{ending}"
    done = run("animate", log, film, *FILM)
    assert done.returncode == 0, done.stderr
    assert [p.name for p in tmp_path.iterdir()] == [film.name]
    if ending == ".mp4":
        assert imageio_ffmpeg.count_frames_and_secs(str(film)) == (
            FRAMES,
            pytest.approx(FRAMES / 10),
        )
    else:
        with Image.open(film) as image:
            times = [(image.seek(i), image.info["duration"])[1] for i in range(image.n_frames)]
        assert times == [100] * FRAMES
    frames = frames_of(film)
    assert len(frames) == FRAMES
    # at the first and the last frame the mark lies on the edge
    places = places_of_the_mark(frames)[1:-1]
    steps = np.arange(1, FRAMES - 1)
    slope, first = np.polyfit(steps, places, 1)
    assert slope > 10.0
    assert np.abs(places - (slope * steps + first)).max() <= 2.0
    left = frames[:, frames.shape[1] // 8 :, : frames.shape[2] * 2 // 5].astype(int)
    assert all((np.abs(b - a).max(axis=-1) > DARK).sum() > 20 for a, b in pairwise(left[:8]))


@pytest.mark.parametrize("view", ["side", "3d"])
def test_a_landing_becomes_an_animation_without_a_log(tmp_path: Path, mode: str, view: str) -> None:
    film = tmp_path / "landing.gif"
    done = run("animate", "--mode", mode, film, "--view", view, *FILM)
    assert done.returncode == 0, done.stderr
    assert f"{FRAMES} frames at 10 a second, 2 times slower" in done.stdout
    assert frames_of(film).shape == (FRAMES, 264, 480, 3)


def test_footpads_where_the_struts_meet_are_the_models_footpads(drop_test: History) -> None:
    rows = np.arange(len(drop_test))
    lines = wireframe(drop_test, drop_test.parameters, rows)
    for leg in (1, 2, 3, 4):
        model = np.stack([drop_test[f"leg[{leg}].footpad.{axis}"] for axis in "xyz"], axis=-1)
        # rounding of coordinates of a few metres
        assert np.abs(lines["feet"][:, leg - 1, 0] - model).max() < 1e-14
        for part, strut in (("main", "main_strut"), ("auxiliary", "auxiliary_strut")):
            joint, foot = np.moveaxis(lines[part][:, leg - 1], 1, 0)
            length = (
                getattr(drop_test.parameters, strut).length
                - drop_test[f"leg[{leg}].{strut}.stroke"]
            )
            assert np.abs(np.linalg.norm(foot - joint, axis=-1) - length).max() < 1e-14


def test_every_frame_shows_the_sample_nearest_to_its_time() -> None:
    time = np.array([0.0, 0.1, 0.13, 0.5, 0.9])
    history = History(time, ("a",), np.zeros((5, 1)))
    wanted = 0.1 + np.arange(9) / 10.0
    rows = frame_rows(history, Film(slow_motion=1.0, start=0.1, end=0.9), 10.0)
    assert np.array_equal(rows, [np.argmin(np.abs(time - t)) for t in wanted])


def test_a_gif_reports_the_frame_rate_that_it_can_hold(tmp_path: Path, drop_test: History) -> None:
    made = save_animation(
        drop_test,
        drop_test.parameters,
        tmp_path / "l.gif",
        "",
        Film(fps=30.0, slow_motion=1.0, end=0.2, width=320),
    )
    assert made.fps == pytest.approx(100 / 3)
    with Image.open(tmp_path / "l.gif") as image:
        assert image.info["duration"] == 30
        assert image.n_frames == made.frames == 7


def test_a_log_without_parameters_takes_those_that_are_named(one_log: Path, tmp_path: Path) -> None:
    bare, whole = tmp_path / "bare" / "log", tmp_path / "whole" / "log"
    for folder, kept in ((bare, False), (whole, True)):
        folder.parent.mkdir()
        rewrite(
            LogReader(one_log).files[0],
            folder,
            in_attachment(lambda data, kept=kept: data if kept else None),
        )
    assert log_history(bare).parameters is None
    refused = run("animate", bare, tmp_path / "l.gif", *FILM)
    assert (refused.returncode, "--preset and --mode" in one_error_line(refused)) == (2, True)
    done = run("animate", bare, tmp_path / "l.gif", "--mode", "2-2", *FILM)
    assert done.returncode == 0, done.stderr
    run("animate", whole, tmp_path / "own.gif", *FILM)
    assert (tmp_path / "l.gif").read_bytes() == (tmp_path / "own.gif").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("l.avi",), "must end in .gif or .mp4"),
        ((), "name one to write"),
        (("a", "b", "c.gif"), "3 files given"),
        (("there.gif",), "exists; --force overwrites it"),
        (("no/l.gif",), "there is no folder"),
        (("nolog", "l.gif"), "nolog"),
        (("l.gif", "--fps", "0"), "fps = 0 is outside [1, 120]"),
        (("l.gif", "--fps", "nan"), "fps = nan is outside"),
        (("l.gif", "--slow-motion", "-1"), "slow motion = -1 is outside"),
        (("l.gif", "--width", "10"), "width = 10 is outside [320, 3840] pixels"),
        (("l.gif", "--start", "0.5", "--end", "0.4"), "start before end"),
        (("l.gif", "--end", "nan"), "--end = nan s is outside"),
        (("l.gif", "--fps", "100", "--slow-motion", "100"), "frames; 2 to 3000 can be"),
        (("l.gif", "--mode", "3-1"), "3-1"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_leaves_nothing(
    tmp_path: Path, arguments: tuple[str, ...], expected: str
) -> None:
    (tmp_path / "there.gif").write_bytes(b"mine")
    done = run("animate", *arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert expected in one_error_line(done)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("there.gif", b"mine")]


def test_a_log_with_parameters_of_its_own_takes_no_others(one_log: Path, tmp_path: Path) -> None:
    assert "carries its parameters" in one_error_line(
        run("animate", one_log, tmp_path / "l.gif", "--mode", "1-2-1")
    )


def test_without_ffmpeg_the_error_says_what_to_install(
    tmp_path: Path, drop_test: History, monkeypatch: pytest.MonkeyPatch
) -> None:  # fmt: skip
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(LandingError, match=r'pip install "rlv-landing\[video\]", or write a \.gif'):
        save_animation(drop_test, drop_test.parameters, tmp_path / "l.mp4", "")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)]
)
def test_a_signal_leaves_no_unfinished_animation(
    tmp_path: Path, number: signal.Signals, code: int
) -> None:
    program = [
        sys.executable,
        "-c",
        "from rlv_landing.cli import main; main()",
        "animate",
        "--mode",
        "2-2",
        str(tmp_path / "l.mp4"),
    ]
    options = ["--slow-motion", "100", "--width", "320"]
    process = subprocess.Popen(
        [*program, *options],
        env=environment(),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + TIMEOUT
    while not list(tmp_path.iterdir()):
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.01)
    os.killpg(process.pid, number)
    _, stderr = process.communicate(timeout=TIMEOUT)
    assert process.returncode == code
    assert [line for line in stderr.splitlines() if "Traceback" in line or "error" in line] == []
    assert stderr.splitlines()[-1] == "interrupted"
    assert not list(tmp_path.iterdir())
