"""The memory and time that a command would take, and their limits.

Costs were measured on one core of a shared machine (CPython 3.11) and rounded down, so that an
estimate is the least: what is refused would take longer still.
"""

from __future__ import annotations

from pathlib import Path

from .errors import LandingError

# a simulated second: the least, of a vehicle at rest, 3600 s in samples of 100 s took 18 s
SECONDS_PER_SECOND = 4e-3
# a sample, beyond the integration: 100,000 of them in 1 s of landing took 0.53 s
SECONDS_PER_SAMPLE = 4e-6
# the longest time that a study or search may take by estimate, 30 days [s]
LONGEST = 30 * 86400.0
YEAR = 365.25 * 86400.0
# memory that is not asked for [bytes]: to ask takes longer than a short landing's samples
NOTHING = 4e6


def free_memory() -> int:
    """The memory that is free [bytes]: what the system, and this process' limit, still give."""
    free = 2**63
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        free = next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvail"))
    except (OSError, StopIteration, ValueError):
        free = 16 * 2**30
    try:
        import resource

        limit = resource.getrlimit(resource.RLIMIT_AS)[0]
        if limit != resource.RLIM_INFINITY:
            free = min(free, limit)
    except ImportError:
        pass
    return free


def size_text(size: float) -> str:
    """A size [bytes] in the unit that fits."""
    for unit in ("B", "kB", "MB", "GB", "TB"):
        if size < 1000.0:
            return f"{size:.3g} {unit}"
        size /= 1000.0
    return f"{size:.3g} PB"


def duration_text(seconds: float) -> str:
    """A duration [s] in the unit that fits."""
    for unit, length, below in (
        ("s", 1.0, 120.0),
        ("min", 60.0, 7200.0),
        ("h", 3600.0, 172800.0),
        ("days", 86400.0, 2 * YEAR),
    ):
        if seconds < below:
            return f"{seconds / length:.3g} {unit}"
    return f"{seconds / YEAR:.3g} years"


def check_memory(what: str, needed: float, remedy: str, *, at_most: bool = False) -> None:
    """Refuse what needs more memory than is free.

    Args:
        what: What needs it, for the error.
        needed: The memory [bytes].
        remedy: What to do.
        at_most: Whether that is the most it may need, and not the least.

    Raises:
        LandingError: It is more.
    """
    if needed <= NOTHING:
        return
    free = free_memory()
    if needed > free:
        size = size_text(needed)
        needs = f"may need {size} of memory" if at_most else f"needs {size} of memory at least"
        raise LandingError(f"{what} {needs}, and {size_text(free)} is free; {remedy}")


def check_duration(what: str, seconds: float, remedy: str) -> None:
    """Refuse what would take longer than 30 days.

    Args:
        what: What takes so long, for the error.
        seconds: The least time [s].
        remedy: What to do.

    Raises:
        LandingError: It would take longer.
    """
    if seconds > LONGEST:
        raise LandingError(
            f"{what} would take {duration_text(seconds)} at least, more than "
            f"{duration_text(LONGEST)}; {remedy}"
        )
