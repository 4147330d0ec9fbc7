"""The file of a log that is being written: it goes to the disk in few, large writes."""

from __future__ import annotations

from pathlib import Path

# What is gathered before it is written without being asked for [bytes].
GATHERED_BYTES = 1024 * 1024


class LogFile:
    """A new file whose bytes are gathered, and written at once by `flush`.

    It holds nothing that a process forked meanwhile would write once more when it ends.

    Args:
        path: the file, which must not exist.

    Raises:
        OSError: it exists, or cannot be made. So do `write`, `flush` and `close` where the disk
            refuses.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("xb", buffering=0)
        self._parts: list[bytes] = []
        self._gathered = 0
        self._position = 0

    def write(self, data: bytes) -> int:
        """Adds bytes to the file's end."""
        if data:
            self._parts.append(data)
            self._gathered += len(data)
            self._position += len(data)
        if self._gathered >= GATHERED_BYTES:
            self.flush()
        return len(data)

    def tell(self) -> int:
        """The file's size with what is gathered [bytes]."""
        return self._position

    def flush(self) -> None:
        """Hands what is gathered to the operating system."""
        left = memoryview(b"".join(self._parts))
        self._parts, self._gathered = [], 0
        while left:
            left = left[self._write(left) :]

    def _write(self, data: memoryview) -> int:
        """Writes the start of `data`; the number of bytes."""
        return self._file.write(data)

    def fileno(self) -> int:
        """The file's number in this process."""
        return self._file.fileno()

    def close(self) -> None:
        """Closes the file; what is gathered is written before."""
        try:
            self.flush()
        finally:
            self._file.close()
