"""`rlv-landing envelope`: what it writes, prints and refuses, and how it ends."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from math import radians
from pathlib import Path

import pytest
from pytest import approx

from rlv_landing import load_preset
from rlv_landing.studies.envelope.results import record
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy

V, TILT = "drop.horizontal_velocity", "drop.tilt"
STUDY = EnvelopeStudy(
    load_preset("yue2022-figures").with_values({"ground.friction": 0.7, "drop.pitch_rate": 0.0}),
    Axis(V, -6.0, 6.0, 0.75),
    Axis(TILT, radians(-12), radians(12), radians(4)),
    limits={"main_strut.force": 9e3, "contact.force": 2e4},
    cells=2,
    levels=0,
    until=2.0,
)


def options(work: Path, *more: str) -> list[str]:
    """The small study on the command line."""
    return [
        *("envelope", "--work", str(work)),
        *("--set", "ground.friction=0.7", "--set", "drop.pitch_rate=0"),
        *("--x", f"{V}=-6..6", "--y", f"{TILT}=-12 deg..12 deg"),
        *("--tolerance", f"{V}=0.75", "--tolerance", f"{TILT}=4 deg"),
        *("--cells", "2", "--levels", "0", "--until", "2.0"),
        *("--limit", "main_strut.force=9 kN", "--limit", "contact.force=20 kN"),
        *more,
    ]


def test_the_command_writes_what_the_study_found(command: Callable, tmp_path):
    found = envelope(STUDY, 2)
    picture = tmp_path / "e.svg"
    done = command(*options(tmp_path / "w", "--json", "--plot", str(picture)))
    assert done.code == 0
    printed = json.loads(done.out)
    ours = record(found)
    assert printed["landings"] == ours["landings"]
    assert printed["uniform_grid"] == found.uniform
    points = [(c["x"], c["y"]) for line in printed["families"][0]["boundary"] for c in line]
    assert points == [approx((c.x, c.y)) for line in found.families[0].lines for c in line]
    with (tmp_path / "w" / "boundary.csv").open(newline="") as f:
        rows = list(csv.DictReader(f))
    assert [(float(r[V]), float(r[TILT])) for r in rows] == [approx(p) for p in points]
    assert json.loads((tmp_path / "w" / "boundary.json").read_text()) == printed
    drawn = picture.read_text()
    assert all(c.landing.condition in drawn for line in found.families[0].lines for c in line)


def test_a_study_file_gives_the_same_as_options_and_options_win(command: Callable, tmp_path):
    (tmp_path / "study.toml").write_text(
        "[envelope]\ncells = 2\nlevels = 0\nuntil = 1.5\n[set]\nground.friction = 0.1\n"
        f'[x]\nname = "{V}"\nlow = -1.0\nhigh = 1.0\n'
        f'[y]\nname = "{TILT}"\nlow = "-3 deg"\nhigh = "3 deg"\n'
        '[families]\nground.slope = ["0 deg", "2 deg"]\n'
    )
    done = command(
        "envelope", str(tmp_path / "study.toml"), "--work", str(tmp_path / "w"), "--until", "1.0"
    )
    assert done.code == 1
    assert done.out.count("all stable") == 2
    assert "no family has a boundary in this range; widen the axes" in done.err
    assert json.loads((tmp_path / "w" / "boundary.json").read_text())["study"]["until"] == 1.0


def test_all_lost_is_reported(command: Callable, tmp_path):
    done = command(*options(tmp_path / "w", "--input", "external.moment=9000"))
    assert done.code == 1
    assert "all lost" in done.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--x", f"{V}=3"], "write NAME=LOW..HIGH"),
        (["--tolerance", "ground.slope=1"], "ground.slope is not an axis"),
        (["--plot", "picture.jpg"], "picture.jpg must end in .png or .svg or .pdf"),
        (["missing.toml"], "there is no study missing.toml"),
        (["--family", "ground.slope"], "--family 'ground.slope' has no '='"),
        (["--set", "ground.friction"], "quantity 'ground.friction' has no '='"),
        (["--set", "ground.frictoin=0.3"], "did you mean ground.friction"),
        (["--input", "external.force_x=1e9"], "external.force_x = 1e+09 N is outside"),
        (["--limit", "main_strut.force=5 m"], "has the wrong unit"),
        (["--tolerance", "drop.tilt"], "--tolerance 'drop.tilt' has no '='"),
    ],
)
def test_options_that_cannot_be_are_refused_before_anything_lands(
    command: Callable, tmp_path, arguments, message
):
    done = command(*options(tmp_path / "w"), *arguments)
    assert done.code == 2
    assert message in done.err
    assert not (tmp_path / "w").exists()


def test_ctrl_c_keeps_the_landings_and_resume_continues_with_them(command: Callable, tmp_path):
    program = [sys.executable, "-c", "from rlv_landing.cli import main; main()"]
    # an interrupt is ignored in a process that was started in the background
    reset = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    program[2] = reset + program[2]
    running = subprocess.Popen(
        [*program, *options(tmp_path)], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    landings = tmp_path / "landings.jsonl"
    while not landings.exists() or landings.read_bytes().count(b"\n") < 4:
        with suppress(subprocess.TimeoutExpired):
            assert running.wait(0.02) is None
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=60)
    assert running.returncode == 130
    kept = landings.read_bytes().count(b"\n") - 1
    assert f"interrupted; {kept} landings are kept" in errors
    done = command(*options(tmp_path, "--resume", "--json"))
    assert done.code == 0
    assert 0 < kept < json.loads(done.out)["landings"]
