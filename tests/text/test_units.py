"""Numbers and units in text: the right value, or an error, never another number."""

from __future__ import annotations

import re
from decimal import Decimal, localcontext
from math import isclose
from pathlib import Path

import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytest import approx

from rlv_landing import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import (
    BASE_UNITS,
    DISPLAY_UNITS,
    INPUT_QUANTITIES,
    OUTPUT_QUANTITIES,
    Quantity,
)
from rlv_landing.studies.limits import LIMITS
from rlv_landing.text.units import (
    AMBIGUOUS,
    LONGEST,
    PLAIN,
    PREFIXED,
    PREFIXES,
    UnitError,
    parse_number,
    parse_unit,
    split,
)
from rlv_landing.text.values import check_together, example, parse_value, to_si

ROOT = Path(__file__).parents[2]
SYMBOLS = sorted(
    {*PLAIN, *PREFIXED, *(p + symbol for p in PREFIXES for symbol in PREFIXED)} - {*AMBIGUOUS}
)
PINT = pint.UnitRegistry()
# what pint writes otherwise, or understands otherwise
PINT_NAMES = {"Nm": "N*m", "Ns": "N*s", "t": "metric_ton", "%": "percent", "L": "liter"}
PRINTED = sorted(
    {unit for q in (*OUTPUT_QUANTITIES, *INPUT_QUANTITIES, *PARAMETER_QUANTITIES.values(),
                    *LIMITS.values()) for unit in (q.unit, q.display_unit) if unit}
    | {*BASE_UNITS, *DISPLAY_UNITS}
)  # fmt: skip
FINITE = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e60, max_value=1e60).filter(
    lambda x: x == 0.0 or abs(x) > 1e-60
)


def written(value: float, unit: str) -> str:
    """A value in SI as a text in `unit`, to 17 digits, as a careful program writes it."""
    with localcontext(prec=60):
        return f"{Decimal(value) / parse_unit(unit).size:.16e} {unit}"


def quantity(unit: str) -> Quantity:
    return Quantity(unit, "a quantity", name="q")


def of_dimension(unit: str) -> Quantity:
    """A quantity whose SI unit has the dimension of `unit`."""
    symbols = zip(("m", "kg", "s", "rad"), parse_unit(unit).dimension)
    return quantity(".".join(f"{s}{power}" for s, power in symbols if power))


@given(st.sampled_from([*SYMBOLS, *PRINTED]), FINITE)
@settings(max_examples=400)
def test_value_to_text_to_value_is_the_identity(unit, value):
    assert parse_value(of_dimension(unit), written(value, unit)) == value


@pytest.mark.parametrize("symbol", SYMBOLS)
def test_every_symbol_has_the_size_that_pint_gives_it(symbol):
    name = next(
        (s for s in sorted(PREFIXED, key=len, reverse=True)
         if symbol not in PLAIN and symbol.endswith(s)
         and (symbol == s or symbol[: -len(s)] in PREFIXES)),
        symbol,
    )  # fmt: skip
    prefix = symbol[: -len(name)]
    factor = 10.0 ** PREFIXES[prefix] if prefix else 1.0
    size = PINT.Quantity(1.0, PINT_NAMES.get(name, name)).to_base_units().magnitude
    assert float(parse_unit(symbol).size) == approx(factor * size, rel=1e-14)


def test_no_symbol_can_be_read_in_two_ways():
    readings = [*PLAIN, *PREFIXED, *(p + symbol for p in PREFIXES for symbol in PREFIXED)]
    assert len(readings) == len(set(readings))


@pytest.mark.parametrize("unit", PRINTED)
def test_units_of_the_tables_have_the_dimension_of_their_si_unit(unit):
    si = DISPLAY_UNITS.get(unit, (unit, 1.0))[0]
    base = BASE_UNITS[si]
    assert parse_unit(unit).dimension == tuple(base.get(b, 0) for b in ("m", "kg", "s", "rad"))
    if unit in DISPLAY_UNITS:
        assert isclose(parse_unit(unit).size, DISPLAY_UNITS[unit][1], rel_tol=1e-15)
    else:
        assert parse_unit(unit).size == 1


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("1 cm2", "m2", 1e-4),
        ("1 cm^2", "m2", 1e-4),
        ("1 cm**2", "m2", 1e-4),
        ("1 cm\u00b2", "m2", 1e-4),
        ("1 dm2", "m2", 1e-2),
        ("1 mm2", "m2", 1e-6),
        ("1 km2", "m2", 1e6),
        ("1 um2", "m2", 1e-12),
        ("1 \u00b5m2", "m2", 1e-12),
        ("1 in2", "m2", 0.00064516),
        ("1 cm3", "m3", 1e-6),
        ("1 dm3", "m3", 1e-3),
        ("1 mm3", "m3", 1e-9),
        ("1 L", "m3", 1e-3),
        ("1 ml", "m3", 1e-6),
        ("9.81 m/s2", "m/s2", 9.81),
        ("9.81 m/s/s", "m/s2", 9.81),
        ("9.81 m s-2", "m/s2", 9.81),
        ("9.81 m\u00b7s\u207b\u00b2", "m/s2", 9.81),
        ("9.81 m / s^2", "m/s2", 9.81),
        ("1 kg/m3", "kg/m3", 1.0),
        ("0.96 t/m3", "kg/m3", 960.0),
        ("1 kg/dm3", "kg/m3", 1000.0),
        ("190 kg.m2", "kg.m2", 190.0),
        ("190 kg*m2", "kg.m2", 190.0),
        ("190 kg m2", "kg.m2", 190.0),
        ("190 kg\u00b7m\u00b2", "kg.m2", 190.0),
        ("190 kg*m**2", "kg.m2", 190.0),
        ("1 kg.cm2", "kg.m2", 1e-4),
        ("2 kN\u00b7m", "N.m", 2e3),
        ("2 kNm", "N.m", 2e3),
        ("5 kN.s/m", "N.s/m", 5e3),
        ("5 kN s/m", "N.s/m", 5e3),
        ("5 N.s/mm", "N.s/m", 5e3),
        ("3 N/mm", "N/m", 3e3),
        ("3 N/(m)", "N/m", 3.0),
        ("1 N/mm2", "Pa", 1e6),
        ("1 kg/(m.s2)", "Pa", 1.0),
        ("1 bar", "Pa", 1e5),
        ("1 mbar", "Pa", 100.0),
        ("2 rad/s", "rad/s", 2.0),
        ("180 \u00b0/s", "rad/s", 3.141592653589793),
        ("30 rpm", "rad/s", 3.141592653589793),
        ("36 km/h", "m/s", 10.0),
        ("5 1/s", "Hz", 5.0),
        ("5/s", "Hz", 5.0),
        ("1.5 s/m", "s/m", 1.5),
        ("20 %", "", 0.2),
        ("20%", "", 0.2),
        ("0.05", "", 0.05),
        (".5", "", 0.5),
        ("5.", "", 5.0),
        ("+5e-3", "", 5e-3),
        ("36mm", "m", 0.036),
        ("36\u00a0mm", "m", 0.036),
        ("36\u202fmm", "m", 0.036),
        ("\u22122 deg", "rad", -0.03490658503988659),
        ("\u20132 deg", "rad", -0.03490658503988659),
        ("\u20112 deg", "rad", -0.03490658503988659),
        ("\uff0d2 deg", "rad", -0.03490658503988659),
        ("2e\u22123 m", "m", 2e-3),
        ("-2 degrees", "rad", -0.03490658503988659),
    ],
)
def test_a_text_has_its_right_value(text, unit, value):
    assert to_si(quantity(unit), text) == approx(value, rel=2e-16, abs=0.0)


@pytest.mark.parametrize(
    ("text", "unit", "reason"),
    [
        ("1,5 deg", "rad", "write a point instead of the comma: 1.5 deg"),
        ("0,05", "", "write a point instead of the comma: 0.05"),
        ("1,234.5 m", "m", "a point and no commas"),
        ("1_000 m", "m", "no underscores"),
        ("\u0661\u0662 m", "m", "digits are 0 to 9"),
        ("\uff11 m", "m", "digits are 0 to 9"),
        ("\u00b2 m", "m", "digits are 0 to 9"),
        ("0x10", "", "a number is decimal"),
        ("1 000 m", "m", "no blanks"),
        ("1\u202f000 m", "m", "no blanks"),
        ("9**9**9**9 deg", "rad", "nothing is calculated"),
        ("2*3 m", "m", "nothing is calculated"),
        ("(2) m", "m", "nothing is calculated"),
        ("5*m", "m", "nothing is calculated"),
        ("2^3", "", "nothing is calculated"),
        ("1+1 m", "m", "is not a number"),
        ("1-5 m", "m", "is not a number"),
        ("1/2 m", "m", "nothing is calculated"),
        ("5 1/2 m", "m", "no blanks"),
        ("- 2 m", "m", "does not start with a number"),
        ("--2 m", "m", "does not start with a number"),
        ("\u22122\u2212", "", "is not a number"),
        ("m", "m", "does not start with a number"),
        ("", "m", "does not start with a number"),
        ("1.2.3", "", "is not a number"),
        ("1e5.5", "", "is not a number"),
        ("1e9999", "", "is not a number"),
        ("1e999", "", "beyond the largest number"),
        ("1e300 Qm", "m", "beyond the largest number"),
        ("1e-400", "", "1e-400 is below the smallest number, 4.9e-324 in SI; write 0"),
        ("-0.001e-400 m", "m", "below the smallest number"),
        ("1e-300 qm", "m", "below the smallest number"),
        ("inf m", "m", "does not start with a number"),
        ("1 g", "kg", "gram or gravity"),
        ("1 g", "m/s2", "gram or gravity"),
        ("1 kt", "kg", "there is no unit 'kt'"),
        ("1 kdegree", "rad", "there is no unit"),
        ("1 mmm", "m", "there is no unit"),
        ("1 kkg", "kg", "there is no unit"),
        ("1 M", "m", "there is no unit 'M'"),
        ("1 MM", "m", "there is no unit"),
        ("1 KN", "N", "there is no unit 'KN'"),
        ("1 n", "N", "there is no unit 'n'"),
        ("1 N/m.s", "N/m", "under the stroke"),
        ("1 N/m s", "N/m", "under the stroke"),
        ("1 m^2.5", "m2", "is no unit"),
        ("1 m22", "m2", "is no unit"),
        ("1 m0", "", "is no unit"),
        ("1 m 2", "m2", "is no unit"),
        ("1 m//s", "m/s", "is no unit"),
        ("1 m/", "m", "is no unit"),
        ("1 m.", "m", "is no unit"),
        ("1 N/(m/s)", "N", "is no unit"),
        ("1 (N.s)/m", "N.s/m", "is not a number"),
        ("1 m\u200b", "m", "is no unit"),
        ("1 \u0433", "kg", "is no unit"),
        ("1 " + "m" * LONGEST, "m", "more than 100"),
        ("9" * 400, "m", "more than 100"),
    ],
)
def test_what_is_no_number_with_a_unit_is_refused_with_the_reason(text, unit, reason):
    with pytest.raises(LandingError, match=re.escape(reason)) as e:
        to_si(quantity(unit), text)
    assert "q = " in str(e.value) or "q is" in str(e.value)


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("1 Hz", "rad/s"),
        ("1 1/s", "rad/s"),
        ("1/s", "rad/s"),
        ("1 rad", ""),
        ("20 deg", ""),
        ("20 %", "rad"),
        ("1 m", "rad"),
        ("1 kg", "N"),
        ("1 cm2", "m3"),
        ("1 N/m", "N.s/m"),
        ("1 m/s", "m/s2"),
        ("1 lb", "N"),
        ("1 lbf", "kg"),
    ],
)
def test_another_dimension_is_refused(text, unit):
    with pytest.raises(LandingError, match="has the wrong unit"):
        to_si(quantity(unit), text)


@given(st.text(alphabet="0123456789.+-eE_,*^/() mkgsNradPin%\u2212\u00b2\u0661x", max_size=14))
@settings(max_examples=1500)
def test_any_text_is_a_number_and_a_product_of_known_units_or_refused(text):
    """An independent reading: strict number, then symbols with powers, by pint."""
    try:
        number, unit = split(text)
        value = parse_unit(unit).to_si(number) if unit else parse_number(text)
    except UnitError:
        return
    plain = re.sub("[\u2010-\u2013\u2212]", "-", text.strip())
    assert plain.startswith(number[:1])
    assert number == plain[: len(number)]
    rest = plain[len(number) :].strip()
    if not rest:
        assert repr(value) == repr(float(number))
        return
    rest = re.sub(r"\*\*|\^", "", rest.replace("\u00b2", "2"))
    spelt = re.sub(r"([A-Za-z%]+)(-?[0-9])?", lambda m: _for_pint(m[1], m[2]), rest)
    spelt = re.sub(r"(?<=[\w)])[ .]+(?=[\w(])", "*", "1" + spelt if spelt[0] == "/" else spelt)
    assert value == approx(
        float(number) * PINT.Quantity(spelt).to_base_units().magnitude, rel=1e-12
    )


def _for_pint(symbol: str, power: str | None) -> str:
    return f"({PINT_NAMES.get(symbol, symbol)})**({power or 1})"


@pytest.mark.parametrize(
    "q", [*PARAMETER_QUANTITIES.values(), *INPUT_QUANTITIES, *LIMITS.values()], ids=lambda q: q.name
)
def test_the_text_that_an_error_recommends_is_accepted(q):
    if q.kind == "string":
        return
    with pytest.raises(LandingError, match="write for example") as e:
        parse_value(q, "much")
    recommended = str(e.value).rpartition("write for example ")[2].strip('"')
    assert recommended == example(q).strip('"')
    assert parse_value(q, recommended) == approx(float(q.default), rel=1e-5)


@pytest.mark.parametrize(
    "values", [("-10", "10 deg"), ("-10 deg", "10"), (1.0, "5 deg"), ("1 deg", 2)]
)
def test_values_given_together_all_have_a_unit_or_none(values):
    with pytest.raises(LandingError, match="give every value its unit"):
        check_together(quantity("rad"), values)


@pytest.mark.parametrize("values", [("0", "10 deg"), (0, "5 deg"), ("1", "2"), ("1 deg", "1 rad")])
def test_a_zero_needs_no_unit(values):
    check_together(quantity("rad"), values)


def rows_of(page: str, heading: str) -> list[tuple[str, str]]:
    """The rows of the table below this heading on a page of the documentation."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    table = text[text.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [tuple(cell.strip() for cell in row.strip("|").split("|")) for row in table]


@pytest.mark.parametrize(("texts", "si"), rows_of("units.md", "| text | in SI |"))
def test_the_page_gives_right_values(texts, si):
    value, _, unit = si.partition(" ")
    for text in re.findall("`(.*?)`", texts):
        assert to_si(quantity(unit), text) == float(value)


@pytest.mark.parametrize(("text", "reason"), rows_of("units.md", "| text | reason |"))
def test_the_page_gives_right_reasons(text, reason):
    with pytest.raises(LandingError, match=re.escape(reason)):
        to_si(quantity(""), text.strip("`"))


@pytest.mark.parametrize("text", ["0", "-0.0", "0e-400", "0.000e5 m", "1e-320 m", "4.94e-324"])
def test_zero_and_the_smallest_numbers_are_taken(text):
    assert to_si(quantity("m"), text) == float(text.split()[0])


def test_a_text_has_no_number():
    with pytest.raises(LandingError, match=r"vehicle\.body_points is a text and has no number"):
        to_si(PARAMETER_QUANTITIES["vehicle.body_points"], "0 1 2")
