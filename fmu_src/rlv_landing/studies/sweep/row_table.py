"""The Parquet table of a study's rows: its columns, its parts' bytes, and the parts joined."""

from __future__ import annotations

import io
import json
import platform
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy
import scipy

from ... import __version__
from ...quantities import Quantity
from .extras import arrow
from .parts import opened

LEADING = (
    Quantity("", "number of the landing, from 0", name="index", kind="integer"),
    Quantity(
        "",
        "number of the sample, from 0: landings of one sample differ in mode only",
        name="sample",
        kind="integer",
    ),
    Quantity("", "the study's seed", name="seed", kind="integer"),
)
GROUP_ROWS = 10_000


class RowTable:
    """The table of a study's rows, with units, meanings and the study as its metadata.

    Args:
        quantities: The columns behind index, sample and seed.
        about: Everything that decides the rows, and its fingerprint.
        text: The study's file.

    Raises:
        LandingError: pyarrow is missing.
    """

    def __init__(self, quantities: Iterable[Quantity], about: Mapping[str, Any], text: str) -> None:
        self._pyarrow, self._parquet = pa, _ = arrow()
        kinds = {
            "real": pa.float64(),
            "integer": pa.int64(),
            "boolean": pa.bool_(),
            "string": pa.string(),
        }
        fields = [
            pa.field(q.name, kinds[q.kind], metadata={"unit": q.unit, "meaning": q.meaning})
            for q in (*LEADING, *quantities)
        ]
        metadata = {
            "study.json": json.dumps(about),
            "study.toml": text,
            "versions": json.dumps(versions()),
        }
        self.schema = pa.schema(fields, metadata=metadata)

    def content(self, rows: Sequence[Sequence[Any]]) -> bytes:
        """The bytes of a Parquet file of `rows`, with checksums: a later change is noticed."""
        columns = []
        for field, values in zip(self.schema, zip(*rows)):
            if self._pyarrow.types.is_floating(field.type):
                values = tuple(None if isinstance(v, str) else v for v in values)
            columns.append(self._pyarrow.array(values, field.type))
        buffer = io.BytesIO()
        table = self._pyarrow.table(columns, schema=self.schema)
        self._parquet.write_table(table, buffer, write_page_checksum=True)
        return buffer.getvalue()

    def join(self, parts: Iterable[Path], file: BinaryIO) -> None:
        """Write the rows of `parts`, in their order, as one Parquet file.

        Raises:
            OSError: The disk refuses.
            LandingError: A part is damaged.
        """
        with self._parquet.ParquetWriter(file, self.schema, write_page_checksum=True) as writer:
            for table in self._groups(parts):
                writer.write_table(table, row_group_size=GROUP_ROWS)

    def _groups(self, parts: Iterable[Path]) -> Iterator[Any]:
        """All rows in tables of GROUP_ROWS.

        The size does not depend on the parts: neither does the file.
        """
        pending = self.schema.empty_table()
        for part in parts:
            with opened(part) as file:
                table = self._pyarrow.Table.from_arrays(file.read().columns, schema=self.schema)
            pending = self._pyarrow.concat_tables([pending, table])
            while pending.num_rows >= GROUP_ROWS:
                yield pending.slice(0, GROUP_ROWS).combine_chunks()
                pending = pending.slice(GROUP_ROWS)
        if pending.num_rows:
            yield pending.combine_chunks()


def versions() -> dict[str, str]:
    """The versions of the software that made the rows."""
    return {
        "rlv-landing": __version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }
