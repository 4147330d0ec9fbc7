"""A bounded queue of serialised messages, published in the time that the landing leaves.

rclpy keeps Python's global lock while it writes, so a publishing thread would stop the landing for
as long as each write takes. Therefore the landing's own thread publishes, between a sample and the
next step. A write to a subscriber that takes nothing costs some fifteen times as much as another.
While writes are that slow, only the time until the next step is used for them; the oldest messages
are dropped and counted.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from .pacer import RunningMean

# One second of all messages at 1 kHz.
QUEUE_MESSAGES = 16_000
# Period of asking for the number of subscriptions [s].
SUBSCRIPTION_POLL_SECONDS = 0.05
# A write takes some 15 us of processor time, one to a subscriber that takes nothing 250 us. Wall
# time would also hold the time of other processes.
SLOW_WRITE_SECONDS = 80e-6
# Longest time without any write [s].
PROBE_SECONDS = 0.1


class TopicPublisher:
    """A topic's rclpy publisher, with the number of subscriptions as last polled.

    Args:
        publisher: rclpy's publisher.
        every: one of so many samples is published.
    """

    def __init__(self, publisher: Any, every: int = 1) -> None:
        self.publisher = publisher
        self.publish: Callable[[bytes], None] = publisher.publish
        self.every = every
        self.has_subscribers = True


class PublishQueue:
    """The queue in front of a node's publishers.

    `dropped` counts messages that were not published although their topic has subscribers.
    `has_subscribers` is whether any publisher had some when that was polled last.
    """

    def __init__(self) -> None:
        self.publishers: list[TopicPublisher] = []
        self.dropped = 0
        self.has_subscribers = True
        # Publisher and bytes of a message; None and the due time after a sample's last message.
        self._queue: deque[tuple[TopicPublisher | None, bytes, float]] = deque()
        self._write_cost = RunningMean()
        self._polled = self._written = 0.0
        self._on_published: Callable[[float], None] = lambda due: None

    def on_published(self, callback: Callable[[float], None]) -> None:
        """Has `callback` called with a sample's due time after its last message is published."""
        self._on_published = callback

    def add(self, publisher: TopicPublisher) -> TopicPublisher:
        """Adds a publisher, whose subscriptions are polled from now on."""
        self.publishers.append(publisher)
        return publisher

    @property
    def writes_are_slow(self) -> bool:
        """Whether a write costs so much at present that some subscriber must take nothing."""
        return self._write_cost.value > SLOW_WRITE_SECONDS

    def poll_subscriptions(self, now: float = 0.0) -> None:
        """Asks each publisher for its subscriptions, unless that was done just before `now`.

        Args:
            now: `time.perf_counter()` [s]; 0: ask in any case.
        """
        if now and now - self._polled < SUBSCRIPTION_POLL_SECONDS:
            return
        self._polled = now or time.perf_counter()
        for publisher in self.publishers:
            publisher.has_subscribers = publisher.publisher.get_subscription_count() > 0
        self.has_subscribers = any(p.has_subscribers for p in self.publishers)

    def enqueue(self, publisher: TopicPublisher, data: bytes) -> None:
        """Queues the message `data`, unless its topic has no subscribers."""
        if publisher.has_subscribers:
            self._queue.append((publisher, data, 0.0))

    def enqueue_sample(
        self, slices: Sequence[tuple[TopicPublisher, slice]], data: bytes, k: int, due: float
    ) -> None:
        """Queues the messages of sample k.

        Args:
            slices: each publisher with the slice of `data` that is its message.
            data: the sample's messages, one behind the other.
            k: number of the sample.
            due: when it is due, on `time.perf_counter`'s clock [s].
        """
        append = self._queue.append
        if self.has_subscribers:
            for publisher, part in slices:
                if publisher.has_subscribers and k % publisher.every == 0:
                    append((publisher, data[part], 0.0))
        append((None, b"", due))
        while len(self._queue) > QUEUE_MESSAGES:
            self._drop_oldest()

    def _drop_oldest(self) -> None:
        if self._queue.popleft()[0] is not None:
            self.dropped += 1

    def publish(self, until: float) -> None:
        """Publishes queued messages until `until`, on `time.perf_counter`'s clock [s].

        At least the newest sample and as many messages again are published, unless writes are slow.
        """
        now = time.perf_counter()
        self.poll_subscriptions(now)
        while self._queue and self._queue[0][0] is None:
            self._on_published(self._queue.popleft()[2])
        if not self._queue:
            return
        if now - self._written > PROBE_SECONDS:
            # One write, to notice that a subscriber takes messages again.
            until = max(until, now + self._expected_cost + 1e-9)
        self._publish(now, until, 0 if self.writes_are_slow else 2 * len(self.publishers))

    @property
    def _expected_cost(self) -> float:
        # Slow writes differ much from each other, so twice their mean is expected.
        return self._write_cost.value * (2.0 if self.writes_are_slow else 1.0)

    def _publish(self, now: float, until: float, count: int) -> None:
        """Publishes at least `count` messages, and further ones that fit in before `until`."""
        queue, clock, processor = self._queue, time.perf_counter, time.thread_time
        spent = processor()
        while queue and (count > 0 or now + self._expected_cost < until or queue[0][0] is None):
            publisher, data, due = queue.popleft()
            if publisher is None:
                self._on_published(due)
                continue
            publisher.publish(data)
            count -= 1
            before, spent = spent, processor()
            self._write_cost.add(spent - before)
            self._written = now = clock()

    def drain(self, seconds: float) -> None:
        """Publishes what is queued, and drops what is left.

        Args:
            seconds: longest time while writes are slow [s of wall time].
        """
        end = time.perf_counter() + seconds
        while self._queue and not (self.writes_are_slow and time.perf_counter() > end):
            count = 0 if self.writes_are_slow else len(self.publishers)
            self._publish(time.perf_counter(), end, count)
        while self._queue:
            self._drop_oldest()
