"""Values that the benchmarks measured: the last row of a case in `benchmarks/results.jsonl`."""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

from marks import ROOT, Value

RESULTS = ROOT / "benchmarks" / "results.jsonl"


@lru_cache
def last_rows() -> dict[str, dict[str, Any]]:
    """The last row of each case."""
    rows = map(json.loads, RESULTS.read_text(encoding="utf-8").splitlines())
    return {row["case"]: row for row in rows}


def bench(case: str, key: str, factor: str = "1") -> float:
    """A measured number, times a factor (to other units).

    `case` is that of the row, `key` its field, with `[i]` behind for an item of a list.
    """
    name, _, item = key.partition("[")
    value = last_rows()[case][name]
    return float(value[int(item[:-1])] if item else value) * float(factor)


def ratio(case: str, other: str, key: str, factor: str = "1") -> float:
    """A measured number of one case over that of another, times a factor."""
    return bench(case, key, factor) / bench(other, key)


def difference(case: str, other: str, key: str, factor: str = "1") -> float:
    """A measured number of one case less that of another, times a factor."""
    return bench(case, key, factor) - bench(other, key, factor)


def rate(case: str, count: str, key: str = "seconds") -> float:
    """How many a second: a count over a measured time."""
    return float(count) / bench(case, key)


MEASURED = {
    compute.__name__: Value(compute, slow=False) for compute in (bench, ratio, difference, rate)
}
