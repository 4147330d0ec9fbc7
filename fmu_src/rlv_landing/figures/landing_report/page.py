"""The report as one self-contained HTML page, and as a PDF."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ... import __version__
from ...tables.landing import parameter_records
from ...text.durable import whole_file
from ..plots import inline_svg
from ..report import write_whole
from ..style import page_css
from .curves import pictures
from .sections import Landed, Table, side_by_side, tables_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TEMPLATE = Path(__file__).with_name("page.html.j2")
# A4, landscape [inch], and what fits of a table's text
PAPER = (11.69, 8.27)
LINES, CHARACTERS = 52, 150
WIDEST = 44


def write(landings: Sequence[Landed], path: Path) -> None:
    """Write the report of the landings to `path`, .html or .pdf, whole or not at all.

    Raises:
        LandingError: The file cannot be written.
        OSError: The disk refuses the PDF.
    """
    if path.suffix == ".html":
        write_whole(page(landings), path)
    else:
        _write_pdf(landings, path)


def page(landings: Sequence[Landed]) -> str:
    """The page as a text."""
    from jinja2 import Environment, StrictUndefined

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        css=page_css(),
        version=__version__,
        names=[found.title for found in landings],
        results=side_by_side(landings),
        landings=[
            {
                "title": found.title,
                "id": f"landing-{i}",
                "pictures": [
                    {
                        "title": picture.title,
                        "note": picture.note,
                        "svg": inline_svg(
                            picture.figure, f"f{i}-{j}", f"{picture.title}, {found.title}"
                        ),
                    }
                    for j, picture in enumerate(pictures(found))
                ],
                "tables": tables_of(found),
                "parameters": _parameter_table(found),
            }
            for i, found in enumerate(landings)
        ],
    )


def _parameter_table(found: Landed) -> Table:
    rows = [
        (r["name"], _value(r["value"]), r["unit"], r["source"], r["meaning"])
        for r in parameter_records(found.parameters)
    ]
    return Table("Parameters", ("name", "value", "unit", "source", "meaning"), rows)


def _value(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def _write_pdf(landings: Sequence[Landed], path: Path) -> None:
    from matplotlib.backends.backend_pdf import PdfPages

    with (
        whole_file(path) as file,
        PdfPages(file, metadata={"CreationDate": None}) as pdf,
    ):
        for figure in _sheets(landings):
            pdf.savefig(figure)


def _sheets(landings: Sequence[Landed]) -> Iterator[Figure]:
    """The pages of the PDF: results, then pictures and tables of each landing."""
    yield from _text_sheets(f"Landing report, rlv-landing {__version__}", [side_by_side(landings)])
    for found in landings:
        for picture in pictures(found):
            figure = picture.figure
            if figure.get_suptitle() == "":
                figure.suptitle(f"{found.title}: {picture.title}")
            yield figure
        yield from _text_sheets(found.title, tables_of(found))


def _text_sheets(heading: str, tables: Sequence[Table]) -> Iterator[Figure]:
    from matplotlib.figure import Figure

    lines = [line for table in tables for line in _lines(table)]
    for first in range(0, len(lines), LINES):
        sheet = Figure(figsize=PAPER)
        sheet.text(0.04, 0.95, heading, fontsize=12, va="top")
        text = "\n".join(lines[first : first + LINES])
        sheet.text(0.04, 0.91, text, fontsize=7, va="top", family="monospace", parse_math=False)
        yield sheet


def _lines(table: Table) -> list[str]:
    """A table as lines; cells that are too wide go on below."""
    rows = [table.head, *table.rows]
    widths = [min(WIDEST, max(len(row[i]) for row in rows)) for i in range(len(table.head))]
    while sum(widths) + 2 * len(widths) > CHARACTERS:
        widths[widths.index(max(widths))] -= 1
    lines = [table.title, ""]
    for row in rows:
        cells = [textwrap.wrap(cell, width) or [""] for cell, width in zip(row, widths)]
        for i in range(max(map(len, cells))):
            parts = (c[i] if i < len(c) else "" for c in cells)
            lines.append("  ".join(p.ljust(w) for p, w in zip(parts, widths)).rstrip())
    return [*lines, *textwrap.wrap(table.note, CHARACTERS), "", ""]
