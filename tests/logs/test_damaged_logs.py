"""Logs that were cut or damaged."""

from __future__ import annotations

import json
import random
import subprocess
from pathlib import Path

from bridge_tools import one_error_line, run

from rlv_landing import Landing, load_preset
from rlv_landing.errors import LandingError
from rlv_landing.summary import OUTCOMES
from rlv_landing.validation.reading import Reading
from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.info import log_info
from rlv_ros_bridge.logs.reader import LogReader


def test_log_info_summarises_a_complete_log(log: Path, mode: str) -> None:
    done = run("log", "info", log, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    report = json.loads(done.stdout)
    assert report["complete"]
    assert (report["start"], report["duration"]) == (0.0, 1.0)
    struts = next(t for t in report["topics"] if t["name"] == "/landing/struts")
    assert struts == {
        "name": "/landing/struts",
        "type": "sensor_msgs/msg/JointState",
        "messages": 1001,
        "rate": 1000.0,
    }
    history = history_of(LogReader(log))
    landing = report["landing"]
    assert (
        landing["outcome"]
        == OUTCOMES[int(Landing(load_preset("yue2022-figures"), mode).run(1.0)["status.phase"][-1])]
    )
    assert landing["bottomed_out"] == []
    for leg in landing["legs"]:
        force, stroke = (
            history.extremes[f"leg[{leg['leg']}].main_strut.{what}"] for what in ("force", "stroke")
        )
        assert leg["main_strut_force_min"] == force.minimum
        assert leg["main_strut_stroke_max"] == stroke.maximum
        assert leg["acceleration_peak"] == Reading(history).acceleration_peak(leg["leg"])
    text = run("log", "info", log).stdout
    for part in (
        "complete",
        f"mode       {mode}",
        "yue2022-figures",
        "/landing/leg_4/contact",
        "after contact",
    ):
        assert part in text


def test_a_log_cut_anywhere_is_read_up_to_there_or_refused_in_one_line(
    one_log: Path, tmp_path: Path
) -> None:
    (whole,) = one_log.glob("*.mcap")
    data = whole.read_bytes()
    cut = tmp_path / "cut.mcap"
    counts: list[int] = []
    refused: list[tuple[int, str]] = []
    for fraction in (0, 4, 8, 20, 40, 0.01, 0.02, 0.1, 0.35, 0.6, 0.9, 0.99, 0.999, -1):
        length = (
            len(data) - 1
            if fraction == -1
            else int(fraction)
            if fraction >= 1 or fraction == 0
            else int(len(data) * fraction)
        )
        cut.write_bytes(data[:length])
        try:
            found = log_info(LogReader(cut))
        except LandingError as e:
            refused.append((length, str(e)))
            continue
        assert not found.complete
        counts.append(found.messages)
    assert counts == sorted(counts)
    assert [length for length, _ in refused] == [0, 4, 8, 20, 40]
    assert not any("\n" in message for _, message in refused)
    assert counts[-1] == sum(1 for _ in LogReader(one_log).messages())


def test_damaged_bytes_never_break_the_reader(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")
    data = whole.read_bytes()[:120_000]
    generator = random.Random(1)
    damaged = tmp_path / "damaged.mcap"
    refused: list[str] = []
    for _ in range(60):
        changed = bytearray(data)
        for _ in range(generator.randrange(1, 20)):
            changed[generator.randrange(8, len(changed))] = generator.randrange(256)
        damaged.write_bytes(changed)
        try:
            reader = LogReader(damaged)
            assert sum(1 for _ in reader.messages()) >= 0
            assert reader.cut
        except LandingError as e:
            refused.append(str(e))
    assert not any("\n" in message for message in refused)


def test_log_info_refuses_what_is_no_log(tmp_path: Path) -> None:
    text, empty, folder = tmp_path / "text.mcap", tmp_path / "empty.mcap", tmp_path / "folder"
    text.write_text("time,force\n0,0\n" * 10)
    empty.touch()
    folder.mkdir()
    for path, message in (
        (tmp_path / "missing", "there is no log"),
        (text, "is not MCAP"),
        (empty, "is empty"),
        (folder, "holds no .mcap or .db3 file"),
    ):
        done: subprocess.CompletedProcess[str] = run("log", "info", path)
        assert message in one_error_line(done)
        assert done.returncode == 2
        assert done.stdout == ""
