"""The index of the pages, `docs/README.md`, as the site's navigation."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INDEX = ROOT / "docs" / "README.md"
FRONT = ROOT / "README.md"
LINK = re.compile(r"\]\(([^)\s]+)\)")


def sections() -> dict[str, list[Path]]:
    """The pages of each section, in the order of the index; the front page is in none."""
    found: dict[str, list[Path]] = {}
    for part in re.split(r"^## ", INDEX.read_text(encoding="utf-8"), flags=re.M)[1:]:
        title, _, text = part.partition("\n")
        pages = [(INDEX.parent / target).resolve() for target in LINK.findall(text)]
        found[title.strip()] = [page for page in pages if page != FRONT]
    return found


def pages() -> list[Path]:
    """All pages, the front page and the index included."""
    return [FRONT, INDEX, *(page for each in sections().values() for page in each)]
