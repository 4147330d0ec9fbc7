"""Summarises the contents of a log."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field
from datetime import datetime, timezone
from typing import Any

from rlv_landing.errors import LandingError, one_line
from rlv_landing.quantities import LEGS
from rlv_landing.summary import OUTCOMES, unfinished
from rlv_landing.tables.landing import decimals
from rlv_landing.text.terminal import legible_lines

from ..messages.topics import DIAGNOSTICS
from .history import measured_history
from .landing_record import PHASES, landing_summary, read_landing
from .log_files import WALL_TIME, shown_time
from .lost import lost_text
from .reader import Decoder, LogReader
from .rows.parts import choose_topics

# Characters of a name of a topic or a type that are shown.
LONGEST_NAME = 100

STATES = {
    "summary": "complete by its summary (--check reads all of it)",
    "checked": "complete, every byte of it",
    "whole": "complete; read through, as it has no record of the landing",
}


@dataclass
class TopicInfo:
    """A topic's name, type, number of messages, and rate [Hz]."""

    name: str
    type: str
    messages: int
    rate: float


@dataclass
class LogInfo:
    """The contents of a log.

    Times are in s, `size` in bytes, forces in N (negative: compression), strokes in m.

    `landing` is the result of `rlv_landing.summary`, with `acceleration_peak` [m/s2] for each leg:
    the largest at the top within 12 ms after its contact, None if the log ends before. Its peaks
    are of the log's record of peaks (`peaks_of` is `landing`), without it of the messages
    (`samples`). `landing` is empty where the log holds no landing; `no_landing` is the reason.

    `lost` tells the messages that the recorder left out since its disk took too long.

    `read` says what was read: the `summary`, or all messages (`checked` where that was asked for,
    else `whole`, as the summary did not do).
    """

    path: str
    size: int
    complete: bool
    damage: list[str]
    start: float
    duration: float
    messages: int
    topics: list[TopicInfo]
    metadata: dict[str, str]
    attachments: dict[str, int]
    landing: dict[str, Any] = field(default_factory=dict)
    no_landing: str = ""
    lost: str = ""
    read: str = "whole"

    def as_dict(self) -> dict[str, Any]:
        """The fields as plain values, for JSON."""
        return asdict(self)

    def text(self) -> str:
        """The fields as lines of text."""
        m = self.metadata
        state = (
            STATES[self.read]
            if self.complete
            else "damaged"
            if self.damage
            else "cut: its writer did not finish it"
        )
        lines = [
            f"log        {self.path}",
            f"state      {state}",
            f"size       {self.size / 1024:.0f} KiB",
            f"start      {_start(self.start)}",
            f"duration   {self.duration:g} s",
            f"messages   {self.messages}",
        ]
        known = {
            "mode": m.get("mode"),
            "preset": m.get("preset"),
            "step": f"{m['step_size']} s" if "step_size" in m else None,
            "recorded": m.get("recorded"),
            "versions": ", ".join(
                f"{k.removeprefix('version_')} {v}"
                for k, v in m.items()
                if k.startswith("version_")
            ),
            "fmu": m.get("fmu_guid"),
            "recovered": f"from {m['recovered_from']}" if "recovered_from" in m else None,
            "outcome": self.landing.get("outcome"),
        }
        lines += [f"{key:<10} {value}" for key, value in known.items() if value]
        lines += [
            f"{'carries' if i == 0 else '':<10} {n} ({size} bytes)"
            for i, (n, size) in enumerate(self.attachments.items())
        ]
        lines += [f"landing    {self.no_landing}"] if self.no_landing else []
        lines += [f"missing    {self.lost}: the disk was too slow for them"] if self.lost else []
        lines += [f"{'damage' if i == 0 else '':<10} {text}" for i, text in enumerate(self.damage)]
        if self.topics:
            names = [one_line(t.name, LONGEST_NAME) for t in self.topics]
            width = max(map(len, names))
            lines += ["", f"{'topic':<{width}}  {'messages':>8}  {'Hz':>7}  type"]
            lines += [
                f"{name:<{width}}  {t.messages:>8}  {t.rate:>7.1f}  "
                f"{one_line(t.type, LONGEST_NAME)}"
                for name, t in zip(names, self.topics)
            ]
        return legible_lines([*lines, *(self._peaks() if self.landing else [])])

    def _peaks(self) -> list[str]:
        head = (
            *("leg", "contact", "main strut", "stroke", "auxiliary strut", "ground"),
            "acceleration",
            *("damper", "damper", "damper"),
        )
        widths = (3, 8, 10, 9, 20, 9, 13, 10, 12, 10)
        second = (
            *("", "", "lowest", "largest", "lowest, highest", "largest", "after contact"),
            *("absorbed J", "dissipated J", "efficiency"),
        )
        legs = [_leg_row(leg) for leg in self.landing["legs"]]
        rows: list[tuple[str, ...]] = [head, second, *legs]
        bottomed = ", ".join(map(str, self.landing.get("bottomed_out", [])))
        largest = self.landing["top_axial_acceleration_max"]
        return [
            "",
            *("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows),
            *unfinished(self.landing),
            _origin(self.landing["peaks_of"]),
            f"largest axial acceleration at the top: {largest:.1f} m/s2",
            *([f"bottomed out: main strut of leg {bottomed}"] if bottomed else []),
        ]


def _start(seconds: float) -> str:
    """The first time of a log, and whether it is the landing's or the day's."""
    if seconds < WALL_TIME:
        return f"{shown_time(seconds)} (simulation time)"
    try:
        date = datetime.fromtimestamp(seconds, timezone.utc).isoformat(timespec="milliseconds")
    except (ValueError, OverflowError, OSError):
        return f"{seconds:.9g} s"
    return f"{date} (wall time, by which its writer has stamped it)"


def _origin(peaks_of: str) -> str:
    if peaks_of == "landing":
        return "peaks: of the landing, between its messages too, by the log's record"
    return "peaks: of the messages; the log has no record of those between them"


def _leg_row(leg: Mapping[str, Any]) -> tuple[str, ...]:
    peak = leg.get("acceleration_peak")
    lowest, highest = leg["auxiliary_strut_force_min"], leg["auxiliary_strut_force_max"]
    return (
        str(leg["leg"]),
        "never" if leg["contact_time"] is None else f"{leg['contact_time']:.3f} s",
        f"{leg['main_strut_force_min'] / 1e3:.2f} kN",
        f"{leg['main_strut_stroke_max'] * 1e3:.1f} mm",
        f"{lowest / 1e3:.2f}, {highest / 1e3:.2f} kN",
        f"{leg['contact_force_max'] / 1e3:.2f} kN",
        "-" if peak is None else f"{peak:.1f} m/s2",
        decimals(leg["main_strut_absorbed"], 1),
        decimals(leg["main_strut_dissipated"], 1),
        decimals(leg["main_strut_efficiency"], 3),
    )


def _legs(reader: LogReader) -> tuple[int, ...]:
    """The numbers of the vehicle's legs; four where the log's parameters cannot be read."""
    try:
        return reader.interface.legs
    except LandingError:
        return LEGS


def log_info(reader: LogReader, *, check: bool = False) -> LogInfo:
    """Summarises the log by its summary and its record of the landing.

    A log that lacks one of them is read through, as is each log with `check`.
    """
    if not check and reader.read_summary():
        if (landing := read_landing(reader.landing, _legs(reader))) is not None:
            return _by_summary(reader, landing=landing)
        try:
            choose_topics(reader, ())
        except LandingError as e:
            return _by_summary(reader, no_landing=str(e))
    return _by_messages(reader, checked=check)


def _by_summary(reader: LogReader, **landing: Any) -> LogInfo:
    counts: Counter[str] = Counter()
    spans = []
    for summary in reader.summaries or ():
        statistics = summary.statistics
        counts.update(
            {
                topic: statistics.channel_message_counts.get(number, 0)
                for number, topic in summary.topics.items()
            }
        )
        if statistics.message_count:
            spans.append((statistics.message_start_time, statistics.message_end_time))
    first, last = min((s[0] for s in spans), default=0), max((s[1] for s in spans), default=0)
    return _info(reader, counts, first, last, read="summary", **landing)


def _by_messages(reader: LogReader, *, checked: bool) -> LogInfo:
    counts: Counter[str] = Counter()
    first, last = None, 0
    phase = ""
    decode = Decoder(reader)
    for message in reader.messages():
        counts[message.topic] += 1
        first = message.log_time if first is None else min(first, message.log_time)
        last = max(last, message.log_time)
        if (
            message.topic == DIAGNOSTICS.name
            and reader.channels[message.topic].type_name == DIAGNOSTICS.type_name
        ):
            # Another node's message may come without a definition.
            with suppress(LandingError):
                phase = decode.read(message, _phase) or phase
    read = "checked" if checked else "whole"
    found = _info(reader, counts, first or 0, last, read=read)
    try:
        outcome = OUTCOMES[PHASES.index(phase)] if phase in PHASES else ""
        found.landing = landing_summary(measured_history(reader), outcome)
    except LandingError as e:
        found.no_landing = str(e)
    return found


def _info(
    reader: LogReader, counts: Mapping[str, int], first: int, last: int, **rest: Any
) -> LogInfo:
    duration = (last - first) / 1e9
    topics = [
        TopicInfo(
            c.topic,
            c.type_name,
            counts.get(c.topic, 0),
            max(0, counts.get(c.topic, 0) - 1) / duration if duration > 0.0 else 0.0,
        )
        for c in reader.channels.values()
    ]
    return LogInfo(
        path=str(reader.path),
        size=reader.size,
        complete=not reader.cut,
        damage=list(reader.damage),
        start=first / 1e9,
        duration=duration,
        messages=sum(counts.values()),
        topics=topics,
        metadata=dict(reader.metadata),
        lost=lost_text(reader.gaps),
        attachments={name: len(data) for name, data in reader.attachments.items()},
        **rest,
    )


def _phase(message: Any) -> str:
    """The landing's phase in a message of `/diagnostics`; empty if it is another node's."""
    values = [
        pair
        for status in message.status
        if status.hardware_id.startswith("rlv-landing")
        for pair in status.values
    ]
    return next((str(pair.value) for pair in values if pair.key == "phase"), "")
