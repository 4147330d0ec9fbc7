"""Publishes serialised messages without holding up the landing: as time allows, from a bounded
queue.

rclpy keeps Python's lock while it writes, so a thread of its own would stop the landing as long as
the write does. So the landing's own thread publishes, between a sample and the next step. A write
to a subscriber that is frozen takes some fifteen times as long as others: while it is so, only the
time that the next step leaves is written in, and the oldest messages are dropped and counted.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

# One second of everything at 1 kHz.
QUEUE_MESSAGES = 16_000
# How often it is asked whether anybody listens [s].
LOOK_ROUND_SECONDS = 0.05
# A write takes some 15 us of processor time, one to a subscriber that takes nothing 250 us. Wall
# time would tell of other processes, too.
SLUGGISH_SECONDS = 80e-6
MEMORY = 1.0 / 32.0
# The longest time without any write [s].
PROBE_SECONDS = 0.1


class Outlet:
    """A topic's publisher, and whether anybody listens.

    `every`: of so many messages one is published.
    """

    def __init__(self, publisher: Any, every: int = 1) -> None:
        self.publisher = publisher
        self.publish: Callable[[bytes], None] = publisher.publish
        self.every = every
        self.heard = True
        self.dropped = 0


class LivePublisher:
    """The queue in front of a node's publishers.

    `published` and `dropped` count messages for topics that somebody listens to.
    """

    def __init__(self) -> None:
        self.outlets: list[Outlet] = []
        self.published = 0
        self.dropped = 0
        self._queue: deque[tuple[Outlet | None, bytes, float]] = deque()
        self._cost = 0.0
        self._looked = self._written = 0.0
        self._published_at: Callable[[float], None] = lambda due: None

    def on_published(self, callback: Callable[[float], None]) -> None:
        """`callback` is called with a sample's due time once its last message is published."""
        self._published_at = callback

    def add(self, outlet: Outlet) -> Outlet:
        """One more publisher."""
        self.outlets.append(outlet)
        return outlet

    @property
    def sluggish(self) -> bool:
        """Whether writes are slow at present: some subscriber takes nothing."""
        return self._cost > SLUGGISH_SECONDS

    def look_round(self, now: float = 0.0) -> None:
        """Asks who listens, unless that was done just before."""
        if now and now - self._looked < LOOK_ROUND_SECONDS:
            return
        self._looked = now or time.perf_counter()
        for outlet in self.outlets:
            outlet.heard = outlet.publisher.get_subscription_count() > 0

    def offer(self, outlet: Outlet, data: bytes) -> None:
        """To be published on `outlet` when there is time; nothing where nobody listens."""
        if outlet.heard:
            self._queue.append((outlet, data, 0.0))

    def offer_sample(
        self, places: Sequence[tuple[Outlet, slice]], data: bytes, k: int, due: float
    ) -> None:
        """A sample's messages, the k-th, due at `due` of `time.perf_counter`; `places` tell where
        in `data` each one stands.
        """
        append = self._queue.append
        for outlet, place in places:
            if outlet.heard and k % outlet.every == 0:
                append((outlet, data[place], 0.0))
        append((None, b"", due))
        while len(self._queue) > QUEUE_MESSAGES:
            self._drop(self._queue.popleft()[0])

    def _drop(self, outlet: Outlet | None) -> None:
        if outlet is not None:
            outlet.dropped += 1
            self.dropped += 1

    def publish(self, until: float) -> None:
        """Publishes what waits: at least the newest sample and as much again, then as long as
        writes will be done by `until` of `time.perf_counter`; while writes are slow only the
        latter.
        """
        now = time.perf_counter()
        self.look_round(now)
        while self._queue and self._queue[0][0] is None:
            self._published_at(self._queue.popleft()[2])
        if not self._queue:
            return
        if now - self._written > PROBE_SECONDS:
            # Lest a subscriber that takes messages again goes unnoticed.
            until = max(until, now + self._needed + 1e-9)
        self._publish(now, until, 0 if self.sluggish else 2 * len(self.outlets))

    @property
    def _needed(self) -> float:
        # Slow writes differ: time is left for twice their mean.
        return self._cost * (2.0 if self.sluggish else 1.0)

    def _publish(self, now: float, until: float, count: int) -> None:
        queue, clock, processor = self._queue, time.perf_counter, time.thread_time
        spent = processor()
        while queue and (count > 0 or now + self._needed < until or queue[0][0] is None):
            outlet, data, due = queue.popleft()
            if outlet is None:
                self._published_at(due)
                continue
            outlet.publish(data)
            count -= 1
            self.published += 1
            before, spent = spent, processor()
            self._cost += MEMORY * (spent - before - self._cost)
            self._written = now = clock()

    def finish(self, seconds: float) -> None:
        """Publishes what still waits; while writes are slow for at most `seconds` of wall time.

        The rest is dropped.
        """
        end = time.perf_counter() + seconds
        while self._queue and not (self.sluggish and time.perf_counter() > end):
            self._publish(time.perf_counter(), end, 0 if self.sluggish else len(self.outlets))
        while self._queue:
            self._drop(self._queue.popleft()[0])
