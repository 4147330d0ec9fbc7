"""Text files as users have them: what they say, or one line that says what to change."""

from __future__ import annotations

import codecs

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rlv_landing import LandingError, Parameters
from rlv_landing.errors import LONGEST_LINE, one_line
from rlv_landing.presets import parse_toml, read_toml, to_toml
from rlv_landing.studies.sweep.states_table import read_states
from rlv_landing.text.files import LARGEST_TEXT, parse_document, read_csv, toml_text
from rlv_landing.text.files import LONGEST_LINE as LONGEST_CSV_LINE
from rlv_landing.validation.curves import read_curves

CURVES = "time [ms],leg[1].main_strut.force [kN],body.pitch [deg]\n0,-1.5,1\n1,-2.5,2\n"
STATES = (
    "drop.tilt [deg],drop.pitch_rate,drop.horizontal_velocity,drop.vertical_velocity\n1,0,0,-1\n"
)
PARAMETERS = '[vehicle]\nmass = "200 kg"\n[drop]\ntilt = "\u22122 deg"\n'


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.encode(),
        lambda text: codecs.BOM_UTF8 + text.encode(),
        lambda text: text.replace("\n", "\r\n").encode(),
        lambda text: codecs.BOM_UTF8 + text.replace("\n", "\r\n").encode(),
        lambda text: text.replace("\n", "\r").encode(),
        lambda text: text.rstrip("\n").encode(),
        lambda text: (text + "\n\n").encode(),
    ],
    ids=["plain", "mark", "CRLF", "mark and CRLF", "CR", "no last end", "empty lines"],
)
def test_files_are_read_with_a_byte_order_mark_and_any_line_ends(tmp_path, change):
    toml, curves, states = tmp_path / "p.toml", tmp_path / "c.csv", tmp_path / "s.csv"
    toml.write_bytes(change(PARAMETERS))
    curves.write_bytes(change(CURVES))
    states.write_bytes(change(STATES))
    parameters = read_toml(toml)
    assert parameters.vehicle.mass == 200.0
    assert parameters.drop.tilt == -0.03490658503988659
    history = read_curves(curves)
    assert history.time.tolist() == [0.0, 1e-3]
    assert history["leg[1].main_strut.force"].tolist() == [-1500.0, -2500.0]
    assert history["body.pitch"].tolist() == [0.017453292519943295, 0.03490658503988659]
    assert read_states(states, [], []).columns["drop.tilt"].tolist() == [0.017453292519943295]


def test_files_with_nul_characters_are_refused_with_what_they_may_be(tmp_path):
    toml, curves, states = tmp_path / "p.toml", tmp_path / "c.csv", tmp_path / "s.csv"
    toml.write_bytes(PARAMETERS.encode("utf-16-le"))
    curves.write_text(CURVES.replace("2.5", "2\0.5"))
    states.write_bytes(STATES.encode() + bytes(100))
    for read in (
        lambda: read_toml(toml),
        lambda: read_curves(curves),
        lambda: read_states(states, [], []),
    ):
        with pytest.raises(LandingError, match="has NUL characters: it is torn, no text, or UTF-1"):
            read()


@pytest.mark.parametrize(
    ("separator", "name"), [(";", "semicolons"), ("\t", "tabs"), ("|", "strokes")]
)
def test_another_separator_is_named_with_the_remedy(tmp_path, separator, name):
    curves, states = tmp_path / "c.csv", tmp_path / "s.csv"
    curves.write_text(CURVES.replace(",", separator).replace(".5", ",5"))
    states.write_text(STATES.replace(",", separator))
    for read in (lambda: read_curves(curves), lambda: read_states(states, [], [])):
        with pytest.raises(LandingError, match=f"separated by {name}; separate it by commas"):
            read()


@pytest.mark.parametrize(
    ("encoding", "name"),
    [("utf-16", "UTF-16"), ("utf-32", "UTF-32"), ("cp1252", "not UTF-8"), ("latin-1", "not UTF-8")],
)
def test_another_encoding_is_named_with_the_remedy(tmp_path, encoding, name):
    toml, curves = tmp_path / "p.toml", tmp_path / "c.csv"
    toml.write_bytes('[vehicle]\nmass = { value = 1, source = "M\u00fcller" }\n'.encode(encoding))
    curves.write_bytes(CURVES.replace("deg", "\u00b0").encode(encoding))
    for read in (lambda: read_toml(toml), lambda: read_curves(curves)):
        with pytest.raises(LandingError, match=f"it is {name}; save it as UTF-8"):
            read()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[vehicle]\nmass = " + "9" * 400, "mass is a whole number of more than 64 bits"),
        ("[vehicle]\nmass = " + "9" * 5000, "a whole number of more than 64 bits"),
        ("[vehicle]\nmass = 0x" + "f" * 100_000, "mass is a whole number of more than 64 bits"),
        ("[vehicle]\nmass = 1e999", "vehicle.mass = inf kg is outside"),
        ("[vehicle]\nmass = '1e999'", "beyond the largest number"),
        ("[vehicle]\nmass = '1e-400'", "1e-400 is below the smallest number"),
        ("[vehicle]\nmass = 1_0.5e-400", "1_0.5e-400 is below the smallest number"),
        ("[vehicle]\nmass = " + "[" * 100_000, "nested too deep"),
        ("[vehicle]\nmass = " + "{a=" * 100_000, "nested too deep"),
        ("[vehicle]\nmass = " + "[" * 60 + "]" * 60, "nested more than 32 deep"),
        ("a" + ".a" * 100_000 + " = 1", "a key has more than 32 parts"),
        ("[vehicle.'a'" + ". b . 'c'" * 100_000 + "]", "a key has more than 32 parts"),
        ("[vehicle]\nmass = '" + "9**" * 20_000 + "9 kg'", "60004 characters, more than 100"),
        ("[vehicle]\nmass = '9**9**9**9 kg'", "nothing is calculated"),
        ("# " + "x" * LARGEST_TEXT, "larger than 4 MiB"),
    ],
    ids=lambda value: value[:40],
)
def test_huge_and_deep_values_are_refused_in_one_short_line(tmp_path, text, message):
    path = tmp_path / "p.toml"
    path.write_text(text)
    with pytest.raises(LandingError, match=message) as e:
        read_toml(path)
    assert len(f"error: {e.value}") <= LONGEST_LINE


def test_dots_of_numbers_texts_and_comments_are_no_parts_of_a_key():
    numbers = ", ".join(["0.5"] * 500)
    text = f'# {"." * 200}\na = [{numbers}]\nb = "{"." * 200}"\n'
    assert parse_document(text, "file")["b"] == "." * 200


@given(st.text(max_size=40))
def test_every_source_comes_back_from_toml_in_ascii(source):
    whole = source.encode("utf-8", "replace").decode("utf-8")
    assert parse_document(f"a = {toml_text(source)}", "text")["a"] == whole
    parameters = Parameters().with_values({"vehicle.mass": 200.0}, whole)
    text = to_toml(parameters)
    assert text.isascii()
    assert parse_toml(text, "text").source("vehicle.mass") == parameters.source("vehicle.mass")


def test_a_line_without_end_is_refused_and_not_read_to_its_end(tmp_path):
    path = tmp_path / "c.csv"
    path.write_text("x" * (LONGEST_CSV_LINE + 1))
    with pytest.raises(LandingError, match="a line of more than"):
        list(read_csv(path, "table"))


@given(st.text(max_size=600), st.integers(40, 300))
def test_an_error_is_one_printable_line(text, longest):
    line = one_line(text, longest)
    assert len(line) <= longest
    assert line.isprintable()
    if text.isprintable() and text == text.strip() and len(text) <= longest:
        assert line == text


def test_a_long_line_keeps_its_start_and_its_end():
    line = str(LandingError(f"vehicle.mass = '{'9' * 4000}' is no number; give it in kg"))
    assert line.startswith("vehicle.mass = '999")
    assert line.endswith("is no number; give it in kg")
