"""The command line `rlv-landing`; its commands are imported when it runs."""

from __future__ import annotations

from ..signals.start import end_at_once

# as in `typing`, whose import would take most of the time until Ctrl-C is answered
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .group import cli, run

__all__ = ["cli", "main", "run"]


def main() -> None:
    """Run the command line; an error of the user is one line on standard error."""
    # before the imports, in whose midst Ctrl-C would be lost
    end_at_once()
    from .group import main as run_main

    run_main()


def __getattr__(name: str) -> Any:
    """The group of commands, and what runs one: imported when they are asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import group

    return getattr(group, name)
