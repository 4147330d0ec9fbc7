"""How a landing went."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class RunSummary:
    """How a landing went.

    `end` is "finished", "toppled" or "interrupted" (by `signal`); lateness and wall time in s.

    `dropped` messages were recorded, but not published: a subscriber did not take them, or the node
    had no time.
    """

    samples: int
    recorded: int
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
