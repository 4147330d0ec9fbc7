"""The ROS 2 node that lands: steps the FMU in real time (or faster, or slower), publishes every sample, and records it."""

from __future__ import annotations

import gc
import platform
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message

from rlv_landing import __version__
from rlv_landing.presets import to_toml
from rlv_landing.quantities import OUTPUT_NAMES

from . import topics
from .builds import build_metadata
from .diagnostics import Health, phase_name
from .fmu_runner import FmuRunner
from .markers import Wireframe
from .message_types import message_class
from .messages import SampleMessages
from .node_settings import Settings, read_settings
from .pacer import Pacer
from .qos import CLOCK, TELEMETRY
from .recorder import RecordedTopic, Recorder
from .ros_setup import StopFlag, ros_context, wait_for_acknowledgement, wait_for_subscribers
from .topics import Topic, resolve

NAMESPACE = "landing"
PHASE = OUTPUT_NAMES.index("status.phase")
BALANCE = OUTPUT_NAMES.index("energy.balance")
TOPPLED = 3
# Services of the node (its parameters, say) are answered this often: one look costs half a millisecond.
SPIN_SECONDS = 0.05


@dataclass(frozen=True)
class RunSummary:
    """How a landing went. `end` is "finished", "toppled" or "interrupted" (by `signal`); lateness and wall time in s."""

    samples: int
    recorded: int
    simulated: float
    wall: float
    late_steps: int
    median_lateness: float
    largest_lateness: float
    lost: float
    folder: Path | None
    end: str
    signal: int
    acknowledged: bool
    recording_error: str

    @property
    def realtime_factor(self) -> float:
        """Simulated seconds per second of wall time."""
        return self.simulated / self.wall if self.wall > 0.0 else 0.0


class LandingNode(Node):
    """Lands once. Its ROS parameters are those of `node_settings`; `changes` are given ones that win over the command line's.

    Raises LandingError for bad parameters.
    """

    def __init__(self, changes: Mapping[str, Any] | None = None, namespace: str = NAMESPACE) -> None:
        given = [Parameter(name, value=value) for name, value in (changes or {}).items()]
        super().__init__("landing_node", namespace=namespace, parameter_overrides=given)
        self._spinner = SingleThreadedExecutor(context=self.context)
        self._spinner.add_node(self)
        self.settings: Settings = read_settings(self)
        # `struts` last: who waits for a match on it finds the others matched.
        self._outlets = {t: self._outlet(t) for t in reversed(topics.RECORDED)}
        self._clock_publisher = self.create_publisher(message_class(topics.CLOCK.type_name), topics.CLOCK.name, CLOCK.profile())
        self._messages = SampleMessages()
        self._wireframe = Wireframe(self.settings.parameters)
        self._health = Health(f"{self.get_fully_qualified_name().strip('/')}", self.settings.mode)
        self._recorder: Recorder | None = None
        self._samples = 0
        self._told = False

    def _outlet(self, topic: Topic) -> tuple[Any, str]:
        name = resolve(self.get_namespace(), topic.name)
        return self.create_publisher(message_class(topic.type_name), name, TELEMETRY.profile()), name

    def land(self, stop: StopFlag) -> RunSummary:
        """The landing, from the sample at time 0 to its end, a signal, or the vehicle's toppling.

        Raises LandingError: FMU missing or not ours, log folder not to be had, no subscribers in time, a step that the FMU refuses.
        """
        s = self.settings
        pacer = Pacer(s.step_size / s.realtime_factor if s.realtime_factor > 0.0 else 0.0)
        with FmuRunner(s.fmu, dict(s.parameters.items())) as fmu:
            self._recorder = self._open_recorder(fmu)
            try:
                wait_for_subscribers(self._outlets[topics.STRUTS][0], s.wait_for_subscribers, s.wait_timeout, self._spinner, stop)
                end = self._loop(fmu, pacer, stop)
            finally:
                wall = pacer.elapsed
                self._close_recorder()
        acknowledged = wait_for_acknowledgement([p for p, _ in self._outlets.values()], interrupted=bool(stop))
        recorder = self._recorder
        return RunSummary(
            samples=self._samples,
            recorded=recorder.count if recorder else 0,
            simulated=max(0, self._samples - 1) * s.step_size,
            wall=wall,
            late_steps=pacer.late_steps,
            median_lateness=pacer.median_lateness(),
            largest_lateness=pacer.largest_lateness(),
            lost=pacer.lost,
            folder=recorder.folder if recorder and recorder.count else None,
            end=end,
            signal=stop.number,
            acknowledged=acknowledged,
            recording_error=recorder.error if recorder else "",
        )

    def _loop(self, fmu: FmuRunner, pacer: Pacer, stop: StopFlag) -> str:
        from tqdm import tqdm

        s = self.settings
        bar_every = max(1, round(0.02 / s.step_size))
        every = {t: max(1, round(t.period / s.step_size)) for t in (topics.MARKERS, topics.DIAGNOSTICS)}
        bar_format = "landing {percentage:3.0f}%|{bar}| {n:.2f}/{total:.2f} s [{elapsed}<{remaining}]"
        # A full collection in mid-landing would be a late step; what is there now stays anyway.
        gc.collect()
        gc.freeze()
        try:
            with tqdm(total=s.steps * s.step_size, disable=not sys.stderr.isatty(), bar_format=bar_format, file=sys.stderr) as bar:
                pacer.start()
                spun = time.perf_counter()
                for k in range(s.steps + 1):
                    if k:
                        fmu.step(k - 1, s.step_size)
                    while not pacer.hold(k):
                        if stop:
                            break
                        self._spinner.spin_once(timeout_sec=0)
                    if stop:
                        return "interrupted"
                    values = fmu.values()
                    toppled = values[PHASE] == TOPPLED
                    last = k == s.steps or toppled
                    self._publish(k * s.step_ns, values, markers=k % every[topics.MARKERS] == 0 or last)
                    if k % every[topics.DIAGNOSTICS] == 0 or last:
                        self._report(k, values, pacer)
                    if toppled:
                        return "toppled"
                    if k % bar_every == 0 or last:
                        bar.update(k * s.step_size - bar.n)
                    if time.perf_counter() - spun > SPIN_SECONDS:
                        self._spinner.spin_once(timeout_sec=0)
                        spun = time.perf_counter()
        finally:
            gc.unfreeze()
        return "finished"

    def _publish(self, stamp: int, values: Sequence[float], markers: bool) -> None:
        messages = self._messages
        messages.fill(stamp, values)
        self._clock_publisher.publish(serialize_message(messages.clock))
        for topic, message in messages.messages:
            self._send(topic, stamp, message)
        if markers:
            self._send(topics.MARKERS, stamp, self._wireframe.fill(stamp, values))
        self._samples += 1
        if self._recorder is not None:
            self._recorder.flush()
            if self._recorder.error and not self._told:
                self._told = True
                self.get_logger().error(f"{self._recorder.error}; the landing goes on unrecorded")

    def _send(self, topic: Topic, stamp: int, message: Any) -> None:
        publisher, name = self._outlets[topic]
        data = serialize_message(message)
        # DDS hands payloads on in whole words: padded here, what is recorded is to the byte what subscribers get.
        if rest := len(data) % 4:
            data += bytes(4 - rest)
        publisher.publish(data)
        if self._recorder is not None:
            self._recorder.write(name, stamp, data)

    def _report(self, k: int, values: Sequence[float], pacer: Pacer) -> None:
        s, recorder = self.settings, self._recorder
        elapsed = pacer.elapsed
        error = recorder.error if recorder else ""
        trouble = error or (f"{pacer.late_steps} steps late" if pacer.late_steps else "")
        told = {
            "phase": phase_name(values[PHASE]),
            "energy balance [J]": f"{values[BALANCE]:.6g}",
            "steps late": str(pacer.late_steps),
            "time lost to stalls [s]": f"{pacer.lost:.3f}",
            "largest lateness [s]": f"{pacer.largest_lateness():.6f}",
            "real-time factor": f"{k * s.step_size / elapsed:.3f}" if elapsed > 0.0 else "0",
            "samples published": str(self._samples),
            "messages recorded": str(recorder.count if recorder else 0),
        }
        stamp = k * s.step_ns
        self._send(topics.DIAGNOSTICS, stamp, self._health.fill(stamp, told, trouble, failed=bool(error)))

    def _open_recorder(self, fmu: FmuRunner) -> Recorder | None:
        s = self.settings
        if s.record is None:
            return None
        # In the order in which they are published, not in that of their making.
        recorded = [RecordedTopic(self._outlets[t][1], t.type_name, TELEMETRY) for t in topics.RECORDED]
        return Recorder(s.record, recorded, self._metadata(fmu), {"parameters.toml": to_toml(s.parameters).encode("utf-8")})

    def _metadata(self, fmu: FmuRunner) -> dict[str, str]:
        s = self.settings
        told = {
            "mode": s.mode,
            "preset": s.preset,
            "step_size": repr(s.step_size),
            "stop_time": repr(s.stop_time),
            "realtime_factor": repr(s.realtime_factor),
            "namespace": self.get_namespace(),
            "recorded": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
            "fmu_guid": fmu.guid,
            "fmu_version": fmu.version,
            "fmu_made_by": fmu.made_by,
            **build_metadata(s.fmu),
            "version_rlv_landing": __version__,
            "version_python": platform.python_version(),
        }
        for package in ("fmpy", "pythonfmu"):
            try:
                told[f"version_{package}"] = version(package)
            except PackageNotFoundError:
                continue
        return told

    def _close_recorder(self) -> None:
        if self._recorder is None:
            return
        if self._recorder.count:
            self._recorder.close()
        else:
            self._recorder.discard()

    def destroy_node(self) -> None:
        """Also lets go of the executor."""
        self._spinner.shutdown()
        super().destroy_node()


def land(changes: Mapping[str, Any], ros_args: Sequence[str], stop: StopFlag, namespace: str = NAMESPACE) -> RunSummary:
    """One landing with the ROS parameters `changes`, in a ROS 2 started for it with `ros_args`. Raises LandingError as the node does."""
    with ros_context(ros_args):
        node = LandingNode(changes, namespace)
        try:
            return node.land(stop)
        finally:
            node.destroy_node()


def main() -> int:
    """For `ros2 run`: everything by ROS parameters."""
    from rlv_landing.errors import LandingError

    try:
        with StopFlag() as stop:
            summary = land({}, sys.argv[1:], stop)
    except LandingError as e:
        print(f"error: {e}", file=sys.stderr)
        return 2
    return 128 + summary.signal if summary.signal else 1 if summary.recording_error else 0
