"""A log's records of the messages that it lacks, since its disk took too long for them.

There is a metadata record for each gap, before the chunk that follows it. `messages` and `samples`
are their numbers, `first` and `last` the times of the messages [ns].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from rlv_landing.errors import LandingError

RECORD = "rlv_landing_lost"


@dataclass(frozen=True)
class Gap:
    """A span of times of which a log lacks messages.

    `messages` and `samples` are numbers, `first` and `last` times [ns].
    """

    messages: int
    samples: int
    first: int
    last: int

    def and_then(self, other: Gap) -> Gap:
        """The gap with one that follows it."""
        return Gap(
            self.messages + other.messages,
            self.samples + other.samples,
            min(self.first, other.first),
            max(self.last, other.last),
        )

    def texts(self) -> dict[str, str]:
        """The record's texts by name."""
        return {name: str(number) for name, number in asdict(self).items()}


def read_gap(texts: Mapping[str, str], where: str) -> Gap:
    """The gap in a record.

    Args:
        texts: the record.
        where: the log's name, for errors.

    Raises:
        LandingError: a text is not what the record's layout says.
    """
    try:
        gap = Gap(**{name: int(texts[name]) for name in Gap.__dataclass_fields__})
    except (KeyError, ValueError):
        gap = None
    if gap is None or gap.messages < 1 or gap.samples < 0 or gap.first > gap.last:
        raise LandingError(
            f"{where}: its record of lost messages is {dict(texts)!r}, "
            "which is not its layout; it was changed"
        )
    return gap


def lost_text(gaps: Sequence[Gap]) -> str:
    """The gaps in words; empty where there are none."""
    if not gaps:
        return ""
    messages = sum(gap.messages for gap in gaps)
    first, last = gaps[0].first / 1e9, gaps[-1].last / 1e9
    spans = f"in {len(gaps)} gaps between" if len(gaps) > 1 else "from"
    return f"{messages} messages {spans} {first:g} s {'and' if len(gaps) > 1 else 'to'} {last:g} s"
