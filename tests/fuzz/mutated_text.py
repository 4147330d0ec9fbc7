"""Files as they come from other hands: mutated, re-encoded, with nonsense for values."""

from __future__ import annotations

import codecs
import random
import re
from collections.abc import Callable

# values that are no sensible number, text, list or table, as TOML and as cells
NONSENSE = (
    *("nan", "-inf", "1e999", "-0.0", "9" * 400, "9" * 5000, "0x" + "f" * 9000, "1e308", "-1"),
    *("true", "[]", "{}", "[[]]", "[1, 2]", '["a", 1]', "{ a = 1 }", "{ value = 1 }", "''", '""'),
    *("'1,5 deg'", "'\u22122 deg'", "'9**9**9**9 deg'", "'1 cm2'", "'2-2'", "'toppled'", "'*'"),
    *("1979-05-27T07:32:00Z", "07:32:00", "1979-05-27", "0", "1", "2", "0.5", "1e-300", "7"),
    *("'\\u0000'", '"\\u0000"', '"a\\u0000b"', "'/dev/null'", "'..'", "'.'", "'" + "n" * 300 + "'"),
    *("[" * 100_000, "{a=" * 3000, "[" * 200 + "]" * 200, "'" + "\u00e9" * 500 + "'", "[nan, nan]"),
    *("a" + ".a" * 5000 + " = 1", "{ value = {}, source = [] }", "{ source = 'me' }", "[{}]"),
    *("['a', 'a']", "[true]", "'drop.mode'", "'drop.tilt'", "'leg[*].main_strut.force.*'", "1_0"),
    *("1,5", "12;5", "\t", '"', "\u0661", "\u00a01", "1e400", "--1", "0x10", "'1 g'", "'1 mm'"),
)
PLAUSIBLE = ("0", "0.3", "1.5", "3", "'5 deg'", "'20 mm'", "'30 %'", "'2-2'", "['0 deg', '9 deg']")
KEYS = ("name", "value", "unit", "low", "values", "count", "mode", "preset", "drop", "a.b.c", "'x'")
PAIR = re.compile(r"^([^=\n]*=)(.*)$", re.MULTILINE)
CELL = re.compile(r"[^,\n]+")
Mutation = Callable[[bytes, random.Random], bytes]


def _text(change: Callable[[str, random.Random], str]) -> Mutation:
    return lambda data, r: change(data.decode("utf-8", "replace"), r).encode("utf-8", "replace")


def _replace_one(
    pattern: re.Pattern[str], by: Callable[[re.Match[str], random.Random], str]
) -> Mutation:
    def change(text: str, r: random.Random) -> str:
        found = list(pattern.finditer(text))
        if not found:
            return text
        m = r.choice(found)
        return text[: m.start()] + by(m, r) + text[m.end() :]

    return _text(change)


def _moved(text: str, r: random.Random) -> str:
    lines = text.splitlines(keepends=True) or [""]
    at, to = r.randrange(len(lines)), r.randrange(len(lines))
    kind = r.randrange(3)
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(to, lines[at])
    else:
        lines[at], lines[to] = lines[to], lines[at]
    return "".join(lines)


def _inserted(text: str, r: random.Random) -> str:
    lines = text.splitlines(keepends=True)
    lines.insert(r.randrange(len(lines) + 1), f"{r.choice(KEYS)} = {r.choice(NONSENSE)}\n")
    return "".join(lines)


def _bytes(data: bytes, r: random.Random) -> bytes:
    mutant = bytearray(data or b"\n")
    for _ in range(r.choice((1, 1, 2, 5))):
        at, length = r.randrange(len(mutant) or 1), r.choice((1, 2, 9, 60))
        kind = r.randrange(4)
        if kind == 0 and mutant:
            mutant[at] ^= 1 << r.randrange(8)
        elif kind == 1:
            mutant[at:at] = r.randbytes(length)
        elif kind == 2:
            del mutant[at : at + length]
        else:
            mutant[at:at] = mutant[at : at + length]
    return bytes(mutant)


def _encoded(data: bytes, r: random.Random) -> bytes:
    text = data.decode("utf-8", "replace")
    return r.choice(
        (
            codecs.BOM_UTF8 + data,
            text.replace("\n", "\r\n").encode(),
            text.replace("\n", "\r").encode(),
            text.encode("utf-16"),
            text.encode("utf-16-le"),
            text.encode("utf-32"),
            ("# \u00e9\u00b0\n" + text).encode("cp1252", "replace"),
            text.replace(",", ";").encode(),
            text.replace(",", "\t").encode(),
            data + b"\0",
            data + b"\x1a",
            b"",
        )
    )


GENTLE: tuple[Mutation, ...] = (
    _replace_one(PAIR, lambda m, r: m[1] + r.choice(PLAUSIBLE)),
    _replace_one(CELL, lambda m, r: r.choice(("0.1", "2", "-1e-3", " 5 "))),
    _text(_moved),
)
MUTATIONS: tuple[Mutation, ...] = (
    _replace_one(PAIR, lambda m, r: m[1] + r.choice(NONSENSE)),
    _replace_one(PAIR, lambda m, r: f"{r.choice(KEYS)} = {m[2]}"),
    _replace_one(re.compile(r"^\[[^\[\]\n]*\]$", re.MULTILINE), lambda m, r: f"[{r.choice(KEYS)}]"),
    _replace_one(
        re.compile(r"^\[([^\[\]\n]*)\]$", re.MULTILINE),
        lambda m, r: f"{m[1]} = {r.choice(NONSENSE)}",
    ),
    _replace_one(CELL, lambda m, r: r.choice(NONSENSE)),
    _text(_inserted),
    _bytes,
    _encoded,
)


def mutated(data: bytes, r: random.Random) -> bytes:
    """`data` after one to four random mutations, half of them gentle."""
    for _ in range(r.choice((1, 1, 2, 4))):
        data = r.choice(r.choice((GENTLE, MUTATIONS)))(data, r)
    return data
