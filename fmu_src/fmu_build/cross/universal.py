"""Libraries of macOS for several architectures in one file."""

from __future__ import annotations

import struct
from collections.abc import Sequence

# all numbers of the header are big-endian
FAT_MAGIC = 0xCAFEBABE
HEADER, ENTRY = struct.Struct(">II"), struct.Struct(">IIIII")
# of the 64-bit libraries, in their own byte order: magic, type and subtype of the processor
MACH_HEADER, MACH_MAGIC = struct.Struct("<III"), 0xFEEDFACF
# each library begins at a multiple of the largest page, 2**14 bytes
PAGE_EXPONENT = 14


def joined(libraries: Sequence[bytes]) -> bytes:
    """One library of several, each for another architecture.

    Raises:
        ValueError: One is no 64-bit library of macOS.
    """
    page = 1 << PAGE_EXPONENT
    at = page
    header, content = HEADER.pack(FAT_MAGIC, len(libraries)), b""
    for library in libraries:
        magic, processor, subtype = MACH_HEADER.unpack_from(library)
        if magic != MACH_MAGIC:
            raise ValueError(f"a library for macOS begins with {magic:#x}, not {MACH_MAGIC:#x}")
        header += ENTRY.pack(processor, subtype, at, len(library), PAGE_EXPONENT)
        padded = library.ljust(-(-len(library) // page) * page, b"\0")
        content += padded
        at += len(padded)
    return header.ljust(page, b"\0") + content
