"""Fixtures of all tests: the built FMU, one run of each drop test, Ecos' program."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import settings

from rlv_landing import Landing, load_preset
from rlv_landing.cli import main
from rlv_landing.history import History
from rlv_landing.validation.validate import Validation, validate

ROOT = Path(__file__).resolve().parent.parent
# the example's modules, as its `run.py` finds them
sys.path.insert(0, str(ROOT / "examples" / "ship_deck"))
# what tests of several folders share, and those of the bridge
sys.path[:0] = [str(ROOT / "tests" / "shared"), str(ROOT / "tests" / "bridge")]

from bridge_tools import domain, log, one_log, processes  # noqa: E402, F401
from five_legs import five_legs  # noqa: E402

# the time that one example takes depends on the machine
settings.register_profile("suite", deadline=None)
settings.load_profile("suite")
MODES = ("2-2", "1-2-1")


@pytest.fixture(autouse=True)
def no_width_of_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables are as wide as in a file, whatever terminal the suite is started from."""
    monkeypatch.delenv("COLUMNS", raising=False)


@pytest.fixture(scope="session")
def many() -> Callable[[int], int]:
    """Scale the number of a random test's cases: by RLV_TORTURE in the environment, else by 1."""
    return lambda count: round(count * float(os.environ.get("RLV_TORTURE", "1")))


@pytest.fixture(scope="session")
def fmu() -> Path:
    """The built FMU. Tests fail without it: `make test` builds it."""
    path = Path(os.environ.get("RLV_FMU", ROOT / "build" / "RlvLanding.fmu"))
    assert path.is_file(), f"{path} is missing: run ./build_fmu.sh"
    return path


@pytest.fixture(scope="session")
def fmu3(fmu: Path) -> Path:
    """The built FMU of FMI 3.0. Tests fail without it: `make test` builds it."""
    path = fmu.with_name("RlvLanding3.fmu")
    assert path.is_file(), f"{path} is missing: run ./build_fmu.sh --fmi 3"
    return path


def _space_fmu(folder: Path, fmi: str) -> Path:
    from fmu_build.build import build
    from fmu_build.wanted import Wanted

    path = folder / f"Space{fmi}.fmu"
    build(path, Wanted(five_legs(), "five legs", "FiveLegs", fmi=fmi))
    return path


@pytest.fixture(scope="session")
def space_fmu(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of a landing in space on five legs."""
    return _space_fmu(tmp_path_factory.mktemp("space"), "2")


@pytest.fixture(scope="session")
def space_fmu3(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMU of FMI 3.0 of a landing in space on five legs."""
    return _space_fmu(tmp_path_factory.mktemp("space3"), "3")


@pytest.fixture(scope="session", params=MODES)
def mode(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="session")
def drop_test(mode: str) -> History:
    """The drop test of `mode` with the preset yue2022-figures, 1 s at 0.2 ms."""
    return Landing(load_preset("yue2022-figures"), mode).run(1.0, 2e-4)


@pytest.fixture(scope="session")
def validation() -> Validation:
    """Both drop tests of the preset yue2022-figures beside the paper."""
    return validate(load_preset("yue2022-figures"))


class Ended(NamedTuple):
    """A command's exit code and what it printed."""

    code: int
    out: str
    err: str


@pytest.fixture
def command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Ended]:
    """`command(*arguments)` runs `rlv-landing` in this process."""

    def run(*arguments: str) -> Ended:
        monkeypatch.setattr(sys, "argv", ["rlv-landing", *arguments])
        usual = signal.getsignal(signal.SIGINT)
        try:
            with pytest.raises(SystemExit) as ended:
                main()
        finally:
            signal.signal(signal.SIGINT, usual)
        captured = capsys.readouterr()
        return Ended(int(ended.value.code or 0), captured.out, captured.err)

    return run


@pytest.fixture(scope="session")
def ecos_environment() -> dict[str, str]:
    """The environment with the libtbb that Ecos needs on the loader's path.

    The wheel `tbb` puts the library where the loader does not look.
    """
    libraries = [str(Path(sys.prefix) / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]
    return {**os.environ, "LD_LIBRARY_PATH": os.pathsep.join(filter(None, libraries))}


@pytest.fixture(scope="session")
def ecos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ecos' program. Its wheel does not mark it executable, so this is a copy."""
    program = tmp_path_factory.mktemp("ecos") / "ecos"
    shutil.copy(
        Path(str(find_spec("ecospy").submodule_search_locations[0])) / "binaries" / "ecos", program
    )
    program.chmod(0o755)
    return program


@pytest.fixture
def simulated_by_ecos(
    ecos: Path, ecos_environment: dict[str, str], tmp_path: Path
) -> Callable[..., np.ndarray]:
    """Run `ecos simulate` on an FMU or SSP file; return the table that it writes.

    `ecos` is a C++ program without Python. Call it as `simulated_by_ecos(path, *options)`.
    """

    def run(path: Path, *options: str) -> np.ndarray:
        environment = {
            name: value for name, value in ecos_environment.items() if not name.startswith("PYTHON")
        }
        command = [str(ecos), "simulate", "--path", str(path), "--stepSize", "0.001", *options]
        done = subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return np.genfromtxt(
            tmp_path / f"{path.stem}.csv",
            delimiter=", ",
            names=True,
            deletechars="",
            replace_space=" ",
        )

    return run
