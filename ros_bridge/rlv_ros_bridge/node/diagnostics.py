"""The node's own state, for `/diagnostics`."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..logs.landing_record import PHASES
from ..messages.samples import set_stamp
from .pacer import Pacer


def phase_name(phase: float) -> str:
    """The name of the output `status.phase`."""
    return PHASES[int(phase)] if 0 <= phase < len(PHASES) else "unknown"


class DiagnosticsMessage:
    """The message of `/diagnostics`, filled anew for each publication.

    Args:
        name: full name of the node.
        mode: landing mode, which stands in the hardware id.
    """

    def __init__(self, name: str, mode: str) -> None:
        self._status = DiagnosticStatus(name=name, hardware_id=f"rlv-landing {mode}")
        self.message = DiagnosticArray(status=[self._status])

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
            problems: counts by name; any that is not 0 makes the level WARN.
            failure: makes the level ERROR unless it is empty.
        """
        set_stamp(self.message.header.stamp, nanoseconds)
        counts = ", ".join(f"{count} {name}" for name, count in problems.items() if count)
        status = self._status
        status.level = DiagnosticStatus.OK
        if failure:
            status.level = DiagnosticStatus.ERROR
        elif counts:
            status.level = DiagnosticStatus.WARN
        status.message = failure or counts or values.get("phase", "")
        status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
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
