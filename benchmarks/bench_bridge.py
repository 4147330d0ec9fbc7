"""Speed, cost and punctuality of the ROS 2 node and the replay.

- As fast as possible: a landing of 10 s in 1 ms steps without subscribers, recorded and not
  recorded; the best of REPEATS. The processor time for each sample, from the first to the last, of
  the landing's thread and of the whole process.
- Its parts: the FMU, the messages' numbers, the messages (made only where someone takes them) and
  the log, each by itself over the same 10 s, in processor time.
- Real time: the node lands at 1 kHz and records, while a subscriber in another process receives
  every sample; a replay plays the log's `struts` to it. They alternate with a loop that only waits
  for the same times: by `time.sleep` as the node, in a busy loop for the last 0.3 ms as the replay.
  The lateness of that loop is the machine's own.

Each run has a process of its own. Prints tables, and appends a row for each case to
`results.jsonl`.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rows import FMU, append_rows, start

from rlv_landing import load_preset
from rlv_ros_bridge.fmu.runner import FmuRunner
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.samples import SampleBytes
from rlv_ros_bridge.messages.topics import SAMPLED
from rlv_ros_bridge.node.pacer import lateness_percentiles

STEP = 1e-3
FAST_SECONDS, REPEATS = 10.0, 5
ROUND_SECONDS, ROUNDS = 2.5, 4
SPIN_SECONDS = 300e-6
# So that nobody else's landing or listener in the ROS domain is taken for one of these.
NAMESPACE = f"bench_{os.getpid()}"

LAND = """
import json, sys, time
from rlv_ros_bridge.node.land import land
from rlv_ros_bridge.node.landing_run import LandingRun
from rlv_ros_bridge.ros.setup import StopFlag

found, run_landing = {}, LandingRun.run

def measured(run, interrupted):
    start = run._pacer.start
    def begin(*arguments):
        found.update(thread=time.thread_time(), process=time.process_time())
        start(*arguments)
    run._pacer.start = begin
    run_landing(run, interrupted)
    found["thread"] = (time.thread_time() - found["thread"]) / run.samples
    found["process"] = (time.process_time() - found["process"]) / run.samples
    found["lateness"] = list(run._pacer.lateness)

LandingRun.run = measured
with StopFlag() as stop:
    summary = land(json.loads(sys.argv[1]), [], stop, sys.argv[2])
found.update(samples=summary.samples, factor=summary.realtime_factor, late_steps=summary.late_steps)
print(json.dumps(found))
"""
REPLAY = """
import json, sys
from rlv_ros_bridge.replay.replay_node import ReplayNode, ReplayOptions, replay
from rlv_ros_bridge.ros.setup import StopFlag

found, play = {}, ReplayNode.play

def measured(node):
    summary = play(node)
    found["lateness"] = list(node._lateness)
    return summary

ReplayNode.play = measured
with StopFlag() as stop:
    replay(ReplayOptions(**json.loads(sys.argv[1])), [], stop)
print(json.dumps(found))
"""
LISTEN = """
import sys
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

received = []
qos = QoSProfile(depth=10000)
with rclpy.init():
    node = Node("bench_listener")
    node.create_subscription(JointState, f"/{sys.argv[2]}/struts", received.append, qos, raw=True)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while len(received) < int(sys.argv[1]):
        executor.spin_once(timeout_sec=0.1)
print(len(received))
"""


def worker(code: str, *arguments: Any) -> list[str]:
    """The command that runs `code`."""
    return [
        sys.executable,
        "-c",
        code,
        *(a if isinstance(a, str) else json.dumps(a) for a in arguments),
    ]


def environment() -> dict[str, str]:
    """A ROS domain that is this process's own."""
    return {**os.environ, "ROS_DOMAIN_ID": str(1 + os.getpid() % 100)}


def run(code: str, options: dict[str, Any], listen: int = 0) -> dict[str, Any]:
    """The worker's result, with a subscriber in another process if `listen` is not 0.

    Args:
        code: the worker's program.
        options: its argument.
        listen: number of samples for which the subscriber waits.
    """
    listener = (
        subprocess.Popen(
            worker(LISTEN, listen, NAMESPACE), env=environment(), stdout=subprocess.PIPE
        )
        if listen
        else None
    )
    try:
        done = subprocess.run(
            worker(code, options, NAMESPACE),
            env=environment(),
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        if listener is not None:
            listener.wait(30.0)
    finally:
        if listener is not None:
            listener.kill()
            listener.communicate()
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def plain_loop(seconds: float, spin: float) -> list[float]:
    """The lateness of a loop that waits for every millisecond and does nothing else [s].

    Args:
        seconds: how long it runs [s].
        spin: the last part of each wait that is a busy loop [s].
    """
    lateness = []
    start = time.perf_counter()
    for k in range(round(seconds / STEP) + 1):
        due = start + k * STEP
        while (left := due - time.perf_counter()) > 0.0:
            if left > spin:
                time.sleep(left - spin)
        lateness.append(-left)
    return lateness


def cost(work: Callable[[], Any]) -> float:
    """Processor time of `work` a sample [s]."""
    start = time.thread_time()
    work()
    return (time.thread_time() - start) / (FAST_SECONDS / STEP)


def parts(folder: Path) -> dict[str, float]:
    """Processor time a sample [s] of the FMU's steps, its values, the messages, and the log."""
    count = round(FAST_SECONDS / STEP)
    samples: list[list[float]] = []
    with FmuRunner(FMU, {}) as fmu:
        steps = cost(lambda: [fmu.step(k, STEP) for k in range(count)])
    with FmuRunner(FMU, {}) as fmu:
        both = cost(
            lambda: [(fmu.step(k, STEP), samples.append(fmu.values())) for k in range(count)]
        )
    vehicle = Vehicle.of(load_preset("yue2022-figures"))
    recorder = Recorder(folder, [RecordedTopic(t.name, t.type_name, TELEMETRY) for t in SAMPLED])
    packer = SampleBytes(vehicle)
    sampled = {t.name: p for t, p in zip(packer.topics, packer.places) if t in SAMPLED}
    recorder.begin_samples(sampled, packer.count)
    numbers: list[list[float]] = []
    work = cost(lambda: numbers.extend(map(packer.numbers, samples)))
    pack = cost(
        lambda: [packer.pack_numbers(k * 1_000_000, sample) for k, sample in enumerate(numbers)]
    )

    def record() -> None:
        for k, sample in enumerate(numbers):
            recorder.write_sample(k, k * 1_000_000, sample)

    log = cost(record)
    recorder.close()
    return {
        "FMU: step": steps,
        "FMU: all outputs": max(0.0, both - steps),
        "numbers of messages": work,
        "messages": pack,
        "log": log,
    }


def fast(folder: Path) -> list[dict[str, Any]]:
    """The landing as fast as possible, and its parts; the best of REPEATS each."""
    best: dict[str, dict[str, float]] = {}
    for i in range(REPEATS):
        for case, record in (("recorded", str(folder / f"fast-{i}")), ("not recorded", "")):
            options = {
                "fmu": str(FMU),
                "realtime_factor": 0.0,
                "step_size": STEP,
                "stop_time": FAST_SECONDS,
                "record": record,
            }
            found = run(LAND, options)
            better = best.setdefault(case, {"factor": 0.0, "thread": 1.0, "process": 1.0})
            better["factor"] = max(better["factor"], found["factor"])
            for key in ("thread", "process"):
                better[key] = min(better[key], found[key])
        for part, seconds in parts(folder / f"parts-{i}").items():
            better = best.setdefault(part, {"thread": 1.0})
            better["thread"] = min(better["thread"], seconds)
    return [{"case": f"bridge fast: {case}", **figures} for case, figures in best.items()]


def punctual(folder: Path) -> list[dict[str, Any]]:
    """Lateness in real time, of all rounds together."""
    lateness: dict[str, list[float]] = {
        "node": [],
        "plain loop, sleeping": [],
        "replay": [],
        "plain loop, awake": [],
    }
    samples = round(ROUND_SECONDS / STEP) + 1
    for i in range(ROUNDS):
        log = str(folder / f"log-{i}")
        options = {
            "fmu": str(FMU),
            "step_size": STEP,
            "stop_time": ROUND_SECONDS,
            "wait_for_subscribers": 1,
        }
        lateness["node"] += run(LAND, {**options, "record": log}, listen=samples)["lateness"]
        lateness["plain loop, sleeping"] += plain_loop(ROUND_SECONDS, 0.0)
        options = {"path": log, "topics": ["struts"], "wait_for_subscribers": 1}
        lateness["replay"] += run(REPLAY, options, listen=samples)["lateness"]
        lateness["plain loop, awake"] += plain_loop(ROUND_SECONDS, SPIN_SECONDS)
    names = ("median", "p99", "largest")
    return [
        {
            "case": f"bridge lateness: {case}",
            "samples": len(v),
            **dict(zip(names, lateness_percentiles(v))),
        }
        for case, v in lateness.items()
    ]


def main() -> None:
    """Runs all cases, prints them, and appends them to the results."""
    load = start().load
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        speeds, figures = fast(Path(name)), punctual(Path(name))
    table = Table(
        title=f"As fast as possible: best of {REPEATS}, load {load:.1f} on {os.cpu_count()} cores",
        title_justify="left",
    )
    for heading in ("case", "times real time", "thread [us]", "process [us]"):
        table.add_column(heading, justify="left" if heading == "case" else "right")
    for row in speeds:
        factor = f"{row['factor']:.1f}" if "factor" in row else ""
        process = f"{1e6 * row['process']:.1f}" if "process" in row else ""
        table.add_row(row["case"].split(": ", 1)[1], factor, f"{1e6 * row['thread']:.1f}", process)
    table.caption = "processor time a sample"
    Console(width=110).print(table)
    table = Table(
        title=f"Lateness at 1 kHz, {ROUNDS} rounds of {ROUND_SECONDS:g} s in turn",
        title_justify="left",
    )
    for heading in ("case", "samples", "median [us]", "99 % [us]", "largest [ms]"):
        table.add_column(heading, justify="left" if heading == "case" else "right")
    for row in figures:
        times = (
            f"{1e6 * row['median']:.0f}",
            f"{1e6 * row['p99']:.0f}",
            f"{1e3 * row['largest']:.2f}",
        )
        table.add_row(row["case"].split(": ", 1)[1], str(row["samples"]), *times)
    Console(width=110).print(table)
    append_rows([{**row, "load": load} for row in (*speeds, *figures)])


if __name__ == "__main__":
    main()
