"""The log of a landing: opened before its first sample, completed with its records at the end."""

from __future__ import annotations

import platform
from collections.abc import Callable, Sequence
from datetime import datetime, timezone
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from rlv_landing import LandingError, __version__
from rlv_landing.presets import to_toml

from ..fmu.builds import build_metadata
from ..fmu.runner import FmuRunner
from ..logs.landing_record import LandingRows
from ..logs.peaks import peak_texts
from ..logs.recorder import RecordedTopic, Recorder
from ..messages import topics
from ..messages.samples import SampleBytes
from ..messages.topics import Topic, topics_of
from ..messages.wire import padded
from .publishing import Publishing
from .settings import Settings


class LandingLog:
    """The log of a landing; it does nothing where nothing is recorded.

    `recorder` is None until it is opened, and where nothing is recorded.

    Args:
        settings: the landing's settings.
        folder: the log's folder, which must not exist; None: no recording.
        publishing: the node's publishers: names and quality of service of the topics.
        namespace: the node's namespace.
        on_error: called once with a text when recording fails, and when the first messages are
            left out since the disk takes too long.
    """

    def __init__(
        self,
        settings: Settings,
        folder: Path | None,
        publishing: Publishing,
        namespace: str,
        on_error: Callable[[str], object],
    ) -> None:
        self.recorder: Recorder | None = None
        self._settings, self._folder, self._publishing = settings, folder, publishing
        self._namespace, self._on_error = namespace, on_error
        self._error_reported = self._loss_reported = False
        self._rows = LandingRows(settings.parameters)

    def open(self, fmu: FmuRunner, description: bytes, packer: SampleBytes) -> None:
        """Opens the log, if the landing is to be recorded and it is not open.

        Args:
            fmu: the landing's FMU.
            description: the serialised message of `robot_description`, with which the log begins.
            packer: what makes the samples' numbers.

        Raises:
            LandingError: the log's folder exists or cannot be made.
        """
        if self._folder is None or self.recorder is not None:
            return
        names, qos = self._publishing.names, self._publishing.qos
        of_landing = topics_of(packer.vehicle.interface.legs).recorded
        recorded = [
            RecordedTopic(
                names[t],
                t.type_name,
                qos[t],
                # Without its inputs a landing cannot be repeated.
                kept=t in (topics.ROBOT_DESCRIPTION, *topics.APPLIED),
            )
            for t in of_landing
        ]
        self.recorder = Recorder(
            self._folder,
            recorded,
            _metadata(self._settings, self._namespace, fmu),
            {"parameters.toml": to_toml(self._settings.parameters).encode("utf-8")},
        )
        self.recorder.write(names[topics.ROBOT_DESCRIPTION], 0, padded(description))
        sampled = {names[t]: p for t, p in zip(packer.topics, packer.places) if t in of_landing}
        self.recorder.begin_samples(sampled, packer.count, self._take)

    def _take(self, samples: NDArray[Any]) -> None:
        """Takes samples, whose numbers begin with the outputs, for the landing's summary."""
        self._rows.add(samples["sequence"] * self._settings.step_size, samples["numbers"])

    def write_sample(self, k: int, numbers: Sequence[float]) -> None:
        """Writes the messages of sample `k` by its `numbers`, see `SampleBytes.numbers`."""
        if self.recorder is not None:
            self.recorder.write_sample(k, k * self._settings.step_ns, numbers)

    def _report(self, recorder: Recorder) -> None:
        """Reports, once each, that recording has failed, and that messages were left out."""
        if recorder.error and not self._error_reported:
            self._error_reported = True
            self._on_error(f"{recorder.error}; the landing continues without recording")
        if recorder.lost and not self._loss_reported:
            self._loss_reported = True
            self._on_error(
                f"the disk of {recorder.folder} is slower than the landing: messages are missing "
                "from the log; set log_must_be_complete, and the landing waits"
            )

    def wait_for_disk(self, *, always: bool) -> None:
        """From now on waits where the disk takes too long `always`, or if the settings say so."""
        if self.recorder is not None:
            self.recorder.must_wait = always or self._settings.log_must_be_complete

    def flush(self) -> None:
        """Hands what was written to the disk; after all messages of a sample."""
        if self.recorder is not None:
            self.recorder.flush()
            self._report(self.recorder)

    def write(self, topic: Topic, stamp: int, data: bytes) -> None:
        """Writes a message with the time `stamp` [ns]."""
        if self.recorder is not None:
            self.recorder.write(self._publishing.names[topic], stamp, data)

    @property
    def count(self) -> int:
        """The number of messages written."""
        return self.recorder.count if self.recorder else 0

    @property
    def lost(self) -> int:
        """The number of messages that were left out since the disk took too long."""
        return self.recorder.lost if self.recorder else 0

    @property
    def waited(self) -> float:
        """The time for which the landing has waited for the disk [s]."""
        return self.recorder.waited if self.recorder else 0.0

    @property
    def error(self) -> str:
        """Why recording has failed; empty where it has not."""
        return self.recorder.error if self.recorder else ""

    def close(self, fmu: FmuRunner, samples: int, time: float) -> None:
        """Completes the log; removes it if no sample was recorded.

        Args:
            fmu: the landing's FMU.
            samples: the number of samples.
            time: simulation time of the last one [s].
        """
        if self.recorder is not None:
            if samples:
                self.recorder.close(*self._end_records(fmu, time))
            else:
                self.recorder.discard()

    def _end_records(self, fmu: FmuRunner, time: float) -> tuple[dict[str, str], dict[str, str]]:
        """The records of peaks and landing; empty where the FMU has failed, or is freed."""
        try:
            peaks = fmu.peaks()
        except LandingError:
            return {}, {}
        found = {name.removeprefix("peak."): peak for name, peak in peaks.items()}
        return peak_texts(peaks, time), self._rows.texts(found)


def _metadata(settings: Settings, namespace: str, fmu: FmuRunner) -> dict[str, str]:
    """What is needed to repeat the run, as texts by name.

    Args:
        settings: the landing's settings.
        namespace: namespace of the node and its topics.
        fmu: the FMU that computes the landing.
    """
    metadata = {
        "mode": settings.mode,
        "preset": settings.preset,
        "step_size": repr(settings.step_size),
        "stop_time": repr(settings.stop_time),
        "realtime_factor": repr(settings.realtime_factor),
        "namespace": namespace,
        "frame_prefix": settings.frame_prefix,
        "recorded": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "fmu_guid": fmu.guid,
        "fmu_version": fmu.version,
        "fmu_made_by": fmu.made_by,
        "fmu_core": "compiled" if fmu.is_compiled() else "not compiled",
        "version_rlv_landing": __version__,
        "version_python": platform.python_version(),
        **build_metadata(settings.fmu),
    }
    for package in ("fmpy", "pythonfmu"):
        try:
            metadata[f"version_{package}"] = version(package)
        except PackageNotFoundError:
            continue
    return metadata
