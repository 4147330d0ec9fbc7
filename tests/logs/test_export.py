"""Logs as histories: from our logs, and from rosbag2 recordings of the same topics by others."""

from __future__ import annotations

import resource
import subprocess
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
from bridge_tools import TIMEOUT, command, environment, one_error_line, run
from pyarrow import parquet
from pytest import approx
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from rlv_landing import Landing, load_preset
from rlv_landing.errors import LandingError
from rlv_landing.figures.plots import save_overview
from rlv_landing.history import History
from rlv_landing.summary import summarise
from rlv_landing.tables.landing import comparison_table
from rlv_landing.validation.measures import leg_work
from rlv_ros_bridge.logs.history import log_history
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.rows import parts as parts_module
from rlv_ros_bridge.logs.rows.instants import RowChoice
from rlv_ros_bridge.logs.rows.parts import HistoryParts, with_parts
from rlv_ros_bridge.messages.qos import TELEMETRY

START = 1_790_000_000_000_000_000


def same(a: History, b: History) -> None:
    assert a.names == b.names
    assert np.array_equal(a.time, b.time)
    assert np.array_equal(a.data.view(np.uint64), b.data.view(np.uint64))


def recorded_by_others(log: Path, folder: Path, plugin: StoragePlugin, without: str = "") -> Path:
    """A recording of the same topics by another recorder.

    It has its own clock, a different delay for each topic, and one more topic.
    """
    store = get_typestore(Stores.ROS2_JAZZY)
    reader = LogReader(log)
    reader.read_through()
    with Writer(folder, version=9, storage_plugin=plugin) as writer:
        connections = {
            c.topic: writer.add_connection(c.topic, c.type_name, typestore=store)
            for c in reader.channels.values()
            if c.topic != without
        }
        chatter = writer.add_connection("/chatter", "std_msgs/msg/String", typestore=store)
        hello = store.serialize_cdr(
            store.types["std_msgs/msg/String"](data="hello"), "std_msgs/msg/String"
        )
        delay = {topic: 300_000 * i for i, topic in enumerate(connections)}
        for message in sorted(
            reader.messages(connections), key=lambda m: m.log_time + delay[m.topic]
        ):
            writer.write(
                connections[message.topic],
                START + message.log_time + delay[message.topic],
                message.data,
            )
            if message.log_time % 100_000_000 == 0:
                writer.write(chatter, START + message.log_time, bytes(hello))
    return folder


def test_a_log_is_the_landings_history_and_every_plot_and_measure_takes_it(
    log: Path, mode: str, tmp_path: Path
) -> None:
    history = log_history(log)
    landing = Landing(load_preset("yue2022-figures"), mode).run(1.0, 1e-3)
    assert set(history.names) < set(landing.names)
    for name in history:
        assert np.array_equal(history[name], landing[name]), name
    assert history.parameters is not None
    save_overview(history, tmp_path / "log.png", "log")
    assert comparison_table(history, mode) == comparison_table(
        History(landing.time, history.names, pick(landing, history), None), mode
    )
    # between samples the messages do not have what the landing knows: its contacts and its works
    found, expected = summarise(history)["legs"], summarise(landing)["legs"]
    for leg, true in zip(found, expected, strict=True):
        for name, value in true.items():
            if name.partition("_")[0] == "contact" and name.endswith("time"):
                assert abs(leg[name] - value) < 1e-3, name
            elif isinstance(value, float) and name.startswith("main_strut"):
                assert leg[name] == approx(value, rel=1e-3), name
            else:
                assert leg[name] == value, name
    for leg, work in leg_work(history).items():
        assert work.absorbed == approx(leg_work(landing)[leg].absorbed, rel=1e-3)


def thinned_times(history: History, every: float) -> list[float]:
    choice = RowChoice(every=every)
    return [time for time in history.time.tolist() if choice.takes(time)]


def pick(landing: History, history: History) -> np.ndarray:
    return np.column_stack([landing[name] for name in history.names])


@pytest.mark.parametrize("plugin", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_recording_by_another_recorder_gives_the_same_history(
    one_log: Path, tmp_path: Path, plugin: StoragePlugin
) -> None:
    folder = recorded_by_others(one_log, tmp_path / "theirs", plugin)
    found, expected = log_history(folder), log_history(one_log)
    assert found.names == expected.names
    assert np.array_equal(found.data.view(np.uint64), expected.data.view(np.uint64))
    # These recordings do not hold the step, so times are the stamps.
    assert np.array_equal(found.time, np.arange(1001) / 1e3)
    save_overview(found, tmp_path / "theirs.png", "theirs")
    done = run("log", "export", folder, tmp_path / "theirs.csv")
    assert done.returncode == 0, done.stderr
    assert "left aside: " in done.stderr
    assert "/chatter" in done.stderr


def test_a_recording_without_a_topic_is_refused_or_exported_in_part(
    one_log: Path, tmp_path: Path
) -> None:
    folder = recorded_by_others(
        one_log, tmp_path / "theirs", StoragePlugin.SQLITE3, without="/landing/rpy"
    )
    with pytest.raises(
        LandingError,
        match=r"it lacks /landing/rpy; export what is there by --topics struts,pose,twist",
    ):
        log_history(folder)
    history = log_history(folder, ["struts", "/landing/pose"])
    assert len(history) == 1001
    assert "body.x" in history
    assert "body.pitch" not in history


def test_csv_and_parquet_hold_every_digit_the_units_and_the_parameters(
    one_log: Path, tmp_path: Path
) -> None:
    expected = log_history(one_log)
    for name in ("out.csv", "out.parquet"):
        done = run("log", "export", one_log, tmp_path / name)
        assert done.returncode == 0, done.stderr
        assert "1001 instants from 0 s to 1 s, 46 columns" in done.stdout
    lines = (tmp_path / "out.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines[1:]]
    assert [Decimal(row[0]) for row in rows] == [Decimal(k) / 1000 for k in range(1001)]
    data = np.array([[float(x) for x in row[1:]] for row in rows])
    same(History(expected.time, lines[0].split(",")[1:], data), expected)
    table = parquet.read_table(tmp_path / "out.parquet")
    columns = {name: table[name].to_numpy() for name in table.column_names}
    same(
        History(columns.pop("time"), list(columns), np.column_stack(list(columns.values()))),
        expected,
    )
    assert table.schema.field("leg[1].main_strut.force").metadata == {b"unit": b"N"}
    assert b"mass = " in table.schema.metadata[b"parameters.toml"]


def test_topics_span_and_step_choose_rows_and_columns(one_log: Path, tmp_path: Path) -> None:
    arguments = (
        "--topics",
        "rpy,/landing/pose",
        "--start",
        "0.1",
        "--end",
        "0.5",
        "--every",
        "0.01",
    )
    done = run("log", "export", one_log, tmp_path / "part.csv", *arguments)
    assert done.returncode == 0, done.stderr
    rows = (tmp_path / "part.csv").read_text().splitlines()
    assert rows[0] == "time,body.x,body.y,body.pitch"
    assert [round(1e3 * float(row.split(",")[0])) for row in rows[1:]] == list(range(100, 501, 10))
    whole = log_history(one_log)
    # Every 2.5 ms of 1 ms samples: the first instant in each, none interpolated.
    assert np.allclose(thinned_times(whole, 0.0025)[:5], [0.0, 0.003, 0.005, 0.008, 0.01])
    assert thinned_times(whole, 1e-9) == whole.time.tolist()


def test_a_cut_log_is_exported_as_far_as_it_goes(one_log: Path, tmp_path: Path) -> None:
    (whole,) = one_log.glob("*.mcap")
    cut = tmp_path / "cut.mcap.part"
    cut.write_bytes(whole.read_bytes()[: whole.stat().st_size // 2])
    done = run("log", "export", cut, tmp_path / "out.parquet", "--plot", tmp_path / "out.png")
    assert done.returncode == 3
    assert "is cut" in done.stderr
    assert (tmp_path / "out.png").read_bytes().startswith(b"\x89PNG")
    time = parquet.read_table(tmp_path / "out.parquet")["time"].to_numpy()
    assert 0.2 < time[-1] < 0.8


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "nothing to write"),
        (("out.xls",), "out.xls must end in .csv or .parquet"),
        (("there.csv",), "there.csv exists; --force overwrites it"),
        (("nowhere/out.csv",), "there is no folder nowhere"),
        (("out.csv", "--topics", "strut"), "unknown topic 'strut'; did you mean struts?"),
        (("out.csv", "--topics", "markers"), "has no columns; those that have are struts, pose"),
        (
            ("out.csv", "--start", "2"),
            "no instant lies from 2 s to 1 s; the log goes from 0 s to 1 s",
        ),
        (("out.csv", "--every", "0"), "--every = 0 s must be above 0 s"),
        (("out.csv", "--end", "nan"), "--end = nan s must be finite"),
        (("out.csv", "--plot", "out.png", "--topics", "struts"), "--plot needs every topic"),
    ],
)
def test_export_refuses_what_cannot_be_done(
    one_log: Path, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    (tmp_path / "there.csv").write_text("mine")
    done = run("log", "export", one_log, *arguments, cwd=tmp_path)
    assert message in one_error_line(done)
    assert done.returncode == 2
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("there.csv", "mine")]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("log", "export", "{log}", "out.csv"), "out.csv cannot be written: File too large"),
        (("log", "export", "{log}", "out.parquet"), "out.parquet cannot be written: File too"),
        (("view", "{log}", "--save", "out.rrd"), "out.rrd cannot be written: File too large"),
        (("animate", "{log}", "o.mp4", "--end", "0.2"), "o.mp4 cannot be written: ffmpeg ended"),
        (("log", "verify", "{log}", "--fmu", "{fmu}"), "name another folder by TMPDIR"),
    ],
)
def test_a_full_disk_leaves_no_half_file(
    one_log: Path, fmu: Path, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = subprocess.run(
        command(*(a.format(log=one_log, fmu=fmu) for a in arguments)),
        env=environment(),
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)),
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=TIMEOUT,
        check=False,
    )
    assert done.returncode == 2
    assert message in one_error_line(done)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_no_recording_is_refused_in_one_line(tmp_path: Path) -> None:
    broken, lonely = tmp_path / "broken", tmp_path / "lonely.db3"
    broken.mkdir()
    (broken / "metadata.yaml").write_text("nothing: [")
    lonely.write_bytes(b"SQLite format 3\0")
    for path, message in (
        (broken, "holds no .mcap or .db3 file"),
        (lonely, "cannot be read as a rosbag2 recording"),
        (tmp_path / "no", "there is no log"),
    ):
        for subcommand in (("info",), ("verify",), ("export", tmp_path / "out.csv")):
            line = ("log", subcommand[0], path, *subcommand[1:])
            done = run(*line)
            assert message in one_error_line(done)
            assert done.returncode == 2


@pytest.mark.parametrize("size", [1, 7, 500, 10_000])
def test_a_log_read_in_parts_of_any_size_is_the_same(
    one_log: Path, monkeypatch, tmp_path: Path, size: int
) -> None:
    whole = log_history(one_log)
    monkeypatch.setattr(parts_module, "ROWS_AT_ONCE", size)
    found = log_history(one_log)
    same(found, whole)
    assert found.extremes == whole.extremes
    sizes: list[int] = []

    def read(parts: HistoryParts) -> None:
        sizes.extend(len(part) for part in parts)

    with_parts(LogReader(one_log), (), RowChoice(), read)
    assert sum(sizes) == len(whole)
    assert max(sizes) == min(size, len(whole))


def test_a_recording_whose_topics_follow_each_other_is_read_all_the_same(
    one_log: Path, monkeypatch, tmp_path: Path
) -> None:
    """Such as one whose topics are minutes apart: no part of it has all topics."""
    reader = LogReader(one_log)
    messages = list(reader.messages())
    recorder = Recorder(
        tmp_path / "sorted",
        [RecordedTopic(c.topic, c.type_name, TELEMETRY) for c in reader.channels.values()],
        reader.metadata,
        reader.attachments,
    )
    for message in sorted(messages, key=lambda m: m.topic):
        recorder.write(message.topic, message.log_time, message.data)
    recorder.close()
    monkeypatch.setattr(parts_module, "ROWS_AT_ONCE", 100)
    same(log_history(tmp_path / "sorted"), log_history(one_log))
