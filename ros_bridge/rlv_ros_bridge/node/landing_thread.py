"""The thread that lands, beside that of the node's callbacks, and the services that act on it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from std_srvs.srv import Trigger

from rlv_landing.errors import LandingError, reason_of

from ..ros.setup import MATCH_POLL_SECONDS, wait_until_matched
from .landing_run import LandingRun
from .publish_queue import TopicPublisher
from .settings import Settings


class LandingThread:
    """Runs a landing in a thread of its own, until it ends, fails or is stopped.

    Before the first sample it waits for the subscribers and the time that the settings ask for.

    Args:
        landing: the landing, whose log is open.
        awaited: the publisher whose subscribers are waited for.
        others: the publishers of the node, whose subscribers may come a moment later.
        on_end: called in the thread when the landing has ended and its log is complete.
        on_error: called in the thread with the error of a landing that has failed.
    """

    def __init__(
        self,
        landing: LandingRun,
        awaited: TopicPublisher,
        others: Sequence[Publisher[Any]],
        on_end: Callable[[], object],
        on_error: Callable[[LandingError], object],
    ) -> None:
        self._landing, self._awaited, self._others = landing, awaited, others
        self._on_end, self._on_error = on_end, on_error
        self._pause = threading.Event()
        self._thread = threading.Thread(target=self._land, name="landing", daemon=True)

    def start(self) -> None:
        """Starts the thread; once."""
        self._thread.start()

    def _land(self) -> None:
        landing, s = self._landing, self._landing.settings
        try:
            if not landing.samples:
                self._wait_for_start(s)
            landing.run(self._pause.is_set)
            if landing.end:
                landing.close_log()
                self._on_end()
        except Exception as e:
            self._on_error(as_landing_error(e))

    def _wait_for_start(self, s: Settings) -> None:
        """Waits for subscribers, and then for `start_delay`; meanwhile `/clock` is held.

        Raises:
            LandingError: there are not enough subscribers in time.
        """
        wait_until_matched(
            self._awaited.publisher,
            s.wait_for_subscribers,
            s.wait_timeout,
            self._is_paused,
            self._others,
        )
        end = time.monotonic() + s.start_delay
        while time.monotonic() < end and not self._is_paused():
            time.sleep(MATCH_POLL_SECONDS)

    def _is_paused(self) -> bool:
        self._landing.publish_start_clock()
        return self._pause.is_set()

    def stop(self) -> None:
        """Pauses the landing after its present sample, and waits for the thread's end."""
        self._pause.set()
        self._thread.join()


def as_landing_error(error: Exception) -> LandingError:
    """An error as one that fits in one line; another than ours with its type."""
    if isinstance(error, LandingError):
        return error
    return LandingError(f"{type(error).__name__}: {reason_of(error)}")


def create_landing_services(node: Node, reset: Callable[[], str], step: Callable[[], str]) -> None:
    """Creates `~/reset` and `~/step` (std_srvs/Trigger) on `node`.

    Args:
        node: the landing node.
        reset: acts on the landing, and returns the answer's text. A LandingError becomes the
            answer's text with success = false.
        step: likewise.
    """
    node.create_service(Trigger, "~/reset", lambda _, response: _answer(node, reset, response))
    node.create_service(Trigger, "~/step", lambda _, response: _answer(node, step, response))


def _answer(node: Node, action: Callable[[], str], response: Any) -> Any:
    try:
        response.message = action()
        response.success = True
    except LandingError as e:
        response.success, response.message = False, str(e)
        node.get_logger().warning(str(e))
    return response
