"""Interface of every host: `python with_HOST.py FMU JOB.json RESULT.npy`.

The job has `parameters` by name; `inputs` by name, 0 at first and set after the step
`inputs_after`; `step` [s] and `steps`; `outputs`, name -> kind (real, integer, boolean). The result
has a row for each communication point after the start: its time, then the outputs.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np


def host(land: Callable[[str, dict[str, Any]], Iterable[Iterable[float]]]) -> None:
    """Read the job that the command line names, do it with `land(fmu, job)`, and write its rows."""
    fmu, job, result = sys.argv[1:]
    rows = land(fmu, json.loads(Path(job).read_text(encoding="utf-8")))
    np.save(result, np.array([[float(v) for v in row] for row in rows]))
