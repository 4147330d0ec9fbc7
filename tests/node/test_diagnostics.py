"""The level of `/diagnostics`."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticStatus

from rlv_ros_bridge.node.diagnostics import DiagnosticsMessage

SECOND = 1_000_000_000


def test_the_level_is_ok_again_a_second_after_the_last_problem() -> None:
    message = DiagnosticsMessage("landing/landing_node", "2-2")

    def level(seconds: float, late: int, failure: str = "") -> tuple[bytes, str]:
        problems = {"steps late": late, "inputs refused": 0}
        status = message.update(
            round(seconds * SECOND), {"phase": "falling"}, problems, failure
        ).status[0]
        return status.level, status.message

    assert level(0.0, 0) == (DiagnosticStatus.OK, "falling")
    assert level(0.1, 2) == (DiagnosticStatus.WARN, "2 steps late")
    assert level(0.9, 2) == (DiagnosticStatus.WARN, "2 steps late")
    assert level(1.0, 3) == (DiagnosticStatus.WARN, "3 steps late")
    assert level(2.0, 3) == (DiagnosticStatus.WARN, "3 steps late")
    assert level(2.1, 3) == (DiagnosticStatus.OK, "falling")
    message.note(4 * SECOND, {"steps late": 4})
    assert level(4.5, 4) == (DiagnosticStatus.WARN, "4 steps late")
    assert level(5.1, 4) == (DiagnosticStatus.OK, "falling")
    assert level(5.2, 4, "disk full") == (DiagnosticStatus.ERROR, "disk full")
