"""The node's own state, for `/diagnostics`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from rlv_landing.quantities import Interface

from ..logs.landing_record import PHASE, PHASES
from ..messages.fields import IN_A_PLANE
from ..messages.samples import set_stamp
from ..messages.wire import NANOSECONDS
from .pacer import Pacer

# How long a problem is warned of [ns of simulation time].
WARN_NS = NANOSECONDS
BALANCE = "energy.balance"


def phase_name(phase: float) -> str:
    """The name of the output `status.phase`."""
    return PHASES[int(phase)] if 0 <= phase < len(PHASES) else "unknown"


@dataclass(frozen=True)
class LandingCount:
    """What has been counted in a landing: samples, steps that were late, messages, inputs."""

    samples: int
    late: int
    unpublished: int
    recorded: int
    unrecorded: int
    received: int
    refused: int

    @property
    def problems(self) -> dict[str, int]:
        """The counts of what should not be, by name."""
        return {
            "steps late": self.late,
            "messages not published": self.unpublished,
            "messages not recorded": self.unrecorded,
            "inputs refused": self.refused,
        }


class DiagnosticsMessage:
    """The message of `/diagnostics`, filled anew for each publication.

    Args:
        name: full name of the node.
        mode: landing mode, which is part of the hardware id.
        interface: the landing's outputs.
    """

    def __init__(self, name: str, mode: str, interface: Interface = IN_A_PLANE) -> None:
        places = interface.output_names.index
        self._phase, self._balance = places(PHASE), places(BALANCE)
        self._status = DiagnosticStatus(name=name, hardware_id=f"rlv-landing {mode}")
        # by problem: its count, and since when that is so [ns]
        self._risen: dict[str, tuple[int, int]] = {}
        self.message = DiagnosticArray(status=[self._status])

    def of_landing(
        self,
        nanoseconds: int,
        values: Sequence[float],
        count: LandingCount,
        pacer: Pacer,
        of_fmu: Mapping[str, int],
        failure: str,
    ) -> DiagnosticArray:
        """Fills the message with the state of a landing, and returns it.

        Args:
            nanoseconds: simulation time [ns].
            values: the landing's outputs.
            count: what has been counted.
            pacer: the landing's pacer.
            of_fmu: what the FMU counts.
            failure: makes the level ERROR unless it is empty.
        """
        status = {
            "phase": phase_name(values[self._phase]),
            "energy balance [J]": f"{values[self._balance]:.6g}",
            "samples": str(count.samples),
            **{name: str(number) for name, number in of_fmu.items()},
            **pacing_values(pacer, nanoseconds / NANOSECONDS),
            "messages not published": str(count.unpublished),
            "messages recorded": str(count.recorded),
            "messages not recorded": str(count.unrecorded),
            "inputs received": str(count.received),
            "inputs refused": str(count.refused),
        }
        return self.update(nanoseconds, status, count.problems, failure)

    def note(self, nanoseconds: int, problems: Mapping[str, int]) -> None:
        """Notes which problems have risen, whether or not a message is made.

        Args:
            nanoseconds: simulation time [ns].
            problems: counts by name.
        """
        for name, count in problems.items():
            if count > self._risen.get(name, (0, 0))[0]:
                self._risen[name] = count, nanoseconds

    def update(
        self,
        nanoseconds: int,
        values: Mapping[str, str],
        problems: Mapping[str, int],
        failure: str = "",
    ) -> DiagnosticArray:
        """Fills the message, and returns it.

        Args:
            nanoseconds: simulation time [ns].
            values: the status's values by key.
            problems: counts by name; one that rose in the last second makes the level WARN.
            failure: makes the level ERROR unless it is empty.
        """
        set_stamp(self.message.header.stamp, nanoseconds)
        self.note(nanoseconds, problems)
        counts = ", ".join(
            f"{count} {name}"
            for name, (count, since) in self._risen.items()
            if nanoseconds - since <= WARN_NS
        )
        status = self._status
        status.level = DiagnosticStatus.OK
        if failure:
            status.level = DiagnosticStatus.ERROR
        elif counts:
            status.level = DiagnosticStatus.WARN
        status.message = failure or counts or values.get("phase", "")
        if [pair.key for pair in status.values] != list(values):
            status.values = [KeyValue(key=key) for key in values]
        for pair, value in zip(status.values, values.values()):
            pair.value = value
        return self.message


def pacing_values(pacer: Pacer, simulated: float) -> dict[str, str]:
    """The pacer's counters for `/diagnostics`, after `simulated` [s] of simulation time."""
    elapsed = pacer.elapsed
    latest = pacer.lateness[-1] if pacer.lateness else 0.0
    return {
        "steps late": str(pacer.late_steps),
        "time lost to stalls [s]": f"{pacer.lost:.3f}",
        "lateness of the last sample published [s]": f"{latest:.6f}",
        "real-time factor": f"{simulated / elapsed:.3f}" if elapsed > 0.0 else "0",
    }
