"""The history of a landing: named columns over time."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from functools import cached_property, lru_cache
from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import numpy as np
from numpy.typing import NDArray

from .assembly import DeckMotion
from .core import SpatialInputs
from .errors import LandingError, unknown
from .outputs import Extreme
from .parameters import Parameters
from .quantities import widest_interfaces
from .text.durable import text_of, whole_file
from .touchdown import AT_REST, GroundMotion

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray
    from matplotlib.axes import Axes

UNITS = {q.name: q.unit for interface in widest_interfaces() for q in interface.outputs} | {
    "time": "s"
}
LEG_COLUMN = re.compile(r"leg\[(\d+)\]\.")
# rows that are written at once: as Python's numbers they take four times their memory
ROWS_AT_ONCE = 1000


class History:
    """Columns over time, named as the FMU's variables, in SI units.

    `history["leg[1].main_strut.force"]` is an array (n,).

    Attributes:
        time: Times of the samples [s], (n,).
        names: The columns' names.
        data: The columns, (n, names).
        parameters: The landing's parameters, where they are known.
        ground: Motion of the ground from the first of the times on, in space that of the deck; by
            default that of the parameters' sea, else it is at rest.
        decks: Where the ground is at each sample, where it was moved in the course of the landing
            and that is known; else None.
        stamps: The times in whole nanoseconds, (n,), where a log has them; else None.
        extremes: Extremes of outputs by name, over the whole span, also between the samples; None
            where there are samples only. A log has those of some outputs.

    Raises:
        LandingError: `data` has another shape, or a column is unknown.
    """

    def __init__(
        self,
        time: NDArray[np.float64],
        names: Sequence[str],
        data: NDArray[np.float64],
        parameters: Parameters | None = None,
        ground: GroundMotion | DeckMotion = AT_REST,
        extremes: Mapping[str, Extreme] | None = None,
    ) -> None:
        if data.shape != (len(time), len(names)):
            raise LandingError(
                f"a history of {len(time)} times and {len(names)} names "
                f"cannot have data of shape {data.shape}"
            )
        self.time = time
        self.names = tuple(names)
        self.data = data
        self.parameters = parameters
        if parameters is not None and ground == AT_REST and len(time):
            ground = DeckMotion.at_sea(parameters, float(time[0])) or ground
        self.ground = ground
        self.extremes = extremes
        self.decks: Sequence[SpatialInputs] | None = None
        self.stamps: Sequence[int] | None = None
        # by leg, see `rlv_landing.validation.first_contact`
        self.first_contacts: dict[int, Any] = {}
        self._index = {name: i for i, name in enumerate(self.names)}

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        if name == "time":
            return self.time
        if name not in self._index:
            raise unknown("column", name, self.names)
        column: NDArray[np.float64] = self.data[:, self._index[name]]
        return column

    def __contains__(self, name: object) -> bool:
        return name == "time" or name in self._index

    def __iter__(self) -> Iterator[str]:
        yield "time"
        yield from self.names

    def __len__(self) -> int:
        return len(self.time)

    @cached_property
    def legs(self) -> tuple[int, ...]:
        """The numbers of the legs that have columns."""
        return _legs_of(self.names)

    def extreme(self, name: str) -> Extreme:
        """The extremes of a column and when it first has them.

        They are those of the landing, between the samples too; of the samples where `extremes` is
        None.

        Raises:
            LandingError: The column is unknown.
        """
        if self.extremes is not None and name in self.extremes:
            return self.extremes[name]
        values = self[name]
        low, high = int(values.argmin()), int(values.argmax())
        return Extreme(
            float(values[low]), float(self.time[low]), float(values[high]), float(self.time[high])
        )

    def looks(self) -> AbstractContextManager[Callable[[float], Mapping[str, float]]] | None:
        """All outputs at any time [s]; None where only the samples are known."""
        return None

    def until(self, samples: int, extremes: Mapping[str, Extreme] | None = None) -> History:
        """The landing until the last of so many `samples`.

        Args:
            samples: How many samples, at least one.
            extremes: The extremes until then; None: those of the whole that were before, and those
                of the samples where the whole's came later.
        """
        part = History(
            self.time[:samples], self.names, self.data[:samples], self.parameters, self.ground
        )
        if extremes is None and self.extremes is not None:
            end = float(part.time[-1])
            extremes = {
                name: found
                if max(found.minimum_time, found.maximum_time) <= end
                else _earlier(found, part.extreme(name), end)
                for name, found in self.extremes.items()
                if name in part
            }
        part.extremes = extremes
        return part

    def to_csv(self, path: str | Path) -> None:
        """Write all columns to a CSV file, SI units, full precision, whole or not at all.

        Raises:
            OSError: The disk refuses.
        """
        with whole_file(Path(path)) as file, text_of(file) as text:
            self.write_csv(text)

    def write_csv(self, file: TextIO, *, heading: bool = True) -> None:
        """Write all columns to an open CSV file, SI units, full precision, names first.

        Times are the exact decimals of the stamps, where there are any.
        """
        writer = csv.writer(file)
        if heading:
            writer.writerow(list(self))
        for first in range(0, len(self), ROWS_AT_ONCE):
            part = slice(first, first + ROWS_AT_ONCE)
            times = (
                map(repr, self.time[part].tolist())
                if self.stamps is None
                else map(_decimals, self.stamps[part])
            )
            for t, row in zip(times, self.data[part].tolist()):
                writer.writerow([t, *map(repr, row)])

    def units(self) -> dict[str, str]:
        """The SI unit of the time and of each column; empty for plain numbers."""
        return {name: UNITS.get(name, "") for name in self}

    def to_pandas(self) -> pandas.DataFrame:
        """A table with a row for each time, which is its index; `attrs["units"]` has the units.

        Raises:
            LandingError: pandas is not installed.
        """
        library = _library("pandas")
        frame: pandas.DataFrame = library.DataFrame(
            self.data, index=library.Index(self.time, name="time"), columns=list(self.names)
        )
        frame.attrs["units"] = self.units()
        return frame

    def to_polars(self) -> polars.DataFrame:
        """A table with a row for each time and the column `time` first; polars keeps no units.

        Raises:
            LandingError: polars is not installed.
        """
        frame: polars.DataFrame = _library("polars").DataFrame({name: self[name] for name in self})
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """A dataset over the coordinate `time`; each variable has its unit as `attrs["units"]`.

        Raises:
            LandingError: xarray is not installed.
        """
        units = self.units()
        variables = {name: ("time", self[name], {"units": units[name]}) for name in self.names}
        dataset: xarray.Dataset = _library("xarray").Dataset(
            variables, coords={"time": ("time", self.time, {"units": "s"})}
        )
        return dataset

    def plot(self, *names: str, axes: Axes | None = None) -> Axes:
        """Draw the columns `names`, of one unit, over time.

        They are drawn in `axes`, or else in new axes of matplotlib's pyplot.

        Raises:
            LandingError: No column is named, one is unknown, or their units differ.
        """
        units = {UNITS.get(name, "") for name in names if self[name] is not None}
        if len(units) != 1:
            raise LandingError(
                f"columns of the units {', '.join(sorted(units)) or 'none'} cannot share an axis; "
                "name columns of one unit"
            )
        if axes is None:
            from matplotlib import pyplot

            axes = pyplot.subplots(layout="constrained")[1]
        for name in names:
            axes.plot(self.time, self[name], label=name)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(f"[{units.pop() or '-'}]")
        axes.legend()
        return axes

    def _repr_html_(self) -> str:
        """The table that notebooks show: each column's unit, least and largest value, and times."""
        if not len(self):
            return "no samples"
        rows = []
        for name in self.names:
            e = self.extreme(name)
            numbers = (e.minimum, e.minimum_time, e.maximum, e.maximum_time)
            cells = "".join(f"<td>{number:.5g}</td>" for number in numbers)
            rows.append(f"<tr><td>{escape(name)}</td><td>{UNITS.get(name, '')}</td>{cells}</tr>")
        heads = ("column", "unit", "least", "at [s]", "largest", "at [s]")
        head = "".join(f"<th>{h}</th>" for h in heads)
        return (
            f'<details open=""><summary>{len(self)} samples until {self.time[-1]:g} s</summary>'
            f"<table><tr>{head}</tr>{''.join(rows)}</table></details>"
        )


@lru_cache(maxsize=64)
def _legs_of(names: tuple[str, ...]) -> tuple[int, ...]:
    found = {int(m.group(1)) for m in map(LEG_COLUMN.match, names) if m}
    return tuple(sorted(found))


def _decimals(nanoseconds: int) -> str:
    """A time in s, all of its digits."""
    seconds, rest = divmod(abs(nanoseconds), 10**9)
    digits = f"{rest:09d}".rstrip("0") or "0"
    return f"{'-' if nanoseconds < 0 else ''}{seconds}.{digits}"


def _library(name: str) -> Any:
    """An optional library.

    Raises:
        LandingError: It is not installed.
    """
    try:
        return import_module(name)
    except ImportError as e:
        raise LandingError(f"{name} is not installed ({e}); pip install {name}") from None


def _earlier(whole: Extreme, sampled: Extreme, end: float) -> Extreme:
    """The extremes of the `whole` that were before the `end` [s], else the `sampled` ones."""
    low = whole if whole.minimum_time <= end else sampled
    high = whole if whole.maximum_time <= end else sampled
    return Extreme(low.minimum, low.minimum_time, high.maximum, high.maximum_time)


def joined(parts: Sequence[History]) -> History:
    """One history of all `parts`, each of which begins with the last sample of that before."""
    first, *later = parts
    time = np.concatenate([first.time, *(p.time[1:] for p in later)])
    data = np.concatenate([first.data, *(p.data[1:] for p in later)])
    extremes = None
    if all(p.extremes is not None for p in parts):
        extremes = {name: _widest([p.extreme(name) for p in parts]) for name in first.names}
    return History(time, first.names, data, first.parameters, first.ground, extremes)


def _widest(found: Sequence[Extreme]) -> Extreme:
    """The extremes over all spans, the first of equal ones."""
    low = min(found, key=lambda e: e.minimum)
    high = max(found, key=lambda e: e.maximum)
    return Extreme(low.minimum, low.minimum_time, high.maximum, high.maximum_time)
