"""The figures of a landing, as the command prints them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class RunSummary:
    """The figures of a landing.

    `end` is "finished", "toppled" or "interrupted" (by the signal number `signal`). `simulated`,
    `wall`, `lost` and the lateness are in s. `dropped` messages were recorded but not published,
    because a subscriber did not take them or the node had no time. `unrecorded` messages are
    missing from the log, whose disk took too long; the landing has waited for it for `disk_wait`
    [s].
    """

    samples: int
    recorded: int
    unrecorded: int
    disk_wait: float
    simulated: float
    wall: float
    late_steps: int
    median_lateness: float
    p99_lateness: float
    largest_lateness: float
    lost: float
    dropped: int
    folder: Path | None
    end: str
    signal: int
    acknowledged: bool
    recording_error: str

    @property
    def realtime_factor(self) -> float:
        """Simulated seconds per second of wall time."""
        return self.simulated / self.wall if self.wall > 0.0 else 0.0
