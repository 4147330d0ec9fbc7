"""The landing that `animate` and `view` draw: from a log, or computed for the command."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rlv_landing.commands.options import chosen_parameters
from rlv_landing.errors import LandingError, one_line

from ..logs.libraries import require_log_readers

if TYPE_CHECKING:
    from rlv_landing.history import History
    from rlv_landing.parameters import Parameters

    from ..logs.reader import LogReader

DEFAULT_END = 1.0
LONGEST_END = 60.0
SAMPLE_STEP = 1e-3


@dataclass(frozen=True)
class VehicleOptions:
    """The options that choose vehicle, ground and drop, as on the command line."""

    preset: str | None
    file: str | None
    mode: str | None
    pairs: tuple[str, ...]

    @classmethod
    def pop_from(cls, options: dict[str, Any]) -> VehicleOptions:
        """Takes the options out of `options`, those of a command by name."""
        return cls(*(options.pop(name) for name in ("preset", "file", "mode", "pairs")))

    @property
    def is_given(self) -> bool:
        """Whether at least one of them is given."""
        return bool(self.preset or self.file or self.mode or self.pairs)

    def parameters(self) -> Parameters:
        """The parameters that they choose.

        Raises:
            LandingError: an unknown name, or a value out of bounds.
        """
        return chosen_parameters(**asdict(self))


def compute_landing(vehicle: VehicleOptions, end: float | None) -> tuple[History, Parameters]:
    """Computes the landing of a vehicle, in samples of 1 ms, and gives its parameters.

    Args:
        vehicle: the options that choose it.
        end: simulation time of the last sample [s]; None: 1 s.

    Raises:
        LandingError: bad options, or a time out of bounds.
    """
    from rlv_landing import Landing

    parameters = vehicle.parameters()
    until = DEFAULT_END if end is None else end
    if not 0.0 < until <= LONGEST_END:
        raise LandingError(f"--end = {until:g} s is outside (0, {LONGEST_END:g}] s")
    return Landing(parameters).run(until, SAMPLE_STEP), parameters


def read_landing(
    path: Path, vehicle: VehicleOptions, shown: tuple[float, float] | None = None
) -> tuple[History, Parameters, bool]:
    """Reads the landing in a log, its vehicle's parameters, and whether the log is incomplete.

    Where the ground was moved, the run of the log is repeated to know where it was; where that
    cannot be, it is drawn at rest, with a warning.

    Args:
        path: the log.
        vehicle: for a log that does not carry its parameters.
        shown: the first and the last time that is shown [s], infinite for the log's last; None:
            those of the log.

    Raises:
        LandingError: no such log, no landing in it, or the vehicle is given by both or by neither.
    """
    require_log_readers()
    from ..logs.bag_reader import open_log
    from ..logs.history import drawn_history
    from ..logs.indexed import holds
    from ..messages.topics import APPLIED_GROUND, resolve

    reader = open_log(path)
    history, _ = drawn_history(reader, shown=shown)
    cut = reader.cut
    ground = resolve(reader.namespace, APPLIED_GROUND.name)
    if holds(reader, ground):
        _add_decks(history, reader)
    if history.parameters is not None:
        if vehicle.is_given:
            raise LandingError(
                f"{path} carries its parameters; leave --preset, --parameters, --mode and --set out"
            )
        return history, history.parameters, cut
    if not vehicle.is_given:
        raise LandingError(
            f"{path} does not carry the vehicle's parameters; "
            "name them by --parameters FILE.toml, or --preset and --mode"
        )
    return history, vehicle.parameters(), cut


def _add_decks(history: History, reader: LogReader) -> None:
    """Adds to a log's history where the ground was."""
    from ..logs.verification.repeat import RepeatedRun

    try:
        history.decks = RepeatedRun(reader).decks(history.time.tolist())
    except LandingError as e:
        click.echo(
            one_line(f"warning: the ground was moved in this landing; it is drawn at rest: {e}"),
            err=True,
        )


def warn_incomplete(log: Path) -> None:
    """Warns that the log is incomplete, and says how to save the rest."""
    click.echo(
        one_line(
            f"warning: {log} is cut or damaged; what is whole was drawn, "
            "`rlv-landing log recover` saves it"
        ),
        err=True,
    )
