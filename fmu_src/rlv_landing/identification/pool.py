"""The processes of a search, which start and end whole, whenever Ctrl-C comes."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import parent_process

import numpy as np
from numpy.typing import NDArray

from .objective import Objective

_OBJECTIVE: Objective | None = None


def started_pool(objective: Objective, workers: int) -> ProcessPoolExecutor:
    """A pool whose processes have begun to start, for `misfits_at`.

    Ctrl-C or SIGTERM meanwhile ends the pool, and follows when it has ended.

    Args:
        objective: The objective whose misfits the processes find.
        workers: Their number.
    """
    with _interrupts_held() as held:
        pool = ProcessPoolExecutor(workers, initializer=_adopt, initargs=(objective,))
        pool.submit(_start).result()
        if held:
            pool.shutdown(wait=True)
    return pool


def misfits_at(z: Sequence[float]) -> NDArray[np.float64]:
    """The misfits at `z`, in a process of the pool."""
    assert _OBJECTIVE is not None
    return _OBJECTIVE.misfits(z)


def _adopt(objective: Objective) -> None:
    """Set up a process; Ctrl-C is the parent's to answer, and the parent may end it by SIGTERM.

    It ends with the parent, however that ends.
    """
    global _OBJECTIVE
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _OBJECTIVE = objective


def _end_with_parent() -> None:
    """End this process when its parent has ended: it would wait for work, and hold the lock."""
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _start() -> None:
    """Do nothing: a first task, for which the processes start."""


@contextmanager
def _interrupts_held() -> Iterator[list[int]]:
    """Hold Ctrl-C and SIGTERM back; they follow at the end. Gives those that have come.

    A pool that is interrupted while it starts leaves processes behind that nothing ends. A mask of
    signals does not help: another thread may take the signal.
    """
    held: list[int] = []
    if threading.current_thread() is not threading.main_thread():
        yield held
        return
    before = {
        number: signal.signal(number, lambda n, _: held.append(n))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield held
    finally:
        for number, handler in before.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
    if held:
        signal.raise_signal(held[0])
