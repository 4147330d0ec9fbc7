"""The node's own health, for `/diagnostics`."""

from __future__ import annotations

from collections.abc import Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from .messages import set_stamp

PHASES = ("falling", "contact", "settled", "toppled")


def phase_name(phase: float) -> str:
    """The name of `status.phase`."""
    return PHASES[int(phase)] if 0 <= phase < len(PHASES) else "unknown"


class Health:
    """Makes the messages of `/diagnostics` for the node called `name`, whose landing mode is `mode`."""

    def __init__(self, name: str, mode: str) -> None:
        self._status = DiagnosticStatus(name=name, hardware_id=f"rlv-landing {mode}")
        self.message = DiagnosticArray(status=[self._status])

    def fill(self, nanoseconds: int, values: Mapping[str, str], trouble: str = "", failed: bool = False) -> DiagnosticArray:
        """The message at `nanoseconds` of simulation time: `values` by name; `trouble` makes it a warning, `failed` an error."""
        set_stamp(self.message.header.stamp, nanoseconds)
        status = self._status
        status.level = DiagnosticStatus.ERROR if failed else DiagnosticStatus.WARN if trouble else DiagnosticStatus.OK
        status.message = trouble or values.get("phase", "")
        status.values = [KeyValue(key=key, value=value) for key, value in values.items()]
        return self.message
