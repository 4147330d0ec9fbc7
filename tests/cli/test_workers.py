"""Studies use the cores that their process may use, not all of the machine's."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from rlv_landing import load_preset
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.identify import Search
from rlv_landing.identification.objective import Objective
from rlv_landing.identification.targets import paper_targets
from rlv_landing.workers import default_workers

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="sets processor affinity")
STUDY = """
[study]
method = "lhs"
samples = 2
until = 0.1
[[factor]]
name = "ground.friction"
low = 0.2
high = 0.6
"""


@pytest.fixture
def one_core() -> Iterator[None]:
    """This process may use one core during the test."""
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(allowed)})
    yield
    os.sched_setaffinity(0, allowed)


def test_the_default_is_the_cores_that_the_process_may_use():
    assert default_workers() == len(os.sched_getaffinity(0))


@pytest.mark.usefixtures("one_core")
def test_a_sweep_plans_with_one_worker_on_one_core(command: Callable, tmp_path: Path):
    (tmp_path / "study.toml").write_text(STUDY)
    done = command("sweep", str(tmp_path / "study.toml"), "--dry-run", "--json")
    assert done.code == 0
    assert json.loads(done.out)["workers"] == 1


@pytest.mark.usefixtures("one_core")
def test_an_identification_takes_one_worker_on_one_core(tmp_path: Path):
    numbers = FreeNumbers(load_preset("yue2022-figures"), ["ground.friction"], {})
    assert Search(Objective(numbers, paper_targets()), tmp_path / "work").workers == 1
