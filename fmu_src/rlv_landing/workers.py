"""The number of threads or processes that a study uses where the user names none."""

from __future__ import annotations

import os


def default_workers() -> int:
    """The number of cores that this process may use.

    Platforms without processor affinity give the number of the machine's cores.
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
