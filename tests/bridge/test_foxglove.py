"""The layout for Foxglove shows what is in a log."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rlv_landing.figures.style import COLOURS
from rlv_landing.quantities import MODES
from rlv_ros_bridge.logs.reader import LogReader

LAYOUT = Path(__file__).resolve().parents[2] / "ros_bridge" / "config" / "foxglove.json"
LEGS_OF = {
    f"leg {leg}": (leg, colour)
    for group, colour in zip(MODES["2-2"], COLOURS)
    for leg, _ in group.legs
}
STEP = re.compile(r'\.(?P<name>\w+)|\[(?P<index>:|\d+)\]|\{(?P<key>\w+)=="(?P<value>[^"]*)"\}')


@pytest.fixture(scope="module")
def layout() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(LAYOUT.read_text(encoding="utf-8"))
    return found


@pytest.fixture(scope="module")
def last(one_log: Path) -> dict[str, Any]:
    """The last message of every topic of a log, decoded."""
    reader = LogReader(one_log)
    data = {message.topic: message.data for message in reader.messages()}
    return {topic: reader.decoder(topic)(data) for topic, data in data.items()}


def at(path: str, last: dict[str, Any]) -> list[Any]:
    """The values at a message path of Foxglove, `/topic.field[0].list[:]{key=="name"}.value`."""
    topic = re.match(r"[/\w]+", path)
    assert topic is not None
    found, end = [last[topic[0]]], topic.end()
    for step in STEP.finditer(path, end):
        assert step.start() == end, f"{path}: {path[end:]} is no path"
        end = step.end()
        if step["name"]:
            found = [getattr(value, step["name"]) for value in found]
        elif step["index"] == ":":
            found = [element for value in found for element in value]
        elif step["index"]:
            found = [value[int(step["index"])] for value in found]
        else:
            found = [value for value in found if getattr(value, step["key"]) == step["value"]]
    assert end == len(path), f"{path}: {path[end:]} is no path"
    return found


def panels(place: Any) -> Iterator[str]:
    """The panels of a layout, as they are placed."""
    if isinstance(place, str):
        yield place
    else:
        assert 0.0 < place["splitPercentage"] < 100.0
        yield from panels(place["first"])
        yield from panels(place["second"])


def test_every_panel_has_its_place_and_its_settings(layout: dict[str, Any]) -> None:
    placed = list(panels(layout["layout"]))
    assert sorted(placed) == sorted(layout["configById"])
    assert {panel.split("!")[0] for panel in placed} == {
        "3D",
        "Plot",
        "StateTransitions",
        "DiagnosticSummary",
    }


def test_every_topic_is_in_a_log(layout: dict[str, Any], last: dict[str, Any]) -> None:
    settings = layout["configById"]
    assert set(settings["3D!vehicle"]["topics"]) <= set(last)
    assert settings["DiagnosticSummary!health"]["topicToRender"] in last
    shown = [topic for topic, how in settings["3D!vehicle"]["topics"].items() if how["visible"]]
    assert "/landing/markers" in shown
    frames = {marker.header.frame_id for marker in last["/landing/markers"].markers}
    assert frames == {
        settings["3D!vehicle"]["followTf"],
        settings["3D!vehicle"]["layers"]["ground"]["frameId"],
    }


def test_every_message_path_leads_to_one_value_in_a_log(
    layout: dict[str, Any], last: dict[str, Any]
) -> None:
    paths = [
        (panel, path)
        for panel, how in layout["configById"].items()
        for path in how.get("paths", ())
    ]
    assert len(paths) == 21
    for panel, path in paths:
        (value,) = at(path["value"], last)
        assert isinstance(value, (str, bytes, int) if panel.startswith("State") else float), path[
            "value"
        ]
    # The end of the drop test, at 1 s: the vehicle still moves.
    assert at(layout["configById"]["StateTransitions!phase"]["paths"][0]["value"], last) == [
        "contact"
    ]


def test_legs_have_their_own_struts_and_colours(
    layout: dict[str, Any], last: dict[str, Any]
) -> None:
    coloured = []
    for panel, how in layout["configById"].items():
        for path in how.get("paths", ()):
            if path["label"] in LEGS_OF:
                leg, colour = LEGS_OF[path["label"]]
                assert path["color"] == colour
                index = re.search(r"\[(\d+)\]", path["value"])
                name = last["/landing/struts"].name[int(index[1])] if index else path["value"]
                assert f"leg_{leg}" in name
                assert index is None or name.endswith(
                    panel.split("!")[1].rsplit("-", 1)[0].replace("-", "_")
                )
                coloured.append(panel)
    assert len(coloured) == 4 * len(set(coloured)) == 16
