"""A thread that writes what it is handed, so that nobody else waits for the disk."""

from __future__ import annotations

import os
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

Item = TypeVar("Item")


class WritingThread(Generic[Item]):
    """Writes items in their order, in a thread of its own, which `end` ends.

    The first error of `write` ends writing, whatever it is: `error` is set, and all further items
    are passed over. `waited` is the time that `hand_over` has waited for room [s].

    A forked process has no such thread: there every method does nothing.

    Args:
        write: called in the thread with each item.
        limit: size of the items that may wait, together [bytes]. A larger one may wait alone.
    """

    def __init__(self, write: Callable[[Item], None], limit: int) -> None:
        self.error: BaseException | None = None
        self.waited = 0.0
        self._write, self._limit = write, limit
        self._items: deque[tuple[Item, int]] = deque()
        # Size of the items that wait, and of the one that is being written.
        self._size = 0
        self._ending = False
        self._changed = threading.Condition()
        self._process = os.getpid()
        # The interpreter does not wait for it: who made it ends it.
        self._thread = threading.Thread(target=self._run, name="log", daemon=True)
        self._thread.start()

    def hand_over(self, item: Item, size: int, *, wait: bool) -> bool:
        """Hands an item over; whether it was taken, which it is after an error.

        Args:
            item: what to write.
            size: its size [bytes].
            wait: wait for room; else it is not taken where there is none.
        """
        if self._is_elsewhere():
            return True
        with self._changed:
            if not self._has_room(size):
                if not wait:
                    return False
                began = time.perf_counter()
                self._changed.wait_for(lambda: self._has_room(size))
                self.waited += time.perf_counter() - began
            if self.error is None and not self._ending:
                self._items.append((item, size))
                self._size += size
                self._changed.notify_all()
        return True

    def sync(self) -> None:
        """Waits until all items are written, or writing has failed."""
        if self._is_elsewhere():
            return
        with self._changed:
            self._changed.wait_for(lambda: not self._size)

    def end(self, *, discard: bool = False) -> None:
        """Ends the thread, and waits for its end.

        Args:
            discard: items that wait are not written.
        """
        if self._is_elsewhere():
            return
        with self._changed:
            self._ending = True
            if discard:
                self._size -= sum(size for _, size in self._items)
                self._items.clear()
            self._changed.notify_all()
        self._thread.join()

    def _is_elsewhere(self) -> bool:
        return os.getpid() != self._process

    def _has_room(self, size: int) -> bool:
        return self.error is not None or not self._size or self._size + size <= self._limit

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._items or self._ending)
                if not self._items:
                    return
                item, size = self._items.popleft()
            error: BaseException | None = None
            try:
                self._write(item)
            except BaseException as e:
                error = e
            del item
            with self._changed:
                self._size -= size
                if error is not None:
                    self.error = error
                    self._items.clear()
                    self._size = 0
                self._changed.notify_all()
            if error is not None:
                return
