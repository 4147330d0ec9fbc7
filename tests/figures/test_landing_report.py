"""The report of one's own vehicles: page and PDF have every table, and their numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from five_legs import five_legs
from test_report import Page

from rlv_landing import Landing, load_preset
from rlv_landing.figures.landing_report.page import page
from rlv_landing.figures.landing_report.sections import Landed, side_by_side, tables_of
from rlv_landing.figures.top_view import margin_of, seen_from_above
from rlv_landing.figures.wireframe import wireframe
from rlv_landing.studies.whole_landing import whole_landing
from rlv_landing.summary import summarise


@pytest.fixture(scope="module")
def found() -> Landed:
    return Landed("mine <&>", Landing(load_preset("yue2022-figures", "1-2-1")).run(0.6, 1e-3))


def test_the_page_is_whole_and_has_every_table_and_picture_of_each_landing(found):
    text = page([found])
    read = Page(text)
    assert read.open == []
    assert len(read.ids()) == len(set(read.ids()))
    pictures = [a["aria-label"] for tag, a in read.tags if tag == "svg"]
    assert len(pictures) == 7
    assert "mine &lt;&amp;&gt;" in text
    assert "mine <&>" not in text
    for table in tables_of(found):
        assert text.count(f"<h3>{table.title}</h3>") == 1
    assert not any(a.get("src") or a.get("href", "#")[0] != "#" for _, a in read.tags)


def test_the_first_table_has_a_column_for_each_landing_with_its_numbers(found):
    table = side_by_side([found, found])
    rows = {row[0]: row[1:] for row in table.rows}
    leg = summarise(found.history)["legs"][0]
    force = max(-each["main_strut_force_min"] for each in summarise(found.history)["legs"])
    assert rows["largest main strut force"] == (f"{force / 1e3:.4g} kN",) * 2
    assert rows["outcome"][0].startswith(found.outcome.name)
    legs = next(t for t in tables_of(found) if t.title == "Legs")
    assert legs.rows[0][2] == f"{leg['main_strut_force_min'] / 1e3:.3f}"


def test_a_damper_without_liquid_has_no_pressures(found):
    p = found.parameters
    struck = replace(p, main_strut=replace(p.main_strut, kind="spring-damper", stiffness=2e5))
    dry = Landed("dry", Landing(struck).run(0.3, 1e-3))
    assert not any("pressure" in head for t in tables_of(dry) for head in t.head)
    assert dict(side_by_side([dry]).rows)["highest pressure"] == "no liquid"


def test_the_command_writes_page_and_pdf_and_refuses_what_is_no_vehicle_of_it(
    tmp_path, command, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    done = command("report", "yue2022-figures", "--no-audit", "--until", "0.3", "-o", "mine.pdf")
    assert (done.code, done.err) == (0, "")
    assert done.out.splitlines()[-1] == "report: mine.pdf"
    content = (tmp_path / "mine.pdf").read_bytes()
    assert content.startswith(b"%PDF")
    assert content.count(b"/Type /Page ") >= 9
    for arguments, said in (
        (("missing.toml",), "missing.toml"),
        (("yue2022-figures", "-o", "mine.txt"), "must end in .html or .pdf"),
        (("yue2022-figures", "-o", "mine.pdf"), "--force"),
    ):
        refused = command("report", *arguments)
        assert (refused.code, refused.err.count("\n")) == (2, 1)
        assert said in refused.err


def test_a_landing_in_space_has_every_leg_and_its_own_touchdown(tmp_path, command):
    written = command(
        *("report", "yue2022-figures", "--mode", "space", "--no-audit", "--until", "0.2"),
        *("-o", str(tmp_path / "space.html")),
    )
    assert (written.code, written.err) == (0, "")
    text = (tmp_path / "space.html").read_text()
    for title in (
        "The vehicle",
        "Movement",
        "Footpads from above",
        "Loads at the interfaces",
        "All parameters",
    ):
        assert title in text
    found = Landed("five", Landing(five_legs()).run(0.4, 1e-3))
    tables = {table.title: table for table in tables_of(found)}
    names = {row[0] for row in tables["Touchdown"].rows}
    assert {"drop.heading", "drop.roll_rate", "ground.slope_direction"} <= names
    assert [row[0] for row in tables["Legs"].rows] == ["1", "2", "3", "4", "5"]
    loads = {row[0] for row in tables["Loads at the interfaces"].rows}
    assert {f"leg {leg}, footpad" for leg in range(1, 6)} <= loads


def test_the_view_from_above_has_the_model_s_margin():
    history = Landing(five_legs()).run(0.4, 0.05)
    feet, center = seen_from_above(history, np.arange(len(history)))
    found = [margin_of(f, c) for f, c in zip(feet, center)]
    assert np.allclose(found, history["status.stability_margin"], atol=1e-12)


def test_a_vehicle_that_topples_in_space_says_over_which_edge():
    p = five_legs().with_values({"drop.lateral_velocity": 6.0, "ground.friction": 1.0})
    found = Landed("over", whole_landing(Landing(p), 3.0, 1e-3))
    assert found.outcome.name == "toppled"
    (over,) = (row[1] for t in tables_of(found) for row in t.rows if row[0] == "toppled over")
    assert over.startswith("the edge legs ")


def test_in_space_feet_are_drawn_where_the_landing_has_them():
    own = {"leg[2].main_strut.joint_radius": 0.5, "leg[2].auxiliary_strut.length": 1.2}
    history = Landing(five_legs().with_values(own)).run(0.4, 1e-2)
    feet = wireframe(history, history.parameters, range(len(history)))["feet"][:, :, 0]
    for i, leg in enumerate(history.legs):
        place = np.column_stack([history[f"leg[{leg}].footpad.{axis}"] for axis in "xyz"])
        assert np.abs(feet[:, i] - place).max() < 1e-12
