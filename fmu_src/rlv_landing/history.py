"""A landing's history: named columns over time."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from .errors import LandingError, unknown
from .extremes import Extreme
from .parameters import Parameters


class History:
    """Columns named as the FMU's variables, in SI units, over `time` [s]:
    `history["leg[1].main_strut.force"]` is an array (n,).

    `parameters` are those of the landing, where they are known. `extremes` by name are those of the
    outputs over the whole span, between the samples, too; None where there are samples only.
    """

    def __init__(
        self,
        time: NDArray[np.float64],
        names: Sequence[str],
        data: NDArray[np.float64],
        parameters: Parameters | None = None,
        extremes: Mapping[str, Extreme] | None = None,
    ) -> None:
        if data.shape != (len(time), len(names)):
            raise LandingError(
                f"a history of {len(time)} times and {len(names)} names cannot hold an array of shape {data.shape}"
            )
        self.time = time
        self.names = tuple(names)
        self.data = data
        self.parameters = parameters
        self.extremes = extremes
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

    def to_csv(self, path: str | Path) -> None:
        """Write all columns to a CSV file, SI units, full precision."""
        with Path(path).open("w", newline="", encoding="utf-8") as f:
            self.write_csv(f)

    def write_csv(self, file: TextIO) -> None:
        """The same to an open file."""
        writer = csv.writer(file)
        writer.writerow(list(self))
        for t, row in zip(self.time.tolist(), self.data.tolist()):
            writer.writerow([repr(t), *map(repr, row)])
