"""The Python class of a ROS message type."""

from __future__ import annotations

import importlib
import importlib.util
from functools import cache
from pathlib import Path
from typing import Any

from rlv_landing.errors import LandingError


def is_installed(name: str) -> bool:
    """Whether the type `pkg/msg/Type` is installed."""
    try:
        message_class(name)
    except LandingError:
        return False
    return True


@cache
def message_class(name: str) -> Any:
    """The class of the type `pkg/msg/Type`.

    Only packages that have messages are imported, whatever a log's text names.

    Raises:
        LandingError: its package is not installed.
    """
    package, _, short = name.partition("/msg/")
    try:
        if not _has_messages(package):
            raise ImportError
        return getattr(importlib.import_module(f"{package}.msg"), short)
    except (ValueError, ImportError, AttributeError):
        raise LandingError(
            f"message type {name!r} is not installed; "
            f"install the ROS 2 package {package!r}, or source your ROS 2"
        ) from None


def _has_messages(package: str) -> bool:
    """Whether there is a package of this name with a folder of messages."""
    spec = importlib.util.find_spec(package) if package.isidentifier() else None
    places = (spec.submodule_search_locations or ()) if spec is not None else ()
    return any((Path(place) / "msg").is_dir() for place in places)
