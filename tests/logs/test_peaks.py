"""The record of a landing's true peaks at the end of its log."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bridge_tools import one_error_line, run
from log_tools import rewrite
from mcap.records import Metadata
from pyarrow import parquet
from pytest import approx

from rlv_landing import Landing, load_preset
from rlv_landing.quantities import LEGS, OUTPUT_NAMES, PEAKS
from rlv_landing.summary import summarise
from rlv_landing.tables.landing import summary_table
from rlv_ros_bridge.logs import landing_record
from rlv_ros_bridge.logs.history import log_history
from rlv_ros_bridge.logs.info import log_info
from rlv_ros_bridge.logs.landing_record import LANDING, LandingRows, read_landing
from rlv_ros_bridge.logs.landing_record import RECORD as LANDING_RECORD
from rlv_ros_bridge.logs.peaks import RECORD, landing_peaks, read_peaks
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.recover import recover
from rlv_ros_bridge.logs.verification.verify import verify

FORCE = "leg[1].main_strut.force.min"


def read(log: Path) -> LogReader:
    reader = LogReader(log)
    reader.read_through()
    return reader


def only_file(log: Path) -> Path:
    (file,) = log.glob("*.mcap")
    return file


def with_peaks(log: Path, target: Path, change) -> Path:
    """The log with the texts of its record of peaks changed; None takes the record away."""

    def apply(record):
        if isinstance(record, Metadata) and record.name == RECORD:
            texts = change(dict(record.metadata))
            return None if texts is None else replace(record, metadata=texts)
        return record

    return rewrite(only_file(log), target, apply)


def test_the_record_is_that_of_the_landing_to_the_last_digit(log: Path, mode: str) -> None:
    found, until = read_peaks(read(log).peaks, "log")
    landing = Landing(load_preset("yue2022-figures"), mode)
    landing.run(1.0)
    assert until == 1.0
    assert {f"peak.{name}": peak for name, peak in found.items()} == landing_peaks(landing)
    for peak in PEAKS:
        texts = json.loads(read(log).peaks[f"{peak.output}.{peak.side}"])
        assert texts["unit"] == peak.value.unit


def test_info_prints_peaks_that_lie_between_the_messages(log: Path, mode: str) -> None:
    info = log_info(LogReader(log))
    whole = Landing(load_preset("yue2022-figures"), mode).run(1.0)
    assert info.landing["peaks_of"] == "landing"
    for found, leg in zip(info.landing["legs"], summarise(whole)["legs"], strict=True):
        # what is found between samples by outputs that messages do not have
        works = ("main_strut_absorbed", "main_strut_dissipated", "main_strut_efficiency")
        between = {name: leg.pop(name) for name in ("contact_time", *works)}
        assert found.items() >= leg.items()
        assert {name: found[name] for name in works} == approx(
            {name: between[name] for name in works}, rel=1e-3
        )
        assert 0.0 <= found["contact_time"] - between["contact_time"] < 1e-3
    ground = max(leg["contact_force_max"] for leg in info.landing["legs"])
    assert ground > max(whole[f"leg[{leg}].contact.force"].max() for leg in LEGS)
    assert "peaks: of the landing, between its messages too" in info.text()


def test_the_tables_of_a_log_and_of_its_landing_have_the_same_peaks(log: Path, mode: str) -> None:
    """`node --report` prints this table of the log.

    A contact is that of its first sample there, and works are summed up from samples.
    """
    whole = Landing(load_preset("yue2022-figures"), mode).run(1.0)
    told, expected = (
        summary_table(history, "title").splitlines() for history in (log_history(log), whole)
    )
    legs = [line for line in expected if line.startswith("│")]
    # a table that is too wide comes in parts, each with a line for each leg
    assert len(legs) >= len(LEGS)
    assert len(legs) % len(LEGS) == 0
    for line, expected_line in zip([t for t in told if t.startswith("│")], legs, strict=True):
        (number, contact, *rest), (same, true_contact, *true_rest) = (
            text.strip("│").split("│") for text in (line, expected_line)
        )
        assert (number, rest[:-3]) == (same, true_rest[:-3])
        works = [[float(cell) for cell in cells[-3:]] for cells in (rest, true_rest)]
        assert works[0] == approx(works[1], rel=2e-3)
        assert 0.0 <= float(contact.split()[0]) - float(true_contact.split()[0]) < 1.5e-3
    assert told[-1] == expected[-1]
    assert told[-2] == expected[-2].partition(";")[0]


@pytest.mark.parametrize("change", ["all", "no record", "no summary"])
def test_info_by_the_summary_tells_what_reading_all_messages_tells(
    log: Path, tmp_path: Path, change: str
) -> None:
    data = only_file(log).read_bytes()
    file = tmp_path / "log.mcap"
    file.write_bytes(data[:-1] if change == "no summary" else data)
    if change == "no record":

        def apply(record):
            named = isinstance(record, Metadata) and record.name == LANDING_RECORD
            return None if named else record

        file = rewrite(file, tmp_path / "bare", apply)
    found, checked = log_info(LogReader(file)), log_info(LogReader(file), check=True)
    assert found.read == ("summary" if change == "all" else "whole")
    assert replace(found, read="checked") == checked
    assert found.complete == (change != "no summary")
    assert found.landing["legs"][0]["acceleration_peak"] > 0.0
    # One changed byte among the messages is found where all is read.
    changed = bytearray(file.read_bytes())
    changed[len(changed) // 2] ^= 1
    file.write_bytes(changed)
    assert not log_info(LogReader(file), check=True).complete


def test_a_record_of_another_layout_is_ignored(one_log: Path) -> None:
    texts = read(one_log).landing
    landing = json.loads(texts[LANDING])
    assert read_landing(texts) == landing
    for changed in (
        {},
        {**landing, "legs": landing["legs"][:3]},
        {**landing, "outcome": "\x1b[2J"},
        {**landing, "bottomed_out": [5]},
        {**landing, "end_time": "1"},
        {**landing, "legs": [{**leg, "contact_force_max": None} for leg in landing["legs"]]},
        {**landing, "legs": [{**leg, "contact_time": "soon"} for leg in landing["legs"]]},
        [],
    ):
        assert read_landing({LANDING: json.dumps(changed)}) is None
    assert read_landing({}) is read_landing({LANDING: "[" * 100_000}) is None


def test_no_record_is_made_of_a_landing_that_is_not_over_in_what_is_kept(monkeypatch) -> None:
    landing = Landing(load_preset("yue2022-figures"))
    history = landing.run(2.0)
    peaks = {name.removeprefix("peak."): peak for name, peak in landing_peaks(landing).items()}
    values = np.array([history[name] for name in OUTPUT_NAMES]).T
    for kept, made in ((2001, True), (1500, True), (150, False)):
        monkeypatch.setattr(landing_record, "MOST_SAMPLES", kept)
        rows = LandingRows(history.parameters)
        for part in (slice(0, 700), slice(700, None)):
            rows.add(history.time[part], values[part])
        found = read_landing(rows.texts(peaks))
        assert (found is not None) == made
        if found is not None:
            assert found["end_time"] == 2.0


def test_a_log_without_the_record_has_the_peaks_of_its_messages_and_says_so(
    one_log: Path, tmp_path: Path
) -> None:
    bare = with_peaks(one_log, tmp_path / "bare", lambda texts: None)
    info = log_info(LogReader(bare), check=True)
    history = log_history(bare)
    assert history.extremes is None
    assert info.landing["peaks_of"] == "samples"
    assert (
        info.landing["legs"][0]["main_strut_force_min"] == history["leg[1].main_strut.force"].min()
    )
    assert "peaks: of the messages" in info.text()
    done = verify(LogReader(bare))
    assert (done.same, done.peaks) == (True, 0)


def test_verify_compares_every_peak_and_its_time(one_log: Path, tmp_path: Path) -> None:
    done = verify(LogReader(one_log))
    assert (done.same, done.other_bits, done.peaks) == (True, 0, len(PEAKS))

    def other(texts: dict[str, str], what: str) -> dict[str, str]:
        record = json.loads(texts[FORCE])
        return {**texts, FORCE: json.dumps({**record, what: 1.1 * record[what]})}

    for what in ("value", "time"):
        changed = with_peaks(one_log, tmp_path / what, lambda texts, what=what: other(texts, what))
        first = verify(LogReader(changed)).first
        assert first is not None
        assert (first.topic, first.field) == ("the record of peaks", FORCE)


@pytest.mark.parametrize("text", ["", "{}", "[1, 2]", '{"value": NaN, "time": 0}', "5"])
def test_a_record_that_cannot_be_read_is_an_error_in_one_line(
    one_log: Path, tmp_path: Path, text: str
) -> None:
    changed = with_peaks(one_log, tmp_path / "changed", lambda texts: {**texts, FORCE: text})
    done = run("log", "export", changed, tmp_path / "out.csv")
    assert f"its record of peaks has {FORCE} = " in one_error_line(done)


def test_recover_keeps_the_record(one_log: Path, tmp_path: Path) -> None:
    data = bytearray(only_file(one_log).read_bytes())
    data[len(data) // 2] ^= 0xFF
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    recover(damaged, tmp_path / "recovered")
    assert read(tmp_path / "recovered").peaks == read(one_log).peaks


def test_parquet_carries_the_peaks_of_the_whole_landing_only(one_log: Path, tmp_path: Path) -> None:
    for name, options in (("whole", ()), ("part", ("--end", "0.2"))):
        done = run("log", "export", one_log, tmp_path / f"{name}.parquet", *options)
        assert done.returncode == 0, done.stderr
    whole, part = (
        parquet.read_schema(tmp_path / f"{name}.parquet").metadata for name in ("whole", "part")
    )
    found, _ = read_peaks(read(one_log).peaks, "log")
    told = json.loads(whole[b"peaks.json"])
    assert told["leg[1].main_strut.force"]["minimum"] == found[FORCE][0]
    assert told["leg[1].contact.force"] == {
        "maximum": found["leg[1].contact.force.max"][0],
        "maximum_time": found["leg[1].contact.force.max"][1],
    }
    assert b"peaks.json" not in part
