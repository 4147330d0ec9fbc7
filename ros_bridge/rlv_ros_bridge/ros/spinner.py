"""A thread that spins a node: its services, parameters, inputs and lifecycle transitions."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any, TypeVar

from rclpy.node import Node

# Longest time in the executor before the request to stop is checked [s].
SPIN_SECONDS = 0.1

Result = TypeVar("Result")


class Spinner:
    """Spins `node` in a thread of its own while it is entered.

    All callbacks of the node run in that thread. `call` runs functions in it.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._executor = _make_executor(node)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._spin, name="spinner", daemon=True)

    def _spin(self) -> None:
        while not self._stop.is_set():
            self._executor.spin_once(timeout_sec=SPIN_SECONDS)

    def call(self, function: Callable[[], Result]) -> Result:
        """Runs `function` in the executor's thread, between two callbacks.

        Returns:
            What `function` returns. What it raises is raised here.
        """
        done = threading.Event()
        outcome: list[tuple[Result | None, BaseException | None]] = []

        def run() -> None:
            try:
                outcome.append((function(), None))
            except BaseException as e:
                outcome.append((None, e))
            done.set()

        self._executor.create_task(run)
        done.wait()
        result, error = outcome[0]
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


def _make_executor(node: Node) -> Any:
    # The events executor takes a tenth of the others' processor time. Older ROS 2 lacks it.
    try:
        from rclpy.experimental.events_executor import EventsExecutor
    except ImportError:
        from rclpy.executors import SingleThreadedExecutor

        return SingleThreadedExecutor(context=node.context)
    return EventsExecutor(context=node.context)
