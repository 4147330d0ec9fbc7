"""Writes a landing's history from a log to CSV or Parquet."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from rlv_landing.errors import LandingError, reason_of
from rlv_landing.history import UNITS, History
from rlv_landing.outputs import Extreme
from rlv_landing.presets import to_toml
from rlv_landing.text.durable import text_of, unwritable, whole_file

ENDINGS = (".csv", ".parquet")


def write_history(history: History, path: Path) -> None:
    """Writes `history` to `path`, as `write_parts` does."""
    write_parts([history], path, history.extremes)


def write_parts(
    parts: Iterable[History], path: Path, extremes: Mapping[str, Extreme] | None = None
) -> Written:
    """Writes a history in parts to `path`, as CSV or Parquet by its ending, whole or not at all.

    Numbers have full precision. Parquet columns carry their units, and the file the parameters as
    TOML and the landing's peaks as JSON, SI, if they are known.

    Args:
        parts: at least one.
        path: the file.
        extremes: the landing's peaks.

    Raises:
        LandingError: another ending, pyarrow is missing, or the disk refuses.
    """
    if path.suffix not in ENDINGS:
        raise LandingError(f"{path} must end in {' or '.join(ENDINGS)}")
    written = Written()
    try:
        with whole_file(path) as file:
            if path.suffix == ".csv":
                with text_of(file) as text:
                    for i, part in enumerate(map(written.add, parts)):
                        part.write_csv(text, heading=i == 0)
            else:
                _write_parquet(map(written.add, parts), file, extremes)
    except OSError as e:
        raise unwritable(path, e) from None
    return written


@dataclass
class Written:
    """The rows and columns that were written, and the times of the first and the last row [s]."""

    rows: int = 0
    columns: int = 0
    first: float = 0.0
    last: float = 0.0

    def add(self, part: History) -> History:
        """Counts a part."""
        self.first = float(part.time[0]) if not self.rows else self.first
        self.last = float(part.time[-1])
        self.rows, self.columns = self.rows + len(part), len(part.names)
        return part


def _known(extreme: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in extreme.items() if not math.isnan(value)}


def _write_parquet(
    parts: Iterable[History], file: BinaryIO, extremes: Mapping[str, Extreme] | None
) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as e:
        raise LandingError(
            f"Parquet needs pyarrow ({reason_of(e)}); "
            'install it with pip install "rlv-landing[mcap]", '
            "or export to .csv"
        ) from None
    writer = None
    try:
        for part in parts:
            if writer is None:
                fields = [
                    pyarrow.field(name, pyarrow.float64(), metadata={"unit": UNITS.get(name, "")})
                    for name in part
                ]
                metadata = (
                    {"parameters.toml": to_toml(part.parameters)}
                    if part.parameters is not None
                    else {}
                )
                if extremes is not None:
                    metadata["peaks.json"] = json.dumps(
                        {name: _known(found._asdict()) for name, found in extremes.items()}
                    )
                schema = pyarrow.schema(fields, metadata=metadata)
                writer = parquet.ParquetWriter(file, schema)
            writer.write_table(pyarrow.table([part[name] for name in part], schema=schema))
    finally:
        if writer is not None:
            writer.close()
