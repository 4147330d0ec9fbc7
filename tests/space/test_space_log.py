"""Logs of landings in space: recorded, shown, verified bit for bit, read back, replayed."""

from __future__ import annotations

import csv
from pathlib import Path
from random import Random

import bridge_tools
import numpy as np
import pytest
from five_legs import DECK, five_legs
from log_tools import assert_bytes_are_known
from rclpy.serialization import serialize_message
from rerun.chunk import RrdReader

from rlv_landing import Landing
from rlv_landing.core import SpatialInputs
from rlv_landing.figures.ground.drawn import in_view
from rlv_landing.figures.ground.shape import GroundShape, deck_of
from rlv_landing.figures.ground.turn import deck_matrix, deck_place
from rlv_landing.presets import to_toml
from rlv_landing.quantities import interface_of
from rlv_ros_bridge.fmu.builds import build_metadata
from rlv_ros_bridge.logs.history import log_history
from rlv_ros_bridge.logs.peaks import landing_peaks, peak_texts
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recorder import RecordedTopic, Recorder
from rlv_ros_bridge.logs.verification.repeat import RepeatedRun
from rlv_ros_bridge.logs.verification.verify import verify
from rlv_ros_bridge.messages.columns import readings_of
from rlv_ros_bridge.messages.fields import Vehicle
from rlv_ros_bridge.messages.inputs import input_table_of
from rlv_ros_bridge.messages.qos import TELEMETRY
from rlv_ros_bridge.messages.samples import SampleBytes
from rlv_ros_bridge.messages.topics import APPLIED, APPLIED_GROUND, APPLIED_WRENCH, topics_of
from rlv_ros_bridge.node.input_queue import InputChange
from rlv_ros_bridge.viewer.rerun_scene import curves

SPACE = interface_of("space", 5)
STOP_TIME = 0.4
COLUMNS = [name for names, _ in readings_of(SPACE).values() for name in names]


@pytest.fixture(scope="module")
def recorded(space_fmu: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of a landing of the FMU on five legs, by the node."""
    folder = tmp_path_factory.mktemp("log") / "space"
    return bridge_tools.record(space_fmu, folder, "--stop-time", STOP_TIME)


def test_the_node_records_a_landing_of_the_fmu_in_space(recorded: Path) -> None:
    history, landing = log_history(recorded), Landing(five_legs()).run(STOP_TIME, 1e-3)
    assert list(history.names) == COLUMNS
    assert {"body.q_w", "body.spin_y", "leg[5].contact.force_z"} <= set(COLUMNS)
    for name in COLUMNS:
        assert np.array_equal(history[name], landing[name]), name
    assert history.extremes is not None
    assert (
        history.extremes["leg[5].contact.force"][2:] == landing.extreme("leg[5].contact.force")[2:]
    )


def test_it_is_verified_bit_for_bit_by_landing_and_by_the_fmu(
    recorded: Path, space_fmu: Path
) -> None:
    for fmu in (None, space_fmu):
        found = verify(LogReader(recorded), fmu)
        assert (found.same, found.other_bits, found.first) == (True, 0, None)
        assert (found.instants, found.peaks) == (401, len(SPACE.peaks))


def test_its_messages_are_compared_by_their_bytes(recorded: Path) -> None:
    assert_bytes_are_known(LogReader(recorded))


def test_it_is_shown_and_exported(recorded: Path, command, tmp_path: Path) -> None:
    shown = command("log", "info", str(recorded))
    assert shown.code == 0
    assert "/landing/leg_5/contact" in shown.out
    assert "  5   " in shown.out
    film = str(tmp_path / "landing.gif")
    drawn = command("animate", str(recorded), film, "--fps", "10", "--view", "3d", "--end", "0.1")
    assert (drawn.code, drawn.err) == (0, "")
    file, picture = tmp_path / "landing.csv", tmp_path / "landing.png"
    exported = command("log", "export", str(recorded), str(file), "--plot", str(picture))
    assert exported.code == 0, exported.err
    assert picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    with file.open() as text:
        assert next(csv.reader(text)) == ["time", *COLUMNS]


def test_the_planar_fmu_does_not_repeat_it(recorded: Path, fmu: Path, command) -> None:
    done = command("log", "verify", str(recorded), "--fmu", str(fmu))
    assert done.code == 2
    assert "drop.mode = space" in done.err
    assert done.err.count("\n") == 1


def log_with_inputs(
    folder: Path, decks: list[SpatialInputs], kind: str = "radial", stop_time: float = STOP_TIME
) -> LogReader:
    """A log as the node writes it, of a landing on a ship and in gusts, in all directions.

    `decks` gets where the deck is at each sample; the legs are of a `kind`.
    """
    sea = {"sea.wave_height": 1.0, "sea.direction": 1.0, "sea.seed": 4.0, "sea.time": 9.0}
    parameters = five_legs().with_values({**sea, "leg.kind": kind})
    random = Random(7)
    table, names = input_table_of(SPACE), topics_of(SPACE.legs)
    packer, landing = SampleBytes(Vehicle.of(parameters)), Landing(parameters)
    entries = [
        RecordedTopic(f"/landing/{t.name}", t.type_name, TELEMETRY)
        for t in (*names.sampled, *APPLIED)
    ]
    metadata = {
        "mode": "space",
        "namespace": "/landing",
        "step_size": "0.001",
        "stop_time": repr(stop_time),
        **build_metadata(Path("none")),
    }
    attachments = {"parameters.toml": to_toml(parameters).encode()}
    recorder = Recorder(folder, entries, metadata, attachments)
    wanted = [(t, part) for t, part in zip(packer.topics, packer.slices) if t in names.sampled]

    def change_inputs(k: int) -> None:
        for topic, prefix in ((APPLIED_WRENCH, "external."), (APPLIED_GROUND, "ground.")):
            if k == 0 or random.random() < 0.1:
                sizes = {n: DECK.get(n, 0.01) for n in SPACE.input_names if n.startswith(prefix)}
                values = {name: random.uniform(0.5, 1.0) * size for name, size in sizes.items()}
                landing.set_inputs(values)
                message = InputChange(topic, k * 1_000_000, values, table).message()
                data = serialize_message(message)
                recorder.write(f"/landing/{topic.name}", k * 1_000_000, data)

    change_inputs(0)
    for k in range(round(stop_time * 1e3) + 1):
        landing.advance_to(k * 1e-3)
        decks.append(deck_of(landing.ground_places()))
        messages = packer.pack(k * 1_000_000, landing.values())
        for topic, part in wanted:
            recorder.write(f"/landing/{topic.name}", k * 1_000_000, messages[part])
        if k:
            change_inputs(k)
    recorder.close(peak_texts(landing_peaks(landing), stop_time))
    return LogReader(folder)


def test_a_run_with_all_inputs_is_repeated_bit_for_bit(space_fmu: Path, tmp_path: Path) -> None:
    reader = log_with_inputs(tmp_path / "log", [])
    for fmu in (None, space_fmu):
        found = verify(reader, fmu)
        assert (found.first, found.other_bits) == (None, 0)
        assert found.inputs > 40
        assert found.peaks == len(SPACE.peaks)


def test_a_run_on_tripods_is_repeated_bit_for_bit(tmp_path: Path) -> None:
    reader = log_with_inputs(tmp_path / "log", [], "tripod", 0.12)
    found = verify(reader, None)
    assert (found.first, found.other_bits) == (None, 0)
    assert found.peaks == len(interface_of("space", 5, "tripod").peaks)
    history = log_history(tmp_path / "log")
    assert (
        max(np.ptp(history[f"leg[{leg}].auxiliary_strut_2.force"]) for leg in range(1, 6)) > 100.0
    )


def test_a_film_of_it_shows_the_deck_as_it_moved(command, tmp_path: Path) -> None:
    decks: list[SpatialInputs] = []
    reader, film = log_with_inputs(tmp_path / "log", decks), tmp_path / "landing.gif"
    reader.read_through()
    chosen = range(0, 401, 7)
    assert RepeatedRun(reader).decks([k * 1e-3 for k in chosen]) == [decks[k] for k in chosen]
    size = ("--fps", "10", "--slow-motion", "1", "--width", "320")
    done = command("animate", str(tmp_path / "log"), str(film), *size)
    assert (done.code, done.err) == (0, "")
    assert f"{film}: 5 frames" in done.out


def test_the_viewer_shows_it_with_attitude_all_feet_and_the_moved_deck(
    command, tmp_path: Path
) -> None:
    log_with_inputs(tmp_path / "log", [])
    film = tmp_path / "landing.rrd"
    done = command("view", str(tmp_path / "log"), "--save", str(film))
    assert (done.code, done.err) == (0, "")
    found: dict[str, int] = {}
    for chunk in RrdReader(film).stream():
        if chunk.is_static or "sim_time" not in chunk.timeline_names:
            continue
        entity, batch = str(chunk.entity_path).strip("/"), chunk.to_record_batch()
        found[entity] = found.get(entity, 0) + batch.num_rows
        if entity == "vehicle/footpads":
            (places,) = [name for name in batch.schema.names if "position" in name]
            assert {len(row) for row in batch.column(places).to_pylist()} == {5}
    parts = ("body", "main_struts", "auxiliary_struts", "footpads", "contact_force", "ground")
    drawn = {curve.entity for curve in curves("space", SPACE.legs)}
    assert set(found) == {f"vehicle/{part}" for part in parts} | drawn
    assert "body/attitude" in drawn
    assert set(found.values()) == {round(STOP_TIME * 1e3) + 1}


def test_the_ground_of_the_viewer_turns_as_that_of_films() -> None:
    deck = SpatialInputs(*[0.0] * 18)._replace(surge=0.2, sway=-0.1, roll=0.1, yaw=0.5, tilt=-0.2)
    plane = five_legs().with_values({"ground.terrain": ""})
    shape = GroundShape(plane, (-1.0, 1.0), (-1.0, 1.0))
    moved = in_view(shape.area()) @ deck_matrix(deck).T + deck_place(deck)
    assert np.allclose(moved, in_view(shape.area(deck)), atol=1e-15)
    assert {len(line) for line in shape.lines()} == {2}
    assert len(shape.lines()) == 18
