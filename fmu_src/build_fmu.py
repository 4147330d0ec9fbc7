"""Builds `build/RlvLanding.fmu`: the slave, its own copy of the package with the compiled core, and pythonfmu's binary.

Run by `build_fmu.sh`. The FMU is validated by FMPy and landed once before it takes its place.
"""

from __future__ import annotations

import re
import shutil
import sys
import tempfile
from pathlib import Path

import fmpy
from fmpy.validation import validate_fmu
from pythonfmu.builder import FmuBuilder

HERE = Path(__file__).parent
PACKAGE = HERE / "rlv_landing"
MODULES = ("__init__.py", "errors.py", "quantities.py", "parameters.py", "touchdown.py", "landing.py")


def version() -> str:
    """The package's version, as its `__init__.py` says."""
    found = re.search(r'^__version__ = "(.+)"$', (PACKAGE / "__init__.py").read_text(), re.M)
    if found is None:
        raise SystemExit("error: rlv_landing/__init__.py states no __version__")
    return found[1]


def lay_out(folder: Path) -> tuple[Path, Path]:
    """Copy slave and package to `folder` under names that carry the version, so that two versions live in one process."""
    name = "rlv_landing_" + re.sub(r"\W", "_", version())
    package = folder / name
    (package / "core").mkdir(parents=True)
    for module in MODULES:
        shutil.copy(PACKAGE / module, package / module)
    for file in sorted((PACKAGE / "core").iterdir()):
        if file.suffix in (".py", ".so", ".pyd"):
            shutil.copy(file, package / "core" / file.name)
    shutil.copy(HERE.parent / "LICENSE", package / "LICENSE")
    slave = folder / name.replace("rlv_landing", "landing_fmu")
    slave = slave.with_name(slave.name + ".py")
    text = (HERE / "landing_fmu.py").read_text()
    slave.write_text(re.sub(r"^from rlv_landing\b", f"from {name}", text, flags=re.M))
    return slave, package


def check(fmu: Path) -> str:
    """Validate the FMU's description and land it once; say what came of it. Raises SystemExit with what is wrong."""
    problems = validate_fmu(str(fmu))
    if problems:
        raise SystemExit("error: the FMU is not valid: " + "; ".join(problems))
    result = fmpy.simulate_fmu(str(fmu), stop_time=0.2, output_interval=1e-3, output=["leg[1].main_strut.force", "energy.balance"])
    force, balance = result["leg[1].main_strut.force"].min(), abs(result["energy.balance"]).max()
    if not (force < -1000.0 and balance < 1e-3):
        raise SystemExit(f"error: the FMU's trial landing is off: strut force {force:g} N, energy balance {balance:g} J")
    return f"valid; trial landing: main strut 1 down to {force:.0f} N, energy balance within {balance:.1e} J"


def main(destination: str) -> None:
    """Build, check, and only then put the FMU in place."""
    target = Path(destination)
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as name:
        folder = Path(name)
        slave, package = lay_out(folder)
        built = FmuBuilder.build_FMU(
            slave, dest=folder / "out" / "RlvLanding.fmu", project_files=[package], canGetAndSetFMUstate=True, canSerializeFMUstate=True
        )
        found = check(built)
        shutil.copy(built, target.with_suffix(".part"))
        target.with_suffix(".part").replace(target)
    print(f"{target}: {found}")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else str(HERE.parent / "build" / "RlvLanding.fmu"))
