"""A thread that answers for a node: its services, parameters, inputs and lifecycle."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any, TypeVar

from rclpy.node import Node

LOOK_ROUND_SECONDS = 0.1

Result = TypeVar("Result")


class Spinner:
    """Spins `node` in a thread of its own while it is entered.

    All callbacks run there, and `call` runs there, too.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._executor = _executor(node)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._spin, name="spinner", daemon=True)

    def _spin(self) -> None:
        while not self._stop.is_set():
            self._executor.spin_once(timeout_sec=LOOK_ROUND_SECONDS)

    def call(self, function: Callable[[], Result]) -> Result:
        """`function`, run between two callbacks; what it returns or raises."""
        done = threading.Event()
        found: list[tuple[Result | None, BaseException | None]] = []

        def run() -> None:
            try:
                found.append((function(), None))
            except BaseException as e:
                found.append((None, e))
            done.set()

        self._executor.create_task(run)
        done.wait()
        result, error = found[0]
        if error is not None:
            raise error
        return result  # type: ignore[return-value]

    def __enter__(self) -> Spinner:
        self._executor.add_node(self._node)
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._stop.set()
        self._executor.wake()
        self._thread.join()
        self._executor.remove_node(self._node)
        self._executor.shutdown()


def _executor(node: Node) -> Any:
    # The events executor takes a tenth of the others' time; older ROS 2 has none.
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        from rclpy.executors import SingleThreadedExecutor

        return SingleThreadedExecutor(context=node.context)
    return EventsExecutor(context=node.context)
