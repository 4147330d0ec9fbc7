"""Nodes ended by a signal at random moments: their logs against what a subscriber received."""

from __future__ import annotations

import json
import random
import signal
import struct
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from bridge_tools import TIMEOUT, Listener, by_topic, new_domain, one_error_line, run, start
from mcap.exceptions import EndOfFile
from mcap.stream_reader import StreamReader
from rosbags.rosbag2 import Reader

from rlv_ros_bridge.logs.history import history_of
from rlv_ros_bridge.logs.reader import LogReader

STRUTS = {"/landing/struts": "sensor_msgs/msg/JointState"}
# The landing that is cut short: longer than any moment that is tried [s].
STOP_TIME = 10
# What may be lost of what was published before the signal [s].
LOSS = 0.5


def stamps(messages: list[bytes]) -> list[float]:
    """The stamps of serialised messages [s]."""
    return [s + ns / 1e9 for s, ns in (struct.unpack_from("<iI", m, 4) for m in messages)]


def ended(
    fmu: Path, folder: Path, number: signal.Signals, received: int, delay: float
) -> tuple[float, int]:
    """Ends a node that records to `folder` by a signal.

    The signal is sent `delay` [s] after a subscriber has received `received` samples. Returns the
    simulation time of the last sample that the subscriber has [s], -1 for none, and the node's
    exit code.
    """
    domain = new_domain()
    listener = Listener(STRUTS, folder.parent, domain, announce=received) if received else None
    waits = ("--wait-for-subscribers", 1) if received else ()
    node = start(
        "node",
        "--fmu",
        fmu,
        "--record",
        folder,
        "--stop-time",
        STOP_TIME,
        *waits,
        domain=domain,
        TMPDIR=str(folder.parent),
    )
    try:
        if listener is not None:
            listener.wait_for_announcement()
        # The delay is the tested quantity; nothing is waited for.
        time.sleep(delay)
        node.send_signal(number)
        node.communicate(timeout=TIMEOUT)
        got = listener.finish(may_crash=number == signal.SIGKILL) if listener is not None else []
        published = stamps(by_topic(got)["/landing/struts"]) if got else []
    finally:
        if listener is not None:
            listener.stop()
        node.kill()
        node.communicate(timeout=TIMEOUT)
    return (published[-1] if published else -1.0), node.returncode


def messages_of_stream_reader(file: Path) -> int:
    """The number of messages that MCAP's own stream reader finds in a file without an end."""
    count = 0
    with file.open("rb") as f:
        records = iter(StreamReader(f).records)
        while True:
            try:
                count += type(next(records)).__name__ == "Message"
            except EndOfFile:
                # The stream reader's own error for a file without an end.
                return count


def last_of(folder: Path) -> float:
    """The last stamp of `struts` in a log [s]; -1 where there is none."""
    found = stamps([m.data for m in LogReader(folder).messages(STRUTS)])
    assert found == sorted(found)
    return found[-1] if found else -1.0


def recovered(folder: Path) -> Path | None:
    """The log that `log recover` makes from a killed node's, opened by rosbags.

    None where nothing whole was left.
    """
    target = folder.with_name("recovered")
    done = run("log", "recover", folder, "--output", target)
    if done.returncode:
        assert (done.returncode, bool(one_error_line(done))) == (2, True)
        return None
    with Reader(target) as reader:
        assert reader.message_count == sum(1 for _ in LogReader(target).messages())
    return target


@pytest.mark.torture
@pytest.mark.parametrize(
    "number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=lambda number: number.name
)
def test_a_node_ended_at_any_moment_leaves_a_log_that_lacks_at_most_half_a_second(
    number: signal.Signals,
    fmu: Path,
    tmp_path: Path,
    many: Callable[[int], int],
    record_property: Callable[[str, object], None],
) -> None:
    losses = []
    for case in range(many(2)):
        generator = random.Random(f"{number.name}-{case}")
        # Every fourth during the start, without a subscriber.
        early = case % 4 == 1
        received, delay = (
            (0, generator.uniform(0.0, 2.5))
            if early
            else (generator.randint(1, 800), generator.uniform(0.0, 0.3))
        )
        folder = tmp_path / f"case-{case}" / "log"
        folder.parent.mkdir()
        published, code = ended(fmu, folder, number, received, delay)
        if early and not (folder.exists() and any(folder.iterdir())):
            continue
        if number is signal.SIGKILL:
            assert code == -number
            (file,) = folder.iterdir()
            assert file.name == "log_0.mcap.part"
            saved = recovered(folder)
            last = -1.0 if saved is None else last_of(saved)
        else:
            assert code == 128 + number or early
            assert not run("log", "info", folder).returncode
            last = last_of(folder)
        losses.append(max(0.0, published - last))
        assert losses[-1] <= (LOSS if number is signal.SIGKILL else 0.0), (
            f"case {case}: {losses[-1]:g} s of {published:g} s are lost"
        )
    record_property("largest loss [s]", max(losses))


def test_info_summarises_the_log_of_a_killed_node(fmu: Path, tmp_path: Path) -> None:
    folder = tmp_path / "log"
    published, _ = ended(fmu, folder, signal.SIGKILL, 1200, 0.0)
    done = run("log", "info", folder, "--json")
    assert done.returncode == 3
    assert (
        done.stderr.strip()
        == f"warning: {folder} is cut: its writer did not finish it; all up to there was read"
    )
    report = json.loads(done.stdout)
    assert not report["complete"]
    assert report["metadata"]["mode"] == "2-2"
    assert published - LOSS <= report["start"] + report["duration"] <= published + 0.1
    (file,) = folder.iterdir()
    assert messages_of_stream_reader(file) == report["messages"]
    assert len(history_of(LogReader(folder))) > 1000 * (published - LOSS)
