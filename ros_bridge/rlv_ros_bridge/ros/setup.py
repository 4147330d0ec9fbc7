"""Start and stop of ROS 2 for a command, noting of signals, and waits for subscribers."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rlv_landing.errors import LandingError, reason_of
from rlv_landing.signals.handlers import SignalNote
from rlv_landing.text.files import read_text

from .parameter_files import shared_names

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

# Longest wait for acknowledgements [s]. Fast DDS asks its readers for them every 3 s; on a busy
# machine one may answer the second time.
ACKNOWLEDGE_SECONDS = 7.0
ACKNOWLEDGE_INTERRUPTED_SECONDS = 0.2
# Periods of checking for a signal and for matched subscriptions [s].
SIGNAL_POLL_SECONDS = 0.05
MATCH_POLL_SECONDS = 0.01
# rosbag2's recorder looks for topics every 0.1 s, and subscribes to one after the other.
SETTLE_SECONDS = 0.3


class StopFlag(SignalNote):
    """Notes the signals that end a command: the loop that looks at it ends after a whole step."""

    def wait(self, seconds: float) -> None:
        """Waits for a signal, at most `seconds` [s]."""
        end = time.monotonic() + seconds
        while not self.number and time.monotonic() < end:
            time.sleep(min(seconds, SIGNAL_POLL_SECONDS))


def require_ros() -> None:
    """Checks that ROS 2 is installed.

    Raises:
        LandingError: ROS 2 or a part of it is missing; the text says what to install.
    """
    _ensure_log_folder()
    try:
        import rclpy  # noqa: F401
    except ImportError as e:
        raise LandingError(
            f'ROS 2 is missing ({reason_of(e)}); install it with pip install "rlv-landing[ros]", '
            "or source your ROS 2"
        ) from None


@contextmanager
def ros_context(args: Sequence[str] = ()) -> Iterator[frozenset[str]]:
    """Starts rclpy with `args` (`--ros-args ...`), and shuts it down at the end.

    It gives the names of parameters that files give to every node, see `shared_names`.

    Raises:
        LandingError: ROS 2 is missing, or it does not accept `args`.
    """
    require_ros()
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    with _regular_files(args) as own:
        try:
            rclpy.init(args=["rlv-landing", *own], signal_handler_options=SignalHandlerOptions.NO)
        except Exception as e:
            raise LandingError(f"ROS 2 does not start: {reason_of(e)}") from None
        shared = shared_names(own)
    try:
        yield shared
    finally:
        rclpy.try_shutdown()


@contextmanager
def _regular_files(args: Sequence[str]) -> Iterator[list[str]]:
    """The arguments with parameter files that are pipes as regular files, which last for the body.

    ROS 2 would wait for their writer without a word.

    Raises:
        LandingError: A pipe cannot be read as a parameter file.
    """
    with tempfile.TemporaryDirectory() as folder:
        own = list(args)
        for i, (option, name) in enumerate(zip(args, own[1:]), 1):
            path = Path(name)
            if option == "--params-file" and path.exists() and not path.is_file():
                copy = Path(folder) / f"{i}.yaml"
                copy.write_text(read_text(path, "parameter file"), encoding="utf-8")
                own[i] = str(copy)
        yield own


def _ensure_log_folder() -> None:
    """Sets ROS_LOG_DIR where HOME cannot be written: without a log folder ROS 2 does not start."""
    if "ROS_LOG_DIR" in os.environ or "ROS_HOME" in os.environ:
        return
    home = os.environ.get("HOME", "")
    if not home or not os.access(home, os.W_OK):
        os.environ["ROS_LOG_DIR"] = str(
            Path(tempfile.gettempdir()) / f"rlv-landing-ros-log-{os.getuid()}"
        )


def wait_until_matched(
    publisher: Publisher[Any],
    count: int,
    timeout: float,
    interrupted: Callable[[], object],
    others: Iterable[Publisher[Any]] = (),
) -> None:
    """Waits until `count` subscriptions are matched, or `interrupted` returns true.

    Who subscribes to several topics does so one by one, and may have this one before others. So it
    then waits until no subscription of `others` has come for `SETTLE_SECONDS`.

    Args:
        publisher: the publisher of the topic.
        count: subscriptions to wait for; 0: nothing is waited for.
        timeout: longest wait [s].
        interrupted: called at each check.
        others: the publishers of the other topics.

    Raises:
        LandingError: there are fewer after `timeout`.
    """
    end = time.monotonic() + timeout
    while not interrupted() and (matched := publisher.get_subscription_count()) < count:
        if time.monotonic() > end:
            raise LandingError(
                f"only {matched} of {count} subscribers of {publisher.topic_name} after "
                f"{timeout:g} s; start them first, or check their ROS_DOMAIN_ID"
            )
        time.sleep(MATCH_POLL_SECONDS)
    every, known, since = list(others) if count else [], -1, time.monotonic()
    while every and not interrupted() and time.monotonic() - since < SETTLE_SECONDS:
        found = sum(p.get_subscription_count() for p in every)
        if found != known and time.monotonic() < end:
            known, since = found, time.monotonic()
        time.sleep(MATCH_POLL_SECONDS)


def wait_for_acknowledgement(publishers: Sequence[Publisher[Any]], *, interrupted: bool) -> bool:
    """Whether all reliable subscribers have acknowledged all samples in time.

    Args:
        publishers: whose samples are waited for.
        interrupted: wait only briefly.
    """
    from rclpy.duration import Duration

    timeout = ACKNOWLEDGE_INTERRUPTED_SECONDS if interrupted else ACKNOWLEDGE_SECONDS
    end = time.monotonic() + timeout
    return all(
        p.wait_for_all_acked(Duration(seconds=max(0.0, end - time.monotonic()))) for p in publishers
    )
