"""One landing: steps the FMU, records every sample, and publishes it at its time."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from rclpy.serialization import serialize_message

from rlv_landing import Landing
from rlv_landing.core import Phase

from ..fmu.runner import FmuRunner
from ..logs.landing_record import PHASE
from ..messages import topics
from ..messages.fields import Vehicle
from ..messages.markers import Wireframe
from ..messages.samples import SampleBytes
from ..messages.topics import Topic
from ..messages.transforms import Transforms
from ..messages.wire import padded
from .diagnostics import DiagnosticsMessage, LandingCount
from .input_queue import InputQueue
from .landing_log import LandingLog
from .pacer import Pacer, RunningMean, lateness_percentiles
from .publishing import Publishing
from .run_summary import RunSummary
from .settings import Settings

# Longest time for publishing the last samples while a subscriber takes nothing [s of wall time].
DRAIN_SECONDS = 0.5
# How long another thread, such as one that answers a service, may hold Python's global lock when a
# sample is due [s]. Python's default of 5 ms is the time of five samples.
THREAD_SWITCH_SECONDS = 2e-4
# The longest time between what is recorded and its way to the disk [s of wall time].
FLUSH_SECONDS = 0.25


@dataclass(frozen=True)
class Identity:
    """The node's full name, for `/diagnostics`, and its namespace, for the log."""

    node: str
    namespace: str


class LandingRun:
    """A landing at time 0, ready to run.

    `samples` counts the samples computed. `end` is "finished", "toppled", or empty. `log` is opened
    by `open_log`. `description` is the serialised message of `robot_description`, with which the
    log begins.

    Args:
        settings: the landing's settings.
        folder: log folder, which must not exist; None: no recording.
        publishing: the node's publishers.
        inputs: inputs from other nodes; it is cleared.
        identity: names of the node.
        on_error: called with a text when recording fails.

    Raises:
        LandingError: the FMU is missing, is another model, or refuses the parameters.
    """

    def __init__(
        self,
        settings: Settings,
        *,
        folder: Path | None,
        publishing: Publishing,
        inputs: InputQueue,
        identity: Identity,
        on_error: Callable[[str], object],
    ) -> None:
        self.settings = settings
        self.samples = 0
        self.end = ""
        self.realtime_factor = settings.realtime_factor
        self.log = LandingLog(settings, folder, publishing, identity.namespace, on_error)
        self.description = b""
        self._publishing, self._inputs = publishing, inputs
        self._queue = publishing.queue
        vehicle = Vehicle.of(settings.parameters, settings.frame_prefix)
        self._phase = vehicle.interface.output_names.index(PHASE)
        self._packer = packer = SampleBytes(vehicle)
        self._slices = [
            (publishing.publishers[t], part)
            for t, part in zip(packer.topics, packer.slices)
            if t in publishing.publishers
        ]
        # any outputs but 0, which are no attitude
        any_outputs = [1.0] * len(vehicle.interface.outputs)
        self._start_clock = packer.pack(1, any_outputs)[packer.slices[0]]
        self._wireframe = Wireframe(settings.parameters)
        self._transforms = Transforms(settings.parameters, settings.frame_prefix)
        self._diagnostics = DiagnosticsMessage(identity.node, settings.mode, vehicle.interface)
        self._every = tuple(settings.every[t] for t in topics.OCCASIONAL)
        self._pacer = Pacer(0.0)
        # wall time that computing a sample takes [s]
        self._sample_cost = RunningMean()
        self._flushed = 0.0
        self._dropped_before = self._queue.dropped
        self.fmu = FmuRunner(settings.fmu, dict(settings.parameters.items()))
        inputs.clear(settings.step_ns, lambda values: Landing(settings.parameters, inputs=values))
        self._queue.on_published(self._note_published)

    def open_log(self) -> None:
        """Opens the log, if the landing is to be recorded; before the first sample.

        Raises:
            LandingError: the log's folder exists or cannot be made.
        """
        self.log.open(self.fmu, self.description, self._packer)

    def publish_start_clock(self) -> None:
        """Publishes `/clock`, if the node does, with its value until the landing starts.

        That is 1 ns, also at sample 0: to ROS a clock at 0 has not started, and what waits for it,
        such as a recorder in simulation time, would miss the landing.
        """
        clock = self._publishing.publishers.get(topics.CLOCK)
        if clock is not None:
            clock.publish(self._start_clock)

    def run(self, interrupted: Callable[[], bool]) -> None:
        """Lands at the pace of `realtime_factor` until the end, or `interrupted` returns true.

        Raises:
            LandingError: the FMU refuses a step.
        """
        s, pacer, queue = self.settings, self._pacer, self._queue
        factor = None
        queue.poll_subscriptions()
        # A full garbage collection during the landing would make a step late. What exists now stays
        # in use, so it is taken out of later collections.
        gc.collect()
        gc.freeze()
        switch_before = sys.getswitchinterval()
        sys.setswitchinterval(THREAD_SWITCH_SECONDS)
        try:
            while not self.end and not interrupted():
                k = self.samples
                if factor != self.realtime_factor:
                    factor = self.realtime_factor
                    pacer.start(k, s.step_size / factor if factor > 0.0 else 0.0)
                    # Without a pace, nothing is late that waits for the disk.
                    self.log.wait_for_disk(always=not pacer.period)
                started = time.perf_counter()
                values, messages = self._compute_sample(k)
                cost = time.perf_counter() - started
                self._sample_cost.add(cost)
                pacer.sleep_until_due(k, interrupted)
                queue.enqueue_sample(self._slices, messages, k, pacer.due(k))
                self.samples = k + 1
                latest = pacer.due(k + 1) - 1.5 * self._sample_cost.value
                # The sample is published before the occasional messages are made.
                queue.publish(latest)
                if self._enqueue_occasional(k, values):
                    queue.publish(latest)
                self._flush_at_times(started)
        finally:
            self.log.wait_for_disk(always=True)
            self.log.flush()
            pacer.stop()
            sys.setswitchinterval(switch_before)
            gc.unfreeze()
        queue.drain(DRAIN_SECONDS)

    def step(self, count: int) -> None:
        """Does `count` steps without pacing; each is recorded and published.

        Raises:
            LandingError: the FMU refuses a step.
        """
        self._queue.poll_subscriptions()
        self.log.wait_for_disk(always=True)
        last = max(0, self.samples - 1) + count
        while not self.end and self.samples <= last:
            k = self.samples
            values, messages = self._compute_sample(k)
            self._queue.enqueue_sample(self._slices, messages, k, time.perf_counter())
            self._enqueue_occasional(k, values)
            self.samples = k + 1
            self._queue.publish(0.0)
            self._flush_at_times(time.perf_counter())
        self.log.flush()
        self._queue.drain(DRAIN_SECONDS)

    def _flush_at_times(self, now: float) -> None:
        """Flushes the log every `FLUSH_SECONDS`; `now` is on `time.perf_counter`'s clock [s]."""
        if now - self._flushed >= FLUSH_SECONDS:
            self._flushed = now
            self.log.flush()

    @property
    def time(self) -> float:
        """Simulation time of the last sample [s]; 0 before the first."""
        return max(0, self.samples - 1) * self.settings.step_size

    def _compute_sample(self, k: int) -> tuple[list[float], bytes]:
        """Steps to sample k and records it; its outputs, and its messages if anyone takes them."""
        s = self.settings
        # the inputs of time 0 place the vehicle: they are applied before sample 0
        if k != 1:
            self._apply_inputs(max(0, k - 1) * s.step_ns)
        if k:
            self.fmu.step(k - 1, s.step_size)
        values = self.fmu.values()
        toppled = values[self._phase] == Phase.TOPPLED
        self.end = "toppled" if toppled else "finished" if k == s.steps else ""
        if self.log.recorder is None and not self._queue.has_subscribers:
            return values, b""
        numbers = self._packer.numbers(values)
        self.log.write_sample(k, numbers)
        if not self._queue.has_subscribers:
            return values, b""
        messages = self._packer.pack_numbers(k * s.step_ns, numbers)
        # the clock comes first
        return values, messages if k else self._start_clock + messages[len(self._start_clock) :]

    def _apply_inputs(self, now: int) -> None:
        """Applies and records, at the simulation time `now` [ns], the inputs that have arrived."""
        for change in self._inputs.changes_at(now):
            self.fmu.set_inputs(change.values)
            message = padded(serialize_message(change.message()))
            self._record_and_enqueue(change.topic, now, message)

    def _enqueue_occasional(self, k: int, values: Sequence[float]) -> bool:
        """Makes markers, transforms and diagnostics where they are due; whether any was.

        Those that nobody takes are not made.
        """
        markers, tf, diagnostics = self._every
        if not self.end and k % markers and k % tf and k % diagnostics:
            return False
        stamp = k * self.settings.step_ns
        due: list[tuple[Topic, bytes]] = []
        if (k % markers == 0 or self.end) and self._is_wanted(topics.MARKERS):
            due.append((topics.MARKERS, self._wireframe.pack(stamp, values)))
        if (k % tf == 0 or self.end) and self._is_wanted(topics.TF):
            due.append((topics.TF, self._transforms.pack(stamp, values)))
        if k % diagnostics == 0 or self.end:
            count = self._count(k)
            self._diagnostics.note(stamp, count.problems)
            if self._is_wanted(topics.DIAGNOSTICS):
                message = self._diagnostics.of_landing(
                    stamp, values, count, self._pacer, self.fmu.statistics(), self.log.error
                )
                due.append((topics.DIAGNOSTICS, padded(serialize_message(message))))
        for topic, data in due:
            self._record_and_enqueue(topic, stamp, data)
        return bool(due)

    def _record_and_enqueue(self, topic: Topic, stamp: int, data: bytes) -> None:
        self.log.write(topic, stamp, data)
        publisher = self._publishing.publishers.get(topic)
        if publisher is not None:
            self._queue.enqueue(publisher, data)

    def _note_published(self, due: float) -> None:
        if self._pacer.period:
            self._pacer.note_published(due)

    def _is_wanted(self, topic: Topic) -> bool:
        """Whether messages of `topic` are recorded, or have subscribers."""
        publisher = self._publishing.publishers.get(topic)
        return self.log.recorder is not None or (
            publisher is not None and publisher.has_subscribers
        )

    def _count(self, k: int) -> LandingCount:
        return LandingCount(
            samples=k + 1,
            late=self._pacer.late_steps,
            unpublished=self.dropped,
            recorded=self.log.count,
            unrecorded=self.log.lost,
            received=self._inputs.received,
            refused=self._inputs.refused,
        )

    @property
    def dropped(self) -> int:
        """Messages of this landing that were not published although there were subscribers."""
        return self._queue.dropped - self._dropped_before

    def summary(self, end: str, signal: int, *, acknowledged: bool) -> RunSummary:
        """The figures of the landing so far.

        Args:
            end: "finished", "toppled" or "interrupted".
            signal: number of the signal that interrupted it, or 0.
            acknowledged: whether all reliable subscribers have acknowledged all samples.
        """
        pacer, recorder = self._pacer, self.log.recorder
        median, p99, largest = lateness_percentiles(pacer.lateness)
        return RunSummary(
            samples=self.samples,
            recorded=self.log.count,
            unrecorded=self.log.lost,
            disk_wait=self.log.waited,
            simulated=self.time,
            wall=pacer.elapsed,
            late_steps=pacer.late_steps,
            median_lateness=median,
            p99_lateness=p99,
            largest_lateness=largest,
            lost=pacer.lost,
            dropped=self.dropped,
            folder=recorder.folder if recorder and self.samples else None,
            end=end,
            signal=signal,
            acknowledged=acknowledged,
            recording_error=self.log.error,
        )

    def close_log(self) -> None:
        """Completes the log; removes it if no sample was recorded."""
        self.log.close(self.fmu, self.samples, self.time)

    def close(self) -> None:
        """Completes the log and frees the FMU."""
        try:
            self.close_log()
        finally:
            self.fmu.close()
