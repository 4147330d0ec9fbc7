"""Fronts that were compiled when the package was built, so that no compiler is needed later.

Such a front has a neutral identity. The FMU's own is written over it; all else is the same in every
FMU. The folder `compiled` in the installed package has a library for each
platform, and `made.json`: the digest of what they are made of, and their compilers. A checkout has
no such folder: it compiles its front.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

from .header import MARK, MARK_SIZE

FOLDER = Path(__file__).parent / "compiled"
RECORD = "made.json"


@dataclass(frozen=True)
class Front:
    """A front without an identity: FMI's platform, its compiler, and the library's bytes."""

    platform: str
    compiler: str
    content: bytes


def fronts(made_of: bytes, folder: Path = FOLDER) -> list[Front]:
    """The fronts in `folder`; none where they are made of something else than `made_of`."""
    try:
        record = json.loads((folder / RECORD).read_text())
    except FileNotFoundError:
        return []
    if record["made_of"] != hashlib.sha256(made_of).hexdigest():
        return []
    return [
        Front(platform, compiler, (folder / platform).read_bytes())
        for platform, compiler in sorted(record["compilers"].items())
    ]


def keep(folder: Path, made_of: bytes, compilers: dict[str, str]) -> None:
    """Write the record of the fronts in `folder`, whose files have the platforms' names.

    Args:
        folder: The folder.
        made_of: What they are made of.
        compilers: The compiler for each platform.
    """
    record = {"made_of": hashlib.sha256(made_of).hexdigest(), "compilers": compilers}
    (folder / RECORD).write_text(json.dumps(record, indent=1, sort_keys=True) + "\n")


def identified(content: bytes, identity: bytes) -> bytes:
    """A front with an FMU's identity in place of its own.

    Args:
        content: The library.
        identity: By `header.front_identity`.

    Raises:
        SystemExit: The library's identity is not where the mark is, once.
    """
    mark = MARK.ljust(MARK_SIZE, b"\0")
    if content.count(mark) != 1:
        raise SystemExit(
            "error: the front that the package brings has no place for an identity; "
            "install the package again"
        )
    at = content.index(mark)
    return content[:at] + identity + content[at + len(identity) :]
