"""The pages, and the code that they show."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
PAGES = [
    ROOT / "README.md",
    *sorted((ROOT / "docs").glob("*.md")),
    *sorted((ROOT / "examples").glob("*/README.md")),
]
FENCE = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```$", re.M | re.S)
# in a line of code or in a text; what a shell takes for itself ends it
COMMAND = re.compile(r"\brlv-landing ([a-z]+\b[^\n`#&|>]*)")


class Block(NamedTuple):
    """A fenced block: its language, the file that its text is for (or ""), and the text."""

    language: str
    file: str
    text: str


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path) -> list[Block]:
    """The blocks of a page. A TOML text whose first line is a comment with a name is a file."""
    found = []
    for language, file, text in FENCE.findall(page.read_text(encoding="utf-8")):
        named = re.match(r"# (\S+\.toml)\n", text) if language == "toml" else None
        found.append(Block(language, named[1] if named else file, text))
    return found


def snippets(page: Path) -> list[str]:
    """The Python code of a page, each to be run by itself."""
    return [block.text for block in blocks(page) if block.language == "python"]


def commands(page: Path) -> Iterator[list[str]]:
    """The arguments of each command of ours that a page shows."""
    for line in COMMAND.findall(page.read_text(encoding="utf-8")):
        try:
            yield shlex.split(line)
        except ValueError:
            yield line.split()
