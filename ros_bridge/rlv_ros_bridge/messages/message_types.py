"""The Python class of a ROS message type."""

from __future__ import annotations

import importlib
import importlib.util
from functools import cache
from typing import Any

from rlv_landing.errors import LandingError


def is_installed(name: str) -> bool:
    """Whether the package of the type `pkg/msg/Type` is installed."""
    return importlib.util.find_spec(name.split("/")[0]) is not None


@cache
def message_class(name: str) -> Any:
    """The class of the type `pkg/msg/Type`.

    Raises:
        LandingError: its package is not installed.
    """
    try:
        package, kind, short = name.split("/")
        return getattr(importlib.import_module(f"{package}.{kind}"), short)
    except (ValueError, ImportError, AttributeError):
        package = name.split("/")[0]
        raise LandingError(
            f"message type {name!r} is not installed; "
            f"install the ROS 2 package {package!r}, or source your ROS 2"
        ) from None
