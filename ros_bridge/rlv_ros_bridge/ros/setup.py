"""ROS 2 for a command: start and stop it, take signals without being cut in the middle, wait for
subscribers.
"""

from __future__ import annotations

import os
import signal
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any

from rlv_landing.errors import LandingError

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.publisher import Publisher

# Fast DDS asks its readers every 3 s what they have got.
ACKNOWLEDGE_SECONDS = 4.0
INTERRUPTED_SECONDS = 0.2
WAIT_SECONDS = 0.05
# How often it is asked whether subscribers have been matched.
MATCH_SECONDS = 0.01
SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopFlag:
    """Notes SIGINT and SIGTERM while it is entered, so that the loop ends at a good moment.

    `number` is the first that came, or 0.
    """

    def __init__(self) -> None:
        self.number = 0
        self._previous: dict[int, Any] = {}

    def __bool__(self) -> bool:
        return self.number != 0

    def wait(self, seconds: float) -> None:
        """Waits for a signal, at most `seconds`."""
        end = time.monotonic() + seconds
        while not self.number and time.monotonic() < end:
            time.sleep(min(seconds, WAIT_SECONDS))

    def _note(self, number: int, _frame: FrameType | None) -> None:
        self.number = self.number or number

    def __enter__(self) -> StopFlag:
        # Python takes signals in the main thread only; elsewhere the host's own handling stays.
        if threading.current_thread() is threading.main_thread():
            for number in SIGNALS:
                self._previous[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)
        self._previous = {}


def require_ros() -> None:
    """Raises LandingError, saying what to install, where ROS 2 or a part of it is missing."""
    _ensure_log_folder()
    try:
        import rclpy  # noqa: F401
    except ImportError as e:
        raise LandingError(
            f'ROS 2 is missing ({e}); install it with pip install "rlv-landing[ros]", or source your ROS 2'
        ) from None


@contextmanager
def ros_context(args: Sequence[str] = ()) -> Iterator[Any]:
    """rclpy, started with the command line `args` (`--ros-args ...`) and shut down at the end.

    Raises LandingError where there is no ROS 2, or it does not understand `args`.
    """
    require_ros()
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    try:
        rclpy.init(args=["rlv-landing", *args], signal_handler_options=SignalHandlerOptions.NO)
    except Exception as e:
        raise LandingError(f"ROS 2 does not start: {' '.join(str(e).split())}") from None
    try:
        yield rclpy
    finally:
        rclpy.try_shutdown()


def _ensure_log_folder() -> None:
    """ROS 2 refuses to start where it finds no folder for its own logs."""
    if "ROS_LOG_DIR" in os.environ or "ROS_HOME" in os.environ:
        return
    home = os.environ.get("HOME", "")
    if not home or not os.access(home, os.W_OK):
        os.environ["ROS_LOG_DIR"] = str(
            Path(tempfile.gettempdir()) / f"rlv-landing-ros-log-{os.getuid()}"
        )


def wait_for_subscribers(
    publisher: Publisher[Any], count: int, timeout: float, executor: Executor, stop: StopFlag
) -> None:
    """Returns once `count` subscriptions are matched on the publisher's topic, or a signal came.

    Raises LandingError after `timeout` [s].
    """

    def interrupted() -> bool:
        executor.spin_once(timeout_sec=0.02)
        return bool(stop)

    wait_until_matched(publisher, count, timeout, interrupted)


def wait_until_matched(
    publisher: Publisher[Any], count: int, timeout: float, interrupted: Callable[[], object]
) -> None:
    """Returns once `count` subscriptions are matched on the publisher's topic, or `interrupted`
    gets true.

    Raises LandingError after `timeout` [s].
    """
    end = time.monotonic() + timeout
    while not interrupted() and (matched := publisher.get_subscription_count()) < count:
        if time.monotonic() > end:
            raise LandingError(
                f"only {matched} of {count} subscribers of {publisher.topic_name} after {timeout:g} s; "
                "start them first, or check their ROS_DOMAIN_ID"
            )
        time.sleep(MATCH_SECONDS)


def wait_for_acknowledgement(publishers: Sequence[Publisher[Any]], interrupted: bool) -> bool:
    """Whether all reliable subscribers have acknowledged all samples in due time, which is short
    where `interrupted`.
    """
    from rclpy.duration import Duration

    end = time.monotonic() + (INTERRUPTED_SECONDS if interrupted else ACKNOWLEDGE_SECONDS)
    return all(
        p.wait_for_all_acked(Duration(seconds=max(0.0, end - time.monotonic()))) for p in publishers
    )
