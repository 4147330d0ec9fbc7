"""What a log holds, in a few lines."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from .log_reader import Decoder, LogReader
from .topics import JOINTS, STRUTS


@dataclass
class TopicInfo:
    """A topic's name, type, number of messages, and rate [Hz]."""

    name: str
    type: str
    messages: int
    rate: float


@dataclass
class LogInfo:
    """A log's contents. Times in s, size in bytes, forces in N (negative: compression), strokes in m."""

    path: str
    size: int
    complete: bool
    start: float
    duration: float
    messages: int
    topics: list[TopicInfo]
    metadata: dict[str, str]
    attachments: dict[str, int]
    most_compressive_main_strut_force: dict[str, float] = field(default_factory=dict)
    largest_main_strut_stroke: dict[str, float] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """As plain values, for JSON."""
        return asdict(self)

    def text(self) -> str:
        """As lines for people."""
        m = self.metadata
        lines = [
            f"log        {self.path}",
            f"state      {'complete' if self.complete else 'cut: its writer did not finish it'}",
            f"size       {self.size / 1024:.0f} KiB",
            f"start      {self.start:g} s (simulation time)",
            f"duration   {self.duration:g} s",
            f"messages   {self.messages}",
        ]
        known = {
            "mode": m.get("mode"),
            "preset": m.get("preset"),
            "step": f"{m['step_size']} s" if "step_size" in m else None,
            "recorded": m.get("recorded"),
            "versions": ", ".join(f"{k.removeprefix('version_')} {v}" for k, v in m.items() if k.startswith("version_")),
            "fmu": m.get("fmu_guid"),
        }
        lines += [f"{key:<10} {value}" for key, value in known.items() if value]
        lines += [f"{'carries' if i == 0 else '':<10} {n} ({size} bytes)" for i, (n, size) in enumerate(self.attachments.items())]
        if self.topics:
            width = max(len(t.name) for t in self.topics)
            lines += ["", f"{'topic':<{width}}  {'messages':>8}  {'Hz':>7}  type"]
            lines += [f"{t.name:<{width}}  {t.messages:>8}  {t.rate:>7.1f}  {t.type}" for t in self.topics]
        if self.largest_main_strut_stroke:
            lines += ["", f"{'leg':<6} {'main strut force, most compressive':>35}  {'stroke, largest':>16}"]
            for leg, force in self.most_compressive_main_strut_force.items():
                lines.append(f"{leg:<6} {force / 1e3:>32.2f} kN  {self.largest_main_strut_stroke[leg] * 1e3:>13.1f} mm")
        return "\n".join(lines)


def log_info(reader: LogReader) -> LogInfo:
    """Reads the whole log once and sums it up."""
    counts: dict[str, int] = {}
    first, last = None, 0
    forces: dict[str, float] = {}
    strokes: dict[str, float] = {}
    decode = Decoder(reader)
    for message in reader.messages():
        counts[message.topic] = counts.get(message.topic, 0) + 1
        first = message.log_time if first is None else min(first, message.log_time)
        last = max(last, message.log_time)
        if message.topic == f"{reader.namespace}/{STRUTS.name}" and reader.channels[message.topic].type_name == STRUTS.type_name:
            _peaks(decode(message), forces, strokes)
    start = first or 0
    duration = (last - start) / 1e9
    topics = [
        TopicInfo(c.topic, c.type_name, counts.get(c.topic, 0), max(0, counts.get(c.topic, 0) - 1) / duration if duration > 0.0 else 0.0)
        for c in reader.channels.values()
    ]
    return LogInfo(
        path=str(reader.path),
        size=reader.size,
        complete=not reader.cut,
        start=start / 1e9,
        duration=duration,
        messages=sum(counts.values()),
        topics=topics,
        metadata=dict(reader.metadata),
        attachments={name: len(data) for name, data in reader.attachments.items()},
        most_compressive_main_strut_force=forces,
        largest_main_strut_stroke=strokes,
    )


def _peaks(message: Any, forces: dict[str, float], strokes: dict[str, float]) -> None:
    if tuple(message.name) != JOINTS:
        return
    for i, joint in enumerate(JOINTS):
        if joint.endswith("main_strut"):
            leg = joint.removesuffix("_main_strut")
            forces[leg] = min(forces.get(leg, 0.0), message.effort[i])
            strokes[leg] = max(strokes.get(leg, 0.0), message.position[i])
