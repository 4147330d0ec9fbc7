"""Writes the rows of a study to CSV or Parquet."""

from __future__ import annotations

import shutil
from pathlib import Path

from ..text.durable import unwritable, whole_file

ENDINGS = (".csv", ".parquet")


def write_rows(results: Path, path: Path) -> None:
    """Write the rows of a finished study to another file, whole or not at all.

    A CSV has the columns' names as its first line, SI units, full precision, and nothing where a
    row has no number.

    Args:
        results: The study's `results.parquet`.
        path: The file; its ending chooses the format.

    Raises:
        LandingError: The disk refuses.
    """
    from pyarrow import csv, parquet

    try:
        with whole_file(path) as file:
            if path.suffix == ".parquet":
                with results.open("rb") as rows:
                    shutil.copyfileobj(rows, file)
                return
            stored = parquet.ParquetFile(results)
            options = csv.WriteOptions(quoting_style="needed")
            with csv.CSVWriter(file, stored.schema_arrow, write_options=options) as writer:
                for batch in stored.iter_batches():
                    writer.write_batch(batch)
    except OSError as e:
        raise unwritable(path, e) from None
