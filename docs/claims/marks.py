"""Marked numbers in the pages: `<!-- =NAME ARGUMENT; ... -->text<!-- = -->`.

A renderer shows the text alone. The comment before it names the value in `values` and its arguments
that give the text. `python docs/claims` compares all marks, `--update` writes the right texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
MARK = re.compile(r"<!-- =(?P<call>\w[^<>]*?) -->(?P<shown>.*?)<!-- = -->", re.S)
ENDS = re.compile(r"<!-- =(?P<call>[^<>]*?)-->")
NUMBER = re.compile(r"(?P<mantissa>-?[\d,]*\d(?:\.(?P<decimals>\d+))?)(?P<exponent>e-?\d+)?")


@dataclass(frozen=True)
class Value:
    """A value that pages may name.

    Attributes:
        compute: From arguments (texts) to a number, or to the text itself.
        slow: Whether it takes minutes.
    """

    compute: Callable[..., float | str]
    slow: bool


@dataclass(frozen=True)
class Claim:
    """A marked text of a page.

    Attributes:
        page: The page.
        line: Its line, counted from 1.
        name: The value's name.
        arguments: Its arguments.
        shown: The text of the page.
    """

    page: Path
    line: int
    name: str
    arguments: tuple[str, ...]
    shown: str

    def __str__(self) -> str:
        call = f"{self.name} {'; '.join(self.arguments)}".strip()
        return f"{self.page.relative_to(ROOT)}:{self.line}: {call}"


def pages() -> list[Path]:
    """The pages that may have marks."""
    return sorted(
        [
            ROOT / "README.md",
            *(ROOT / "docs").rglob("*.md"),
            *(ROOT / "examples").glob("*/README.md"),
        ]
    )


def claims(page: Path) -> list[Claim]:
    """The marks of a page.

    Raises:
        ValueError: A mark is not closed, or an end has no beginning; or a mark begins a line of a
            text or has a `|`, which a renderer takes for the start of a block or a cell.
    """
    text = page.read_text(encoding="utf-8")
    found = [_claim(page, text, match) for match in MARK.finditer(text)]
    if len(ENDS.findall(text)) != 2 * len(found):
        raise ValueError(f"{page}: a mark is not closed: write <!-- =NAME -->text<!-- = -->")
    for match in MARK.finditer(text):
        before = text[text.rfind("\n", 0, match.start()) + 1 : match.start()]
        block = match["shown"].startswith("\n")
        if (not block and not before.strip(" -*>")) or "|" in match["call"]:
            raise ValueError(
                f"{_claim(page, text, match)}: a mark may not begin a line or have a |; "
                "put it behind a word"
            )
    return found


def _claim(page: Path, text: str, match: re.Match[str]) -> Claim:
    name, _, rest = match["call"].partition(" ")
    arguments = tuple(a.strip() for a in rest.split(";")) if rest else ()
    line = text.count("\n", 0, match.start()) + 1
    return Claim(page, line, name, arguments, match["shown"])


def like(value: float | str, shown: str) -> str:
    """The value as it is written in the page: with as many digits and separators as `shown` has.

    Raises:
        ValueError: `shown` is no number.
    """
    if isinstance(value, str):
        return value
    match = NUMBER.fullmatch(shown)
    if match is None:
        raise ValueError(f"{shown!r} is no number; write one with the digits to show, such as 0.0")
    decimals = len(match["decimals"] or "")
    if match["exponent"]:
        mantissa, _, exponent = f"{value:.{decimals}e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    text = f"{value:{',' if ',' in shown else ''}.{decimals}f}"
    return text.lstrip("-") if float(text.replace(",", "")) == 0.0 else text


def compare(
    found: list[Claim], values: dict[str, Value], *, slow: bool
) -> Iterator[tuple[Claim, str]]:
    """Each claim with the text that it should have.

    Args:
        found: The claims.
        values: The values by name.
        slow: Whether the slow ones are computed, rather than the quick ones.

    Raises:
        ValueError: A claim names no value.
    """
    for claim in found:
        if claim.name not in values:
            raise ValueError(f"{claim}: there is no value {claim.name!r} in docs/claims")
        if values[claim.name].slow == slow:
            yield claim, like(values[claim.name].compute(*claim.arguments), claim.shown)


def update(page: Path, values: dict[str, Value], *, slow: bool) -> int:
    """Write the right texts into a page; the number of those that were wrong."""
    right = {
        (c.line, c.name, c.arguments): text
        for c, text in compare(claims(page), values, slow=slow)
        if text != c.shown
    }
    text = page.read_text(encoding="utf-8")

    def corrected(match: re.Match[str]) -> str:
        c = _claim(page, text, match)
        shown = right.get((c.line, c.name, c.arguments), c.shown)
        return f"<!-- ={match['call']} -->{shown}<!-- = -->"

    page.write_text(MARK.sub(corrected, text), encoding="utf-8")
    return len(right)
