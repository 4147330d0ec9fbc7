"""Printed results that several commands share: JSON, and bounds that were missed."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import click

from ..errors import one_line
from ..text.durable import NOT_USABLE

FAILED, BAD_INPUT, INTERRUPTED = 1, 2, 130


def print_json(record: Any) -> None:
    """Print a record as JSON; NaN and infinity are refused, as JSON has neither."""
    click.echo(json_text(record))


def json_text(record: Any) -> str:
    """A record as JSON; NaN and infinity are refused, as JSON has neither."""
    return json.dumps(record, indent=1, allow_nan=False)


def print_warning(text: str | None) -> None:
    """Print a warning on standard error, as one line; nothing where it is None."""
    if text is not None:
        click.echo(one_line(f"warning: {text}"), err=True)


def exit_code(error: OSError) -> int:
    """The exit code where the system refuses a file: 2 for a path that the user can change."""
    return BAD_INPUT if error.errno in NOT_USABLE else FAILED


def print_checked(
    record: dict[str, Any], tables: Callable[[], str], missed: Sequence[str], *, as_json: bool
) -> int:
    """Print a result that was checked against bounds; missed bounds go to standard error.

    Args:
        record: The result, printed where `as_json`; the missed bounds are added as `missed`.
        tables: Makes the tables that are printed otherwise.
        missed: A line for every bound that was missed.
        as_json: Whether to print JSON.

    Returns:
        The exit code: 1 where a bound was missed, else 0.
    """
    if as_json:
        print_json({**record, "missed": list(missed)})
    else:
        click.echo(tables(), nl=False)
    for line in missed:
        click.echo(one_line(f"missed: {line}"), err=True)
    return FAILED if missed else 0
