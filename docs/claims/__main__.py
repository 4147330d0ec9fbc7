"""Compares the marked numbers in the pages with what gives them: `python docs/claims --help`."""

from __future__ import annotations

import sys

import click
from landings import QUICK
from marks import claims, compare, pages, update
from measured import MEASURED
from studies import SLOW

VALUES = {**QUICK, **MEASURED, **SLOW}


@click.command()
@click.option("--update", "write", is_flag=True, help="Write the right numbers into the pages.")
@click.option("--slow", is_flag=True, help="Those that take minutes, in place of the others.")
def main(*, write: bool, slow: bool) -> None:
    """Compare the marked numbers in README, docs and examples. Exit code 1 if one is wrong."""
    wrong = 0
    for page in pages():
        for claim, text in compare(claims(page), VALUES, slow=slow):
            if text != claim.shown:
                wrong += 1
                click.echo(f"{claim}: {claim.shown.strip()!r}, right is {text.strip()!r}")
        if write:
            update(page, VALUES, slow=slow)
    click.echo(f"{wrong} wrong" + (", corrected" if write and wrong else ""))
    sys.exit(1 if wrong and not write else 0)


if __name__ == "__main__":
    main()
