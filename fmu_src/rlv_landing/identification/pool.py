"""The processes of a search, which start and end whole, whenever Ctrl-C comes."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import parent_process

import numpy as np
from numpy.typing import NDArray

from ..signals.handlers import ENDING, Hold
from .objective import Objective

_OBJECTIVE: Objective | None = None


def started_pool(objective: Objective, workers: int) -> ProcessPoolExecutor:
    """A pool whose processes have begun to start, for `misfits_at`.

    A signal that ends a command meanwhile ends the pool, and follows when it has ended.

    Args:
        objective: The objective whose misfits the processes find.
        workers: Their number.
    """
    with Hold() as held:
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
    """Set up a process; Ctrl-C and the terminal's end are the parent's to answer.

    The parent may end it by SIGTERM. It ends with the parent, however that ends.
    """
    global _OBJECTIVE
    for number in ENDING:
        signal.signal(number, signal.SIG_DFL if number == signal.SIGTERM else signal.SIG_IGN)
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
