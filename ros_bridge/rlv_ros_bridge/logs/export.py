"""Writes a landing's history from a log to CSV or Parquet."""

from __future__ import annotations

import io
import json
import math
from pathlib import Path

import numpy as np

from rlv_landing.errors import LandingError
from rlv_landing.history import History
from rlv_landing.presets import to_toml
from rlv_landing.quantities import OUTPUT_NAMES, OUTPUT_QUANTITIES
from rlv_landing.text.durable import unwritable, write_durably

ENDINGS = (".csv", ".parquet")
UNITS = {"time": "s", **{name: q.unit for name, q in zip(OUTPUT_NAMES, OUTPUT_QUANTITIES)}}
# Instants are whole nanoseconds; a bound given in s may miss one by its last digit [s].
TIME_TOLERANCE = 1e-9


def select_rows(
    history: History,
    start: float | None = None,
    end: float | None = None,
    every: float | None = None,
) -> History:
    """The rows of `history` in a span of time, or one row in each period of it.

    Args:
        history: the landing.
        start: first time [s]; None: that of the history.
        end: last time [s], included; None: that of the history.
        every: period [s], of which the first row is taken; None: all rows. No row is interpolated.

    Raises:
        LandingError: there is no row in the span, or a value is out of bounds.
    """
    for name, value in (("--start", start), ("--end", end), ("--every", every)):
        if value is not None and not np.isfinite(value):
            raise LandingError(f"{name} = {value:g} s must be finite")
    if every is not None and every <= 0.0:
        raise LandingError(f"--every = {every:g} s must be above 0 s")
    t = history.time
    first = t[0] if start is None else start
    last = t[-1] if end is None else end
    rows = np.flatnonzero((t >= first - TIME_TOLERANCE) & (t <= last + TIME_TOLERANCE))
    if not len(rows):
        raise LandingError(
            f"no instant lies from {first:g} s to {last:g} s; "
            f"the log goes from {t[0]:g} s to {t[-1]:g} s"
        )
    if every is not None:
        periods = np.floor((t[rows] - t[rows[0]] + TIME_TOLERANCE) / every)
        rows = rows[np.flatnonzero(np.diff(periods, prepend=-1.0) > 0.0)]
    # peaks of the whole landing are none of a part of it
    extremes = history.extremes if start is None and end is None else None
    return History(
        t[rows], history.names, history.data[rows], history.parameters, extremes=extremes
    )


def write_history(history: History, path: Path) -> None:
    """Writes `history` to `path`, as CSV or Parquet by its ending, whole or not at all.

    Numbers have full precision. Parquet columns carry their units, and the file the parameters as
    TOML and the landing's peaks as JSON, SI, if they are known.

    Raises:
        LandingError: another ending, pyarrow is missing, or the disk refuses.
    """
    if path.suffix not in ENDINGS:
        raise LandingError(f"{path} must end in {' or '.join(ENDINGS)}")
    try:
        if path.suffix == ".csv":
            history.to_csv(path)
        else:
            write_durably(path, _parquet(history))
    except OSError as e:
        raise unwritable(path, e) from None


def _known(extreme: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in extreme.items() if not math.isnan(value)}


def _parquet(history: History) -> bytes:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError as e:
        raise LandingError(
            f'Parquet needs pyarrow ({e}); install it with pip install "rlv-landing[mcap]", '
            "or export to .csv"
        ) from None
    fields = [
        pyarrow.field(name, pyarrow.float64(), metadata={"unit": UNITS.get(name, "")})
        for name in history
    ]
    metadata = (
        {"parameters.toml": to_toml(history.parameters)} if history.parameters is not None else {}
    )
    if history.extremes is not None:
        metadata["peaks.json"] = json.dumps(
            {name: _known(found._asdict()) for name, found in history.extremes.items()}
        )
    table = pyarrow.table(
        [history[name] for name in history], schema=pyarrow.schema(fields, metadata=metadata)
    )
    out = io.BytesIO()
    parquet.write_table(table, out)
    return out.getvalue()
