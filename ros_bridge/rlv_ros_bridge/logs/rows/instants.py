"""The instants of a log in the order of time, and the choice of some of them."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Iterator

from rlv_landing.errors import LandingError

from ...messages.wire import ENCAPSULATION, NANOSECONDS
from ..log_files import shown_time
from ..reader import Decoder, LogMessage

# Instants are whole nanoseconds; a bound given in s may miss one by its last digit [s].
TIME_TOLERANCE = 1e-9
# Messages are looked for from this much before a span to as much behind it, as times in s are
# rounded; and no later than what can be a time at all [s].
MARGIN, LATEST = 1e-6, 1e10
STAMP_BYTES = ENCAPSULATION + 8


class OrderError(Exception):
    """An instant that comes after a later one has been given."""


class RowChoice:
    """Which instants to take: those in a span of time, or one in each period of it.

    Args:
        start: first time [s]; None: the log's.
        end: last time [s], included; None: the log's.
        every: period [s], of which the first instant is taken; None: all. No row is interpolated.

    Raises:
        LandingError: a value is out of bounds.
    """

    def __init__(
        self, start: float | None = None, end: float | None = None, every: float | None = None
    ) -> None:
        for name, value in (("--start", start), ("--end", end), ("--every", every)):
            if value is not None and not math.isfinite(value):
                raise LandingError(f"{name} = {value:g} s must be finite")
        if every is not None and every <= 0.0:
            raise LandingError(f"--every = {every:g} s must be above 0 s")
        self._start, self._end, self._every = start, end, every
        self.reset()

    def reset(self) -> None:
        """Begins anew."""
        self._seen: tuple[float, float] | None = None
        self._origin: float | None = None
        self._period = -1

    @property
    def is_part(self) -> bool:
        """Whether it is of a part of the log's span."""
        return self._start is not None or self._end is not None

    @property
    def is_all(self) -> bool:
        """Whether it takes every instant."""
        return not self.is_part and self._every is None

    @property
    def first(self) -> int:
        """No instant before this time is taken from now on [ns]."""
        if self._every is not None and self._origin is not None:
            return _nanoseconds(self._origin + (self._period + 1) * self._every - MARGIN)
        return 0 if self._start is None else _nanoseconds(self._start - MARGIN)

    @property
    def last(self) -> float:
        """No instant after this time is taken [ns]."""
        return math.inf if self._end is None else _nanoseconds(self._end + MARGIN)

    def wants(self, time: float) -> bool:
        """Whether `takes` would take the instant at `time` [s]."""
        if self._start is not None and time < self._start - TIME_TOLERANCE:
            return False
        if self._end is not None and time > self._end + TIME_TOLERANCE:
            return False
        return self._every is None or self._origin is None or self._at(time) > self._period

    def _at(self, time: float) -> int:
        """The period in which `time` [s] lies."""
        assert self._every is not None
        assert self._origin is not None
        return math.floor((time - self._origin + TIME_TOLERANCE) / self._every)

    def takes(self, time: float) -> bool:
        """Whether to take the instant at `time` [s], which is after all before it."""
        self.note(time)
        if not self.wants(time):
            return False
        if self._every is not None:
            self._origin = time if self._origin is None else self._origin
            self._period = self._at(time)
        return True

    def note(self, time: float) -> None:
        """Notes that there is an instant at `time` [s], for `refuse`."""
        first, last = self._seen or (time, time)
        self._seen = min(first, time), max(last, time)

    def refuse(self) -> None:
        """Refuses the span if there were instants, and none was in it.

        Raises:
            LandingError: so it is.
        """
        if self._seen is not None:
            first, last = self._seen
            start = first if self._start is None else self._start
            end = last if self._end is None else self._end
            raise LandingError(
                f"no instant lies from {start:g} s to {end:g} s; "
                f"the log goes from {shown_time(first)} to {shown_time(last)}"
            )


def _nanoseconds(seconds: float) -> int:
    return math.floor(min(max(seconds, -LATEST), LATEST) * NANOSECONDS)


def instants(
    messages: Iterable[LogMessage], decode: Decoder, window: int
) -> Iterator[tuple[int, dict[str, LogMessage]]]:
    """Messages by their stamps [ns], in the order of these.

    Args:
        messages: each begins with a header.
        decode: decodes the log's messages.
        window: instants by which they may be out of order.

    Raises:
        LandingError: a message cannot be decoded.
        OrderError: a message is out of order by more.
    """
    pending: dict[int, dict[str, LogMessage]] = {}
    given: int | None = None
    for message in messages:
        stamp = _stamp(message, decode)
        if given is not None and stamp <= given:
            raise OrderError
        pending.setdefault(stamp, {})[message.topic] = message
        if len(pending) > 2 * window:
            for given in sorted(pending)[:window]:
                yield given, pending.pop(given)
    for stamp in sorted(pending):
        yield stamp, pending.pop(stamp)


def _stamp(message: LogMessage, decode: Decoder) -> int:
    """The stamp in the header with which a message begins [ns]; it need not be decoded for it."""
    data = message.data
    if len(data) < STAMP_BYTES:
        decode(message)
        raise LandingError(f"a message of {message.topic} is too short for a header")
    # The encapsulation's second byte is the byte order.
    form = "<iI" if data[1] & 1 else ">iI"
    seconds, nanoseconds = struct.unpack_from(form, data, ENCAPSULATION)
    return int(seconds) * NANOSECONDS + int(nanoseconds)
