"""The node's own health, for `/diagnostics`."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ..messages.samples import set_stamp
from .pacer import Pacer

PHASES = ("falling", "contact", "settled", "toppled")


def phase_name(phase: float) -> str:
    """The name of `status.phase`."""
    return PHASES[int(phase)] if 0 <= phase < len(PHASES) else "unknown"


class Health:
    """Makes the messages of `/diagnostics` for the node called `name`, whose landing mode is
    `mode`.
    """

    def __init__(self, name: str, mode: str) -> None:
        self._status = DiagnosticStatus(name=name, hardware_id=f"rlv-landing {mode}")
        self.message = DiagnosticArray(status=[self._status])

    def fill(
        self,
        nanoseconds: int,
        values: Mapping[str, str],
        problems: Mapping[str, int],
        failure: str = "",
    ) -> DiagnosticArray:
        """The message at `nanoseconds` of simulation time: `values` by name; `problems` make it a
        warning, a `failure` an error.
        """
        set_stamp(self.message.header.stamp, nanoseconds)
        status = self._status
        trouble = failure or ", ".join(
            f"{count} {name}" for name, count in problems.items() if count
        )
        status.level = (
            DiagnosticStatus.ERROR
            if failure
            else DiagnosticStatus.WARN
            if trouble
            else DiagnosticStatus.OK
        )
        status.message = trouble or values.get("phase", "")
        status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        return self.message


def pace(pacer: Pacer, simulated: float) -> dict[str, str]:
    """How the landing keeps to the wall clock, after `simulated` [s]."""
    elapsed = pacer.elapsed
    return {
        "steps late": str(pacer.late_steps),
        "time lost to stalls [s]": f"{pacer.lost:.3f}",
        "lateness of the last sample published [s]": f"{pacer.lateness[-1] if pacer.lateness else 0.0:.6f}",
        "real-time factor": f"{simulated / elapsed:.3f}" if elapsed > 0.0 else "0",
    }
