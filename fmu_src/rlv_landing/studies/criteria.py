"""The criteria by which a study counts a landing as lost."""

from __future__ import annotations

# the landings that are lost by each criterion, which includes the severer outcomes
CRITERIA = {
    "toppled": "the vehicle topples",
    "body strike": "the body meets the ground, or the vehicle topples",
    "bottomed out": "a damper meets its stop, the body the ground, or the vehicle topples",
    "slid": "a footpad slides too far, a damper meets its stop, the body the ground, "
    "or the vehicle topples",
    "limit": "one of the limits is passed, or the vehicle topples",
}
# a landing that could not be made
FAILED = "failed"
# outcomes that are lost by each criterion; a landing that could not be made is always lost
LOST = {
    "toppled": {"toppled", FAILED},
    "body strike": {"toppled", "body strike", FAILED},
    "bottomed out": {"toppled", "body strike", "bottomed out", FAILED},
    "slid": {"toppled", "body strike", "bottomed out", "slid", FAILED},
    "limit": {"toppled", FAILED},
}


def is_lost(criterion: str, outcome: str, *, limit_passed: bool) -> bool:
    """Whether a landing with this outcome is lost by the criterion.

    Args:
        criterion: The criterion, of CRITERIA.
        outcome: The outcome's name, or FAILED.
        limit_passed: Whether it passed a limit.
    """
    return outcome in LOST[criterion] or (criterion == "limit" and limit_passed)
