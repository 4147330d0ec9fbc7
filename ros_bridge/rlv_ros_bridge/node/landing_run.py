"""One landing: step the FMU, make the messages, record all of them, and hand them on to be
published at their time.
"""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rclpy.serialization import serialize_message

from rlv_landing import Landing
from rlv_landing.presets import to_toml
from rlv_landing.quantities import OUTPUT_NAMES

from ..fmu.runner import FmuRunner
from ..logs.recorder import RecordedTopic, Recorder
from ..messages import topics
from ..messages.markers import Wireframe
from ..messages.qos import LATCHED, Qos
from ..messages.samples import SampleBytes
from ..messages.topics import Topic
from ..messages.transforms import Transforms
from ..messages.wire import padded
from .diagnostics import Health, pace, phase_name
from .input_queue import InputQueue
from .log_metadata import log_metadata
from .pacer import Pacer, spread
from .publisher import LivePublisher, Outlet
from .run_summary import RunSummary
from .settings import Settings

PHASE = OUTPUT_NAMES.index("status.phase")
BALANCE = OUTPUT_NAMES.index("energy.balance")
TOPPLED = 3
# How long the last samples may take to be published while some subscriber takes nothing [s of wall
# time].
LAST_SECONDS = 0.5
# Weight of a new step in the mean of what a step costs.
MEMORY = 1.0 / 32.0
# How long another thread, which answers a service, may keep Python's lock when a sample is due;
# Python's own 5 ms are five samples.
SWITCH_SECONDS = 2e-4


class LandingRun:
    """A landing at time 0, ready to go on.

    Args:
        settings: what to do. `folder`: where to record to, or None.
        live: what publishes; `outlets` are its outlets by topic, `names` the topics' full names.
        inputs: what arrives from outside. `namespace`: the node's, for the log. `tell`: is told of
            an error of the recording.

    Raises:
        LandingError: the FMU is missing, not ours, or refuses the parameters; the log's folder
            cannot be had. Nothing is left behind then.
    """

    def __init__(
        self,
        settings: Settings,
        folder: Path | None,
        live: LivePublisher,
        outlets: Mapping[Topic, Outlet],
        names: Mapping[Topic, str],
        qos: Qos,
        inputs: InputQueue,
        node_name: str,
        namespace: str,
        tell: Callable[[str], object],
    ) -> None:
        self.settings = settings
        self.samples = 0
        self.end = ""
        self.realtime_factor = settings.realtime_factor
        self._folder, self._live, self._outlets, self._names, self._qos = (
            folder,
            live,
            outlets,
            names,
            qos,
        )
        self._inputs, self._namespace, self._tell = inputs, namespace, tell
        self._take_packer(SampleBytes())
        self._wireframe = Wireframe(settings.parameters)
        self._transforms = Transforms(settings.parameters)
        self._health = Health(node_name, settings.mode)
        occasional = (topics.MARKERS, topics.TF, topics.DIAGNOSTICS)
        self._markers_every, self._tf_every, self._diagnostics_every = (
            settings.every[t] for t in occasional
        )
        self._pacer = Pacer(0.0)
        self._work = 0.0
        self._told = False
        self._dropped_before = live.dropped
        self.recorder: Recorder | None = None
        # The vehicle's description, serialised; the log begins with it.
        self.description = b""
        self.fmu = FmuRunner(settings.fmu, dict(settings.parameters.items()))
        inputs.clear(
            settings.step_ns, lambda values: Landing(settings.parameters, inputs=dict(values))
        )
        live.on_published(self._note_published)

    def open_log(self) -> None:
        """Begins the log, where one is wanted; before the first sample.

        Raises LandingError where its folder cannot be had.
        """
        if self._folder is None or self.recorder is not None:
            return
        recorded = [
            RecordedTopic(
                self._names[t], t.type_name, LATCHED if t is topics.ROBOT_DESCRIPTION else self._qos
            )
            for t in topics.RECORDED
        ]
        metadata = log_metadata(self.settings, self._namespace, self.fmu)
        self.recorder = Recorder(
            self._folder,
            recorded,
            metadata,
            {"parameters.toml": to_toml(self.settings.parameters).encode("utf-8")},
        )
        self.recorder.write(self._names[topics.ROBOT_DESCRIPTION], 0, padded(self.description))
        packer = self._packer
        sizes = {
            t: place.stop - place.start
            for t, place in zip(packer.topics, packer.places)
            if t in topics.RECORDED
        }
        heads = self.recorder.begin_samples({self._names[t]: size for t, size in sizes.items()})
        self._take_packer(SampleBytes(dict(zip(sizes, heads))))

    def _take_packer(self, packer: SampleBytes) -> None:
        self._packer = packer
        self._places = [
            (self._outlets[t], place)
            for t, place in zip(packer.topics, packer.places)
            if t in self._outlets
        ]
        # The clock comes first, and is not recorded.
        self._records = slice(packer.places[0].stop, None)

    def go_on(self, interrupted: Callable[[], bool]) -> None:
        """Lands on in its own pace until the end, or until `interrupted` gets true.

        Raises LandingError for a step that the FMU refuses.
        """
        s, pacer, live = self.settings, self._pacer, self._live
        factor = None
        live.look_round()
        # A full collection in mid-landing would be a late step; what is there now stays anyway.
        gc.collect()
        gc.freeze()
        switch_before = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_SECONDS)
        try:
            while not self.end and not interrupted():
                k = self.samples
                if factor != self.realtime_factor:
                    factor = self.realtime_factor
                    pacer.start(k, s.step_size / factor if factor > 0.0 else 0.0)
                started = time.perf_counter()
                values, messages = self._next(k)
                self._work += MEMORY * (time.perf_counter() - started - self._work)
                pacer.hold(k, interrupted)
                live.offer_sample(self._places, messages, k, pacer.due(k))
                self.samples = k + 1
                latest = pacer.due(k + 1) - 1.5 * self._work
                # The sample goes out before what is made now and then.
                live.publish(latest)
                if self._occasional(k, values):
                    live.publish(latest)
        finally:
            pacer.stop()
            sys.setswitchinterval(switch_before)
            gc.unfreeze()
        live.finish(LAST_SECONDS)

    def step(self, count: int) -> None:
        """`count` steps at once; each is published and recorded.

        Raises LandingError for a step that the FMU refuses.
        """
        self._live.look_round()
        goal = max(0, self.samples - 1) + count
        while not self.end and self.samples <= goal:
            k = self.samples
            values, messages = self._next(k)
            self._live.offer_sample(self._places, messages, k, time.perf_counter())
            self._occasional(k, values)
            self.samples = k + 1
            self._live.publish(0.0)
        self._live.finish(LAST_SECONDS)

    @property
    def time(self) -> float:
        """Simulation time of the last sample [s]; 0 before the first."""
        return max(0, self.samples - 1) * self.settings.step_size

    def _next(self, k: int) -> tuple[list[float], bytes]:
        """Sample k and its messages, recorded."""
        s, recorder = self.settings, self.recorder
        # what has come before sample 0 lays the start down
        if k != 1:
            self._take_inputs(max(0, k - 1) * s.step_ns)
        if k:
            self.fmu.step(k - 1, s.step_size)
        values = self.fmu.values()
        toppled = values[PHASE] == TOPPLED
        self.end = "toppled" if toppled else "finished" if k == s.steps else ""
        stamp = k * s.step_ns
        messages = self._packer.pack(stamp, values, k)
        if recorder is not None:
            recorder.write_sample(stamp, messages[self._records])
            recorder.flush()
            if recorder.error and not self._told:
                self._told = True
                self._tell(f"{recorder.error}; the landing goes on unrecorded")
        return values, messages

    def _take_inputs(self, now: int) -> None:
        """What has arrived acts from the simulation time `now` [ns] on."""
        for change in self._inputs.take(now):
            self.fmu.set_inputs(change.values)
            self._say(change.topic, now, padded(serialize_message(change.message())))

    def _occasional(self, k: int, values: Sequence[float]) -> bool:
        """What is not said at each sample; whether anything was."""
        stamp, said = k * self.settings.step_ns, False
        if k % self._markers_every == 0 or self.end:
            self._say(topics.MARKERS, stamp, self._wireframe.pack(stamp, values))
            said = True
        if k % self._tf_every == 0 or self.end:
            self._say(topics.TF, stamp, self._transforms.pack(stamp, values))
            said = True
        if k % self._diagnostics_every == 0 or self.end:
            self._say(topics.DIAGNOSTICS, stamp, padded(serialize_message(self._report(k, values))))
            said = True
        return said

    def _say(self, topic: Topic, stamp: int, data: bytes) -> None:
        if self.recorder is not None:
            self.recorder.write(self._names[topic], stamp, data)
        if topic in self._outlets:
            self._live.offer(self._outlets[topic], data)

    def _note_published(self, due: float) -> None:
        if self._pacer.period:
            self._pacer.note_published(due)

    def _report(self, k: int, values: Sequence[float]) -> Any:
        recorder = self.recorder
        told = {
            "phase": phase_name(values[PHASE]),
            "energy balance [J]": f"{values[BALANCE]:.6g}",
            "samples": str(k + 1),
            **{name: str(count) for name, count in self.fmu.statistics().items()},
            **pace(self._pacer, k * self.settings.step_size),
            "messages not published": str(self.dropped),
            "messages recorded": str(recorder.count if recorder else 0),
            "inputs received": str(self._inputs.received),
            "inputs refused": str(self._inputs.refused),
        }
        problems = {
            "steps late": self._pacer.late_steps,
            "messages not published": self.dropped,
            "inputs refused": self._inputs.refused,
        }
        return self._health.fill(
            k * self.settings.step_ns, told, problems, recorder.error if recorder else ""
        )

    @property
    def dropped(self) -> int:
        """Messages that were recorded, but not published."""
        return self._live.dropped - self._dropped_before

    def summary(self, end: str, signal: int, acknowledged: bool) -> RunSummary:
        """How it went so far."""
        pacer, recorder = self._pacer, self.recorder
        median, p99, largest = spread(pacer.lateness)
        return RunSummary(
            samples=self.samples,
            recorded=recorder.count if recorder else 0,
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
            recording_error=recorder.error if recorder else "",
        )

    def close_log(self) -> None:
        """Completes the log; removes one that nothing was written to."""
        if self.recorder is not None:
            if self.samples:
                self.recorder.close()
            else:
                self.recorder.discard()

    def close(self) -> None:
        """Completes the log and frees the FMU."""
        try:
            self.close_log()
        finally:
            self.fmu.close()
