"""The figures of a landing, as the command prints them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import click

from rlv_landing.errors import one_line

EXIT_RECORDING_FAILED = 1


@dataclass(frozen=True)
class RunSummary:
    """The figures of a landing.

    `end` is "finished", "toppled" or "interrupted" (by the signal number `signal`). `simulated`,
    `wall`, `lost` and the lateness are in s. `dropped` messages were recorded but not published,
    because a subscriber did not take them or the node had no time.
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


def print_summary(summary: RunSummary) -> None:
    """Prints outcome, figures and log folder; what was lost, to the error output."""
    click.echo(
        f"{summary.end}: {summary.samples} samples, "
        f"{summary.simulated:g} s in {summary.wall:.2f} s "
        f"(real-time factor {summary.realtime_factor:.2f}); {summary.late_steps} steps late; "
        f"lateness {summary.median_lateness * 1e6:.0f} us in the median, "
        f"{summary.p99_lateness * 1e6:.0f} us in 99 % of samples, "
        f"{summary.largest_lateness * 1e3:.2f} ms at most"
    )
    warnings = []
    if summary.lost:
        warnings.append(f"{summary.lost:.2f} s of wall time were lost to stalls and not made up")
    if summary.dropped:
        warnings.append(
            f"{summary.dropped} messages were not published in time, and dropped; the log has them"
        )
    if not summary.acknowledged:
        warnings.append("not every reliable subscriber has acknowledged all samples")
    for text in warnings:
        click.echo(one_line(f"warning: {text}"), err=True)
    if summary.folder is not None:
        click.echo(f"log: {summary.folder}")
    if summary.recording_error:
        click.echo(
            one_line(
                f"error: {summary.recording_error}; what was written can be read with "
                f"`rlv-landing log info {summary.folder}`"
            ),
            err=True,
        )
