"""The private parts of MCAP's writer that the recorder uses, all of them.

MCAP's `add_message` takes some 5 us of processor time for each message. Handing over a chunk's
messages at once takes 1 us for each, but the library has no public way to do so. Where another
version lacks these parts, None is returned, and `ChunkWriter` uses `add_message`. The tests of this
file hold them to the installed version.
"""

from __future__ import annotations

from typing import Any


def chunk_builder(writer: Any) -> Any:
    """The gathered records of the chunk that `writer`, an `mcap.writer.Writer`, has open."""
    return getattr(writer, "_Writer__chunk_builder", None)


def statistics(writer: Any) -> Any:
    """The counts and times of all messages that `writer`, an `mcap.writer.Writer`, has taken."""
    return getattr(writer, "_Writer__statistics", None)


def chunk_indexes(writer: Any) -> Any:
    """The indexes of the chunks that `writer`, an `mcap.writer.Writer`, has written: a list."""
    return getattr(writer, "_Writer__chunk_indices", None)
