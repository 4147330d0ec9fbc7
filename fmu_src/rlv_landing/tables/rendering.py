"""Tables as plain text, as wide as the terminal has room for.

A table that is too wide is printed in parts below each other. Each part begins with the columns
that name its rows. No number is broken, and no word where the names leave room for it.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Column, Table
from rich.text import Text

from ..text.terminal import columns as columns_of_terminal

# narrower terminals get tables of this width
NARROWEST = 40
# what stands between two columns, and what one has less
BETWEEN, EDGE = 3, 1


class ResultTable(Table):
    """A table whose first columns, `keys` of them, name its rows."""

    keys = 0


def new_table(
    title: str, left: Iterable[str], right: Iterable[str], more: Iterable[str] = ()
) -> ResultTable:
    """An empty table: columns aligned left, right (numbers), and left again.

    The first ones name a row. A heading that the table has twice, such as "at [s]", belongs to that
    before it. A word that is wider than its column goes on in the next line; nothing is cut.
    """
    table = ResultTable(title=escape(title), title_justify="left", title_style="bold")
    for name in left:
        table.add_column(escape(name), overflow="fold")
    table.keys = len(table.columns)
    for name in right:
        table.add_column(escape(name), justify="right", overflow="fold")
    for name in more:
        table.add_column(escape(name), overflow="fold")
    return table


def render(table: ResultTable, width: int = 140) -> str:
    """A table as plain text, at most `width` characters wide, or the terminal's columns."""
    room = columns_of_terminal()
    if room is not None:
        width = min(width, max(room, NARROWEST))
    out = io.StringIO()
    console = Console(file=out, width=width)
    for part in _parts(table, width):
        console.print(part)
    return out.getvalue()


def _parts(table: ResultTable, width: int) -> list[Table]:
    """The table, or the parts of it that fit into `width`."""
    least = [_least(c) for c in table.columns]
    if _total(least) <= width:
        return [_fitted(table, range(len(least)), width)]
    groups = []
    for group in _groups(table.columns, table.keys):
        fits = _total([*least[: table.keys], *(least[i] for i in group)]) <= width
        groups += [group] if fits else [[i] for i in group]
    parts = _shared_out(groups, least, table.keys, width)
    # as many parts, alike in width
    for narrower in range(width, 0, -1):
        shared = _shared_out(groups, least, table.keys, narrower)
        if len(shared) > len(parts):
            break
        parts = shared
    found = [_fitted(table, [*range(table.keys), *part], width) for part in parts]
    for later in found[1:]:
        later.title = None
    return found


def _shared_out(
    groups: Sequence[Sequence[int]], least: Sequence[int], keys: int, width: int
) -> list[list[int]]:
    """The groups of columns in parts that fit into `width` beside the `keys`."""
    parts: list[list[int]] = []
    for group in groups:
        if parts and _total([*least[:keys], *(least[i] for i in (*parts[-1], *group))]) <= width:
            parts[-1] += group
        else:
            parts.append([*group])
    return parts


def _groups(columns: Sequence[Column], first: int) -> list[list[int]]:
    """The columns from the `first` on by number, each with those that belong to it."""
    headings = [str(c.header) for c in columns]
    groups: list[list[int]] = []
    for i in range(first, len(columns)):
        if groups and headings.count(headings[i]) > 1:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def _fitted(table: Table, chosen: Iterable[int], width: int) -> Table:
    """A table of the chosen columns, none narrower than its longest word where that fits."""
    columns = [table.columns[i] for i in chosen]
    least, most = [_least(c) for c in columns], [_most(c) for c in columns]
    part = Table(title=table.title, title_justify="left", title_style="bold")
    level = max((w for w in range(width) if _total(_widths(least, most, w)) <= width), default=0)
    for column, wide in zip(columns, _widths(least, most, level)):
        part.add_column(
            column.header,
            justify=column.justify,
            overflow="fold",
            width=wide if _total(least) <= width else None,
        )
    for cells, row in zip(zip(*(c.cells for c in columns)), table.rows):
        part.add_row(*cells, end_section=row.end_section)
    return part


def _widths(least: Sequence[int], most: Sequence[int], level: int) -> list[int]:
    return [min(m, max(n, level)) for n, m in zip(least, most)]


def _total(widths: Sequence[int]) -> int:
    return sum(widths) + BETWEEN * len(widths) + EDGE


def _least(column: Column) -> int:
    """The longest word of a column; of numbers the longest cell."""
    whole = column.justify == "right"
    cells = [w for c in column.cells for w in ([_plain(c)] if whole else _plain(c).split())]
    return max((len(w) for w in (*cells, *_plain(column.header).split())), default=1) or 1


def _most(column: Column) -> int:
    return max((len(_plain(c)) for c in (column.header, *column.cells)), default=1) or 1


def _plain(cell: object) -> str:
    return Text.from_markup(str(cell)).plain
