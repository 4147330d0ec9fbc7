"""What the commands share that land once: options, progress, and what they print and draw."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from ..text.durable import writing
from .options import Option, add_options, every_option, force_option, json_option, plot_option
from .printing import json_text

if TYPE_CHECKING:
    from ..history import History

F = TypeVar("F", bound=Callable[..., Any])


def landing_options(files: str) -> Option:
    """Add `every, output, plot, as_json, force`.

    Args:
        files: What `--output` writes, for the help: `FILE.csv`.
    """
    options: tuple[Option, ...] = (
        every_option(1e-3),
        click.option(
            "-o",
            "--output",
            metavar=files,
            type=click.Path(path_type=Path),
            help="Write every output at every sample (SI units).",
        ),
        plot_option(),
        json_option("Print outcome and peaks as JSON."),
        force_option(),
    )

    def add(command: F) -> F:
        return add_options(command, options)

    return add


@contextmanager
def landing_progress(until: float) -> Iterator[Callable[[float], object]]:
    """Shows the progress of a landing that ends at `until` [s], on a terminal.

    Yields:
        What is to be called with the simulation time [s].
    """
    from tqdm import tqdm

    with tqdm(
        total=until,
        unit="s",
        desc="landing",
        disable=not sys.stderr.isatty(),
        bar_format="{l_bar}{bar}| {n:.2f}/{total:.2f} s",
    ) as bar:
        yield lambda time: bar.update(time - bar.n)


def landing_text(history: History, title: str, *, as_json: bool) -> str:
    """Outcome and peaks of a landing: a table below its title, or JSON."""
    from ..summary import summarise
    from ..tables.landing import summary_table

    return json_text(summarise(history)) + "\n" if as_json else summary_table(history, title)


def draw_landing(history: History, plot: Path | None, title: str) -> None:
    """Draw the overview of a landing to the file `plot`; nothing where it is None."""
    if plot is not None:
        from ..figures.plots import save_overview

        with writing(plot):
            save_overview(history, plot, title)
