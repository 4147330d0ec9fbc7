"""The report: one self-contained page with every printed scalar, written whole or not at all."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from math import isnan

import pytest

from rlv_landing import LandingError, load_preset
from rlv_landing.figures.report import render_report, write_whole
from rlv_landing.history import History
from rlv_landing.tables.landing import number
from rlv_landing.tables.study_tables import measure_table
from rlv_landing.validation.measures import leg_work
from rlv_landing.validation.paper import printed_scalars
from rlv_landing.validation.validate import validate

VOID = {"meta", "link", "br", "hr", "img", "input"}


class Page(HTMLParser):
    """Tags with their attributes, texts by the id of their row, and unclosed tags."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.rows: dict[str, list[str]] = {}
        self.open: list[str] = []
        self.row = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, {k: v or "" for k, v in attrs}))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.row = dict(attrs).get("id") or ""

    def handle_startendtag(self, tag, attrs):
        self.tags.append((tag, {k: v or "" for k, v in attrs}))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.row and self.open and self.open[-1] in ("td", "b"):
            self.rows.setdefault(self.row, []).append(data)

    def ids(self) -> list[str]:
        return [a["id"] for _, a in self.tags if "id" in a]


@pytest.fixture(scope="module")
def text(validation) -> str:
    return render_report(validation, load_preset("yue2022-figures"), "yue2022-figures <&>")


@pytest.fixture(scope="module")
def page(text) -> Page:
    return Page(text)


def test_the_page_needs_nothing_from_elsewhere(page, text):
    assert page.open == []
    for tag, attributes in page.tags:
        assert tag not in ("script", "link", "img", "iframe", "object", "embed", "base")
        for name in ("src", "href", "xlink:href", "action", "data", "srcset"):
            assert attributes.get(name, "#").startswith("#"), (tag, attributes)
    assert "http" not in text
    assert "@import" not in text
    assert "url(#" in text
    assert text.count("url(") == text.count("url(#")


def test_every_printed_scalar_is_a_row_with_its_numbers_and_a_mark_on_a_curve(page, validation):
    ids = page.ids()
    ours = {c.scalar.id: c.ours for c in validation.all_comparisons}
    for s in printed_scalars():
        row = page.rows[f"scalar-{s.id}"]
        assert s.id in row
        assert number(s.simulation, s.unit) in row
        assert number(ours[s.id], s.unit) in row
        assert sum(i.endswith(f"-mark-{s.id}") for i in ids) == 1


def test_ids_are_unique_and_links_within_the_page_lead_somewhere(page):
    ids = Counter(page.ids())
    assert [i for i, n in ids.items() if n > 1] == []
    assert all(a["href"][1:] in ids for _, a in page.tags if "href" in a)


def test_there_is_a_picture_for_each_of_figures_7_to_19_named_for_those_who_cannot_see_it(
    page, text
):
    assert sum(tag == "svg" for tag, _ in page.tags) == 14
    assert all(a.get("aria-label") for tag, a in page.tags if tag == "svg")
    for figure in range(7, 20):
        assert f"Fig. {figure}" in text


def test_names_are_escaped(text):
    assert "yue2022-figures &lt;&amp;&gt;" in text


def test_the_command_writes_the_page_and_does_not_overwrite_unless_asked(command, tmp_path):
    path = tmp_path / "report.html"
    assert command("validate", "--mode", "2-2", "--html", str(path)).code == 0
    assert path.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    path.write_text("precious")
    done = command("validate", "--mode", "2-2", "--html", str(path))
    assert (done.code, path.read_text()) == (2, "precious")
    assert "report.html exists; --force overwrites it" in done.err
    assert command("validate", "--mode", "2-2", "--html", str(path), "--force").code == 0
    assert path.stat().st_size > 100_000
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]


def test_a_page_that_cannot_be_written_leaves_nothing_behind(tmp_path):
    (tmp_path / "report.html").mkdir()
    with pytest.raises(LandingError, match=r"report\.html cannot be written"):
        write_whole("page", tmp_path / "report.html")
    assert [p.name for p in tmp_path.iterdir()] == ["report.html"]


def test_a_landing_that_lacks_what_the_paper_prints_has_a_page_all_the_same():
    """Tilted back by 46 degrees, the vehicle falls over leg 1.

    The other legs never touch: their scalars are missing, the rest is shown.
    """
    thrown = load_preset("yue2022-figures").with_values(
        {"drop.tilt": -0.8, "drop.contact_time": 0.0}
    )
    found = validate(thrown, ("1-2-1",))
    missing = {c.scalar.id for c in found.all_comparisons if isnan(c.ours)}
    assert {"121-fm3-v1", "121-s3-max", "121-a-pk3"} <= missing
    page = Page(render_report(found, thrown, "thrown"))
    assert set(page.rows) == {f"scalar-{s.id}" for s in printed_scalars() if s.mode == "1-2-1"}
    assert {s["id"]: s["ours"] for s in found.record()["scalars"]}["121-fm3-v1"] is None


def test_measures_that_the_landing_cuts_off_are_dashes_with_the_reason(validation):
    """The landing cut at 0.3 s: legs 1 and 2 in rebound, 3 and 4 in compression."""
    whole = validation.histories["2-2"]
    part = whole.time <= 0.3
    cut = History(whole.time[part], whole.names, whole.data[part], whole.parameters)
    found = replace(validation, work={**validation.work, "2-2": leg_work(cut)})
    page = render_report(found, load_preset("yue2022-figures"), "cut")
    for line in (
        "2-2, leg 1: the landing ends in the first rebound: dissipated is not known",
        "2-2, leg 3: the landing ends in the first compression: no measures; run it longer",
    ):
        assert line in page
        assert line in measure_table(found)
    rows = [row for row in page.splitlines() if row.startswith("<tr><td>2-2</td>")]
    assert [row.count('<td class="n">-</td>') for row in rows] == [1, 1, 5, 5]
