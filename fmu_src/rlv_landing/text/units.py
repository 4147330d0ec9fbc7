"""Numbers and units in text, such as "-2 deg", "36 mm", "9.81 m/s2" or "5 kN.s/m".

A text is a number, a blank and a unit. Nothing in it is calculated: a unit is a product of symbols
with whole powers, and every symbol is looked up in a table. What the table does not hold, and what
can be read in two ways, is refused. Angles have a dimension of their own, so that 1/s is no rad/s.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal
from math import isinf
from operator import add

LONGEST = 100
# exponents of m, kg, s, rad
Dimension = tuple[int, int, int, int]
# enough digits for every product of a number of LONGEST characters and a size to be rounded once
_CONTEXT = Context(prec=150, Emax=MAX_EMAX, Emin=MIN_EMIN)
_PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")
_POUND_FORCE = Decimal("4.4482216152605")
_SQUARE_INCH = Decimal("0.00064516")

PREFIXES = {
    "Q": 30,
    "R": 27,
    "Y": 24,
    "Z": 21,
    "E": 18,
    "P": 15,
    "T": 12,
    "G": 9,
    "M": 6,
    "k": 3,
    "h": 2,
    "da": 1,
    "d": -1,
    "c": -2,
    "m": -3,
    "u": -6,
    "n": -9,
    "p": -12,
    "f": -15,
    "a": -18,
    "z": -21,
    "y": -24,
    "r": -27,
    "q": -30,
}
_LENGTH, _MASS, _TIME, _ANGLE = (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)
_FORCE, _PRESSURE, _ENERGY = (1, 1, -2, 0), (-1, 1, -2, 0), (2, 1, -2, 0)
_ONE = Decimal(1)

# symbol -> (size in SI, dimension); these take every SI prefix
PREFIXED: dict[str, tuple[Decimal, Dimension]] = {
    "m": (_ONE, _LENGTH),
    "g": (Decimal("1e-3"), _MASS),
    "s": (_ONE, _TIME),
    "rad": (_ONE, _ANGLE),
    "deg": (_CONTEXT.divide(_PI, Decimal(180)), _ANGLE),
    "N": (_ONE, _FORCE),
    "Nm": (_ONE, _ENERGY),
    "Ns": (_ONE, (1, 1, -1, 0)),
    "J": (_ONE, _ENERGY),
    "W": (_ONE, (2, 1, -3, 0)),
    "Pa": (_ONE, _PRESSURE),
    "bar": (Decimal("1e5"), _PRESSURE),
    "Hz": (_ONE, (0, 0, -1, 0)),
    "L": (Decimal("1e-3"), (3, 0, 0, 0)),
    "l": (Decimal("1e-3"), (3, 0, 0, 0)),
}
# these take none
PLAIN: dict[str, tuple[Decimal, Dimension]] = {
    "%": (Decimal("1e-2"), (0, 0, 0, 0)),
    "min": (Decimal(60), _TIME),
    "h": (Decimal(3600), _TIME),
    "t": (Decimal(1000), _MASS),
    "rpm": (_CONTEXT.divide(_PI, Decimal(30)), (0, 0, -1, 1)),
    "in": (Decimal("0.0254"), _LENGTH),
    "ft": (Decimal("0.3048"), _LENGTH),
    "lb": (Decimal("0.45359237"), _MASS),
    "slug": (_CONTEXT.divide(_POUND_FORCE, Decimal("0.3048")), _MASS),
    "lbf": (_POUND_FORCE, _FORCE),
    "psi": (_CONTEXT.divide(_POUND_FORCE, _SQUARE_INCH), _PRESSURE),
    "atm": (Decimal(101325), _PRESSURE),
    "knot": (_CONTEXT.divide(Decimal(1852), Decimal(3600)), (1, 0, -1, 0)),
    "mph": (Decimal("0.44704"), (1, 0, -1, 0)),
}
ALIASES = {"°": "deg", "degree": "deg", "degrees": "deg", "knots": "knot"}
AMBIGUOUS = {"g": "g may be gram or gravity; write kg, or m/s2"}

# hyphens, dashes and the sign U+2212 that stand for a minus
_MINUS = dict.fromkeys(map(ord, "\u2010\u2011\u2012\u2013\u2212\ufe63\uff0d"), "-")
_UNIT_CHARACTERS = str.maketrans(
    {
        **dict(zip("\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079\u207b", "123456789-")),
        **dict.fromkeys("\u00b7\u22c5\u2219\u2022*", "."),
        **dict.fromkeys("\u2044\u2215", "/"),
        **dict.fromkeys("\u00b5\u03bc", "u"),
    }
)
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_NO_NUMBER = re.compile(r"[+-]?(?:nan|inf|infinity)", re.IGNORECASE)
_HEXADECIMAL = re.compile(r"[+-]?0[xXoObB][0-9a-fA-F]")
_START_OF_UNIT = re.compile(r"(?: 1)? ?/ ?(?:[^\W\d_]|\()| ?(?:[^\W\d_]|[%\u00b0])|$")
_FACTOR = re.compile(r"([A-Za-z%\u00b0]+)(?:\^?(-?[1-9]))?")


class UnitError(ValueError):
    """A text is no number or unit; the message is the reason and the remedy."""


@dataclass(frozen=True)
class Unit:
    """A unit: its size in SI, and its exponents of m, kg, s, rad."""

    size: Decimal
    dimension: Dimension

    def to_si(self, number: str) -> float:
        """The value in SI of a number of this unit, rounded once.

        Args:
            number: The number as text, by `split`, or a float's `repr`.

        Raises:
            UnitError: The value is beyond the largest float, or so small that a float of it is 0.
        """
        product = number if self.size == _ONE else _CONTEXT.multiply(Decimal(number), self.size)
        value = float(product)
        if isinf(value) and "inf" not in number.lower():
            raise UnitError(f"{number} is beyond the largest number, 1.8e308 in SI")
        if value == 0.0 and not is_zero(number):
            raise UnitError(f"{number} is below the smallest number, 4.9e-324 in SI; write 0")
        return value

    def from_si(self, value: float) -> float:
        """A value in SI as a number of this unit, rounded once."""
        return float(_CONTEXT.divide(Decimal(repr(value)), self.size))


DIMENSIONLESS = Unit(_ONE, (0, 0, 0, 0))


def split(text: str) -> tuple[str, str]:
    """The number, in ASCII, and the unit of a text; the unit is empty where there is none.

    Digits are 0 to 9, with a point and an exponent; a minus may be U+2212 or a dash. `nan` and
    `inf` are numbers without a unit.

    Raises:
        UnitError: There is no such number at the start, or it is followed by what is no unit.
    """
    if len(text) > LONGEST:
        raise UnitError(f"it has {len(text)} characters, more than {LONGEST}")
    plain = " ".join(text.translate(_MINUS).split())
    if _NO_NUMBER.fullmatch(plain):
        return plain, ""
    found = _NUMBER.match(plain)
    if found is None:
        raise UnitError(_why_no_number(plain))
    rest = plain[found.end() :]
    if _HEXADECIMAL.match(plain) or not _START_OF_UNIT.match(rest):
        raise UnitError(_why_no_number(plain))
    return found[0], rest.lstrip()


def is_zero(number: str) -> bool:
    """Whether a number, as text, is 0, and not just so small that a float of it is."""
    return not any(c in "123456789" for c in number.lower().partition("e")[0])


def parse_number(text: str) -> float:
    """A number without a unit; `nan` and `inf` are numbers.

    Raises:
        UnitError: The text is no number, has a unit, or is too large or small for a float.
    """
    number, unit = split(text)
    if unit:
        raise UnitError(f"{unit!r} follows the number")
    return DIMENSIONLESS.to_si(number)


def parse_unit(text: str) -> Unit:
    """A unit from its text, such as m2, m^2, kg.m2, N s/m, m/s/s, N/(m.s) or 1/s.

    A product is written with a point, a middle dot, an asterisk or a blank. Powers are whole.

    Raises:
        UnitError: A symbol is unknown or ambiguous, or the text is no product of powers.
    """
    if len(text) > LONGEST:
        raise UnitError(f"the unit has {len(text)} characters, more than {LONGEST}")
    plain = text.translate(_MINUS).replace("**", "^").translate(_UNIT_CHARACTERS).strip()
    plain = re.sub(r"\s*([./^()])\s*", r"\1", plain)
    above, *below = re.sub(r"\s+", ".", plain).split("/")
    size, dimension = _ONE, DIMENSIONLESS.dimension
    factors = [] if below and above in ("", "1") else _factors(above, 1, text)
    for product in below:
        grouped = product.startswith("(") and product.endswith(")")
        if "." in product and not grouped:
            raise UnitError(
                f"what stands under the stroke of {text!r} is unclear; write a product before "
                "it, or each divisor after a stroke of its own"
            )
        factors += _factors(product[1:-1] if grouped else product, -1, text)
    for (own, exponents), power in factors:
        size = _CONTEXT.multiply(size, _CONTEXT.power(own, power))
        first, second, third, fourth = (
            add(sum_, power * e) for sum_, e in zip(dimension, exponents)
        )
        dimension = (first, second, third, fourth)
    return Unit(size, dimension)


def _factors(product: str, sign: int, text: str) -> list[tuple[tuple[Decimal, Dimension], int]]:
    found = []
    for part in product.split("."):
        factor = _FACTOR.fullmatch(part)
        if factor is None:
            raise UnitError(f"{text!r} is no unit; units are written as m/s2 or N.s/m")
        found.append((_symbol(factor[1]), sign * int(factor[2] or 1)))
    return found


def _symbol(name: str) -> tuple[Decimal, Dimension]:
    """Size and dimension of a symbol with or without a prefix."""
    name = ALIASES.get(name, name)
    if name in AMBIGUOUS:
        raise UnitError(AMBIGUOUS[name])
    for table in (PLAIN, PREFIXED):
        if name in table:
            return table[name]
    for length in (1, 2):
        prefix, symbol = name[:length], name[length:]
        if prefix in PREFIXES and symbol in PREFIXED:
            size, dimension = PREFIXED[symbol]
            return size.scaleb(PREFIXES[prefix], _CONTEXT), dimension
    raise UnitError(f"there is no unit {name!r}")


def _why_no_number(text: str) -> str:
    start = re.match(r"[^\sA-Za-z%\u00b0]*", text)
    number = start[0] if start else ""
    if re.fullmatch(r"[+-]?[0-9]*,[0-9]+", number):
        return f"write a point instead of the comma: {text.replace(',', '.')}"
    if "," in number:
        return "a number has a point and no commas"
    if _HEXADECIMAL.match(text):
        return "a number is decimal"
    if "_" in text:
        return "a number has no underscores"
    if any(c.isdigit() and not "0" <= c <= "9" for c in number):
        return "digits are 0 to 9"
    if re.match(r"[+-]?[0-9.]+ [0-9]", text):
        return "a number has no blanks"
    if any(c in "*/^()" for c in text):
        return "nothing is calculated: give the number itself"
    return "it does not start with a number"
