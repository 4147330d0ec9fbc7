"""The marked numbers in README, docs and examples are those that the project gives."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "docs" / "claims"))

import marks  # noqa: E402
from landings import QUICK  # noqa: E402
from measured import MEASURED  # noqa: E402
from studies import SLOW  # noqa: E402

VALUES = {**QUICK, **MEASURED, **SLOW}
PAGES = [page for page in marks.pages() if marks.claims(page)]


def wrong(page: Path, *, slow: bool) -> list[str]:
    """What a page says otherwise than it should."""
    return [
        f"{claim}: {claim.shown.strip()}, right is {text.strip()}"
        for claim, text in marks.compare(marks.claims(page), VALUES, slow=slow)
        if text != claim.shown
    ]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_marked_numbers_are_right(page):
    assert wrong(page, slow=False) == [], "`python docs/claims --update` writes the right ones"


@pytest.mark.torture
@pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="minutes of landings: make torture")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_marked_numbers_of_studies_are_right(page):
    assert wrong(page, slow=True) == [], (
        "`python docs/claims --update --slow` writes the right ones"
    )


def test_pages_have_marks_and_every_value_is_used():
    named = {claim.name for page in PAGES for claim in marks.claims(page)}
    assert {"README.md", "model.md", "studies.md", "envelope.md"} <= {page.name for page in PAGES}
    assert named <= set(VALUES)
    assert set(VALUES) - named == set()


@pytest.mark.parametrize(
    ("value", "shown", "text"),
    [
        (43.797, "34", "44"),
        (0.5984, "0.58", "0.60"),
        (2974713.0, "4.6e6", "3.0e6"),
        (1.23e-5, "9.9e-7", "1.2e-5"),
        (10004.4, "9,999", "10,004"),
        (-4562.52, "-4,000.0", "-4,562.5"),
        (-0.004, "0.12", "0.00"),
        ("38 / 42 / 48", "anything", "38 / 42 / 48"),
    ],
)
def test_a_value_is_written_with_the_digits_of_the_page(value, shown, text):
    assert marks.like(value, shown) == text


def test_a_wrong_number_is_found_and_corrected_and_nothing_else_changes(tmp_path, monkeypatch):
    monkeypatch.setattr(marks, "ROOT", tmp_path)
    page = tmp_path / "page.md"
    text = "creates <!-- =created 2-2 -->{}<!-- = --> J, 34 J\n| <!-- =scalars -->48<!-- = --> |\n"
    page.write_text(text.format("34"))
    (line,) = wrong(page, slow=False)
    right = marks.like(QUICK["created"].compute("2-2"), "0")
    assert line == f"page.md:1: created 2-2: 34, right is {right}"
    assert marks.update(page, VALUES, slow=False) == 1
    assert page.read_text() == text.format(right)
    assert wrong(page, slow=False) == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<!-- =scalars -->48", "is not closed"),
        ("48<!-- = -->", "is not closed"),
        ("<!-- =scalar -->48<!-- = --> <!-- =x -->", "is not closed"),
        ("of <!-- =scalarz -->48<!-- = -->", "there is no value 'scalarz'"),
        ("<!-- =scalars -->48<!-- = --> of them", "may not begin a line"),
        ("- <!-- =scalars -->48<!-- = --> of them", "may not begin a line"),
        ("of <!-- =counts test|footpad -->48<!-- = -->", "may not begin a line or have a |"),
        ("of <!-- =scalars -->many<!-- = -->", "'many' is no number"),
    ],
)
def test_a_mark_that_cannot_be_read_is_an_error(tmp_path, monkeypatch, text, message):
    monkeypatch.setattr(marks, "ROOT", tmp_path)
    page = tmp_path / "page.md"
    page.write_text(text)
    with pytest.raises(ValueError, match=message):
        wrong(page, slow=False)
