"""Logs whose writer was killed, and logs that were cut or damaged afterwards."""

from __future__ import annotations

import json
import random
import struct
import subprocess
from contextlib import suppress
from pathlib import Path

from bridge_tools import TIMEOUT, Listener, by_topic, new_domain, one_error_line, run, start
from mcap.exceptions import EndOfFile
from mcap.stream_reader import StreamReader

from rlv_landing import Landing, load_preset
from rlv_landing.errors import LandingError
from rlv_landing.reading import Reading
from rlv_landing.summary import OUTCOMES
from rlv_ros_bridge.log_info import log_info
from rlv_ros_bridge.log_reader import LogReader

STRUTS = {"/landing/struts": "sensor_msgs/msg/JointState"}


def struts_stamps(messages: list[bytes]) -> list[float]:
    return [s + ns / 1e9 for s, ns in (struct.unpack_from("<iI", m, 4) for m in messages)]


def test_a_killed_node_leaves_all_but_the_last_half_second(fmu: Path, tmp_path: Path) -> None:
    domain, folder = new_domain(), tmp_path / "log"
    listener = Listener(STRUTS, tmp_path, domain, announce=1200)
    node = start(
        "node", "--fmu", fmu, "--record", folder, "--stop-time", 20, "--wait-for-subscribers", 1, domain=domain, TMPDIR=str(tmp_path)
    )
    try:
        listener.wait_for_announcement()
        node.kill()
        node.communicate(timeout=TIMEOUT)
        published = struts_stamps(by_topic(listener.finish())["/landing/struts"])[-1]
    finally:
        listener.stop()
        node.kill()
        node.communicate(timeout=TIMEOUT)
    assert published < 19.0
    done = run("log", "info", folder, "--json")
    assert done.returncode == 3
    assert done.stderr.strip() == f"warning: {folder} is cut: its writer did not finish it; all up to there was read"
    told = json.loads(done.stdout)
    assert not told["complete"]
    assert told["metadata"]["mode"] == "2-2"
    assert published - 0.5 < told["start"] + told["duration"] <= published + 0.1
    (file,) = folder.iterdir()
    assert file.name == "log_0.mcap.part"
    assert messages_of_stream_reader(file) == told["messages"]
    assert len(LogReader(folder).history()) > 1000 * (published - 0.5)


def messages_of_stream_reader(file: Path) -> int:
    count = 0
    with file.open("rb") as f:
        records = StreamReader(f).records
        # The stream reader's own word for a file without an end.
        with suppress(EndOfFile):
            for record in records:
                count += type(record).__name__ == "Message"
    return count


def test_log_info_sums_a_complete_log_up(log: Path, mode: str) -> None:
    done = run("log", "info", log, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    told = json.loads(done.stdout)
    assert told["complete"]
    assert (told["start"], told["duration"]) == (0.0, 1.0)
    struts = next(t for t in told["topics"] if t["name"] == "/landing/struts")
    assert struts == {"name": "/landing/struts", "type": "sensor_msgs/msg/JointState", "messages": 1001, "rate": 1000.0}
    history = LogReader(log).history()
    landing = told["landing"]
    assert landing["outcome"] == OUTCOMES[int(Landing(load_preset("yue2022-figures"), mode).run(1.0)["status.phase"][-1])]
    assert landing["bottomed_out"] == []
    for leg in landing["legs"]:
        assert leg["main_strut_force_min"] == history[f"leg[{leg['leg']}].main_strut.force"].min()
        assert leg["main_strut_stroke_max"] == history[f"leg[{leg['leg']}].main_strut.stroke"].max()
        assert leg["acceleration_peak"] == Reading(history).acceleration_peak(leg["leg"])
    text = run("log", "info", log).stdout
    for part in ("complete", f"mode       {mode}", "yue2022-figures", "/landing/leg_4/contact", "after contact"):
        assert part in text


def test_a_log_cut_anywhere_is_read_up_to_there_or_refused_in_one_line(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")
    data = whole.read_bytes()
    cut = tmp_path / "cut.mcap"
    counts: list[int] = []
    refused: list[tuple[int, str]] = []
    for fraction in (0, 4, 8, 20, 40, 0.01, 0.02, 0.1, 0.35, 0.6, 0.9, 0.99, 0.999, -1):
        length = len(data) - 1 if fraction == -1 else int(fraction) if fraction >= 1 or fraction == 0 else int(len(data) * fraction)
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
        spoilt = bytearray(data)
        for _ in range(generator.randrange(1, 20)):
            spoilt[generator.randrange(8, len(spoilt))] = generator.randrange(256)
        damaged.write_bytes(spoilt)
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
        (folder, "holds no .mcap file"),
    ):
        done: subprocess.CompletedProcess[str] = run("log", "info", path)
        assert message in one_error_line(done)
        assert done.returncode == 2
        assert done.stdout == ""
