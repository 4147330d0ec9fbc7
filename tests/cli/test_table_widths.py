"""Tables fit the terminal, and keep every word and number whole."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rlv_landing.tables import rendering
from rlv_landing.tables.rendering import NARROWEST, new_table, render
from rlv_landing.text.terminal import columns

COMMANDS = {
    "simulate": ("simulate", "--mode", "2-2", "--until", "0.3"),
    "parameters": ("parameters",),
    "inputs": ("parameters", "--inputs"),
    "validate": ("validate", "--mode", "2-2"),
    "priors": ("identify", "--priors"),
}


def words(text: str) -> list[str]:
    """The words between a table's frames, those of all cells of a row after each other."""
    lines = [line for line in text.splitlines() if line[:1] in "│┃"]
    return [w for line in lines for w in line.replace("│", " ").replace("┃", " ").split()]


@pytest.mark.parametrize("name", COMMANDS)
def test_tables_at_80_columns_have_all_words_of_wide_ones(command, monkeypatch, name):
    """The words come in another order; a row's name comes once more in each part."""
    wide = command(*COMMANDS[name]).out
    assert max(map(len, wide.splitlines())) > 80
    for width in (80, 120):
        monkeypatch.setenv("COLUMNS", str(width))
        narrow = command(*COMMANDS[name]).out
        framed = [line for line in narrow.splitlines() if line[:1] in "│┃┏┡└"]
        assert framed
        assert max(map(len, framed)) <= width
        assert set(words(narrow)) == set(words(wide))


CELLS = st.from_regex(r"[a-z.]{1,9}( [a-z.]{1,9}){0,3}", fullmatch=True)
NUMBERS = st.floats(allow_nan=False).map(lambda v: f"{v:.5g}")


@settings(max_examples=30)
@given(st.data(), st.integers(1, 9), st.integers(1, 4), st.integers(NARROWEST, 200))
def test_any_table_fits_and_each_number_is_whole(data, numbers, rows, width):
    headings = data.draw(st.lists(CELLS, min_size=numbers, max_size=numbers))
    table = new_table("t", ("name",), headings, ("note",))
    written: list[str] = []
    for _ in range(rows):
        cells = data.draw(st.lists(NUMBERS, min_size=numbers, max_size=numbers))
        table.add_row(data.draw(CELLS), *cells, data.draw(CELLS))
        written += cells
    text = render(table, width)
    assert all(len(line) <= width for line in text.splitlines())
    found = words(text)
    assert all(found.count(number) >= written.count(number) for number in written)


def test_a_heading_that_comes_twice_stays_beside_that_before_it():
    table = new_table("", ("leg",), ("force of the strut", "at [s]", "stroke of it", "at [s]"))
    table.add_row("1", "-4.5e+06", "0.192", "22.4e-03", "0.207")
    headings = [line for line in render(table, 40).splitlines() if "[s]" in line]
    assert [line.count("[s]") for line in headings] == [1, 1]


@pytest.mark.parametrize(
    ("given_", "found"), [("80", 80), ("0", None), ("many", None), ("\u0663", None), ("", None)]
)
def test_columns_are_those_of_the_environment_or_of_a_terminal(monkeypatch, given_, found):
    monkeypatch.setenv("COLUMNS", given_)
    assert columns() == found


def test_a_terminal_of_few_columns_gets_tables_of_the_narrowest_width(monkeypatch):
    monkeypatch.setattr(rendering, "columns_of_terminal", lambda: 5)
    table = new_table("", ("name",), ("value",))
    table.add_row("a name of many words that does not fit", "1.5")
    assert max(map(len, render(table).splitlines())) <= NARROWEST
