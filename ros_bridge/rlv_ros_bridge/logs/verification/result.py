"""The result of comparing a log with a repetition of its run, and its text."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from rlv_landing.text.terminal import legible_lines


@dataclass(frozen=True)
class Difference:
    """A difference of log and repetition.

    `time` is in s. The values are SI in ROS axes; None: there is none.
    """

    topic: str
    field: str
    time: float
    recorded: Any
    repeated: Any

    def text(self) -> str:
        """The difference as a line of text."""
        at = f"{self.topic} at {self.time:.9g} s"
        if self.recorded is None:
            return f"{at}{', ' + self.field if self.field else ''}: missing from the log"
        if self.repeated is None:
            return f"{at}: {self.recorded} than the repeated run has"
        values = f"{self.recorded!r} in the log, {self.repeated!r} when repeated"
        return f"{at}, {self.field}: {values}"


@dataclass
class Verification:
    """The result of a comparison.

    `values` of `messages` at `instants` were compared, with `inputs` repeated, and the `peaks` that
    the log's record of them has. `lost` of the instants are in gaps that the log tells of.
    `other_bits` values are not the same bits. `largest` is the largest difference as a share of
    its field's largest value. `not_exact` says why the bits need not be the same, or is empty.
    `first` is the first difference beyond `tolerance`. `end` and `stop_time` are in s. `older` says
    that the log is of a version without inertial sensors, whose names of frames are not compared.
    """

    path: str
    not_exact: str
    tolerance: float
    instants: int = 0
    messages: int = 0
    values: int = 0
    inputs: int = 0
    peaks: int = 0
    lost: int = 0
    other_bits: int = 0
    largest: float = 0.0
    first: Difference | None = None
    end: float = 0.0
    stop_time: float = 0.0
    cut: bool = False
    older: bool = False

    @property
    def same(self) -> bool:
        """Whether there is no difference beyond the tolerance."""
        return self.first is None

    def as_dict(self) -> dict[str, Any]:
        """The fields as plain values, for JSON."""
        return {"same": self.same, **asdict(self)}

    def text(self) -> str:
        """The fields as lines of text."""
        until = f"{self.instants} instants up to {self.end:g} s" + (
            "" if self.end >= self.stop_time else f" of {self.stop_time:g} s"
        )
        lines = [f"compared  {self.values} values of {self.messages} messages at {until}"]
        if self.inputs:
            lines.append(f"inputs    {self.inputs}, repeated at their times")
        if self.peaks:
            lines.append(f"peaks     {self.peaks}, with their times")
        if self.lost:
            lines.append(f"missing   {self.lost} of these instants, in gaps that the log tells of")
        if self.first is not None:
            lines.append(f"differs   first in {self.first.text()}")
        elif self.other_bits:
            lines.append(
                f"same      within {self.tolerance:g} of each field's largest value; "
                f"{self.other_bits} values are not the same bits,"
            )
            lines.append(
                "          the largest difference is "
                f"{self.largest:.2g} of its field's largest value"
            )
        else:
            lines.append("same      bit for bit")
        if self.older:
            lines.append(
                "note      the log is of a version without imu and top/imu; "
                "its names of frames are not compared"
            )
        if self.not_exact:
            lines.append(f"note      the bits need not be the same: {self.not_exact}")
        return legible_lines(lines)
