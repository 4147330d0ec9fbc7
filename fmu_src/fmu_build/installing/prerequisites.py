"""Says in one line what `make` needs and this machine lacks; run by the Makefile, by any Python.

It imports nothing besides the standard library, since nothing else is installed yet.
"""

from __future__ import annotations

import os
import shlex
import shutil
import sys
import sysconfig
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

OLDEST, NEWEST = (3, 10), (3, 13)


def python_lacks() -> str:
    """What is wrong with this Python's version; empty if nothing is."""
    version = sys.version_info[:2]
    if OLDEST <= version <= NEWEST:
        return ""
    found, oldest, newest = (".".join(map(str, v)) for v in (version, OLDEST, NEWEST))
    return f"python {found} found, {oldest} to {newest} needed; name one: make PYTHON=python3.12"


def packages_lacking(wanted: Sequence[str], python: str) -> dict[str, str]:
    """Debian's packages that are missing, each with what is missed.

    Args:
        wanted: `venv`, `headers` and `compiler`, those that are needed.
        python: The command that runs this Python, as its user names it.
    """
    # Debian's default Python has packages without a version; all others have it in the name
    name = "python3"
    if Path(python).name not in ("python", "python3"):
        name = f"python{sys.version_info[0]}.{sys.version_info[1]}"
    present = {
        "venv": find_spec("venv") is not None and find_spec("ensurepip") is not None,
        "headers": (Path(sysconfig.get_paths()["include"]) / "Python.h").is_file(),
        "compiler": shutil.which(_compiler()) is not None,
    }
    package = {"venv": f"{name}-venv", "headers": f"{name}-dev", "compiler": "gcc"}
    missed = {"venv": "venv", "headers": "Python.h", "compiler": "a C compiler"}
    return {package[need]: missed[need] for need in wanted if not present[need]}


def _compiler() -> str:
    """The C compiler that CC names, or gcc."""
    try:
        words = shlex.split(os.environ.get("CC", ""))
    except ValueError:
        words = []
    return words[0] if words else "gcc"


def message(wanted: Sequence[str], python: str) -> str:
    """One line on what is missing, empty if nothing is; arguments as for `packages_lacking`."""
    wrong = python_lacks()
    if wrong:
        return f"error: {wrong}"
    lacking = packages_lacking(wanted, python)
    if not lacking:
        return ""
    things = " and ".join(lacking.values())
    verb = "are" if len(lacking) > 1 else "is"
    return (
        f"error: {things} {verb} missing; on Debian and Ubuntu: apt install {' '.join(lacking)}; "
        "then run make again"
    )


if __name__ == "__main__":
    sys.exit(message(sys.argv[2:], sys.argv[1]) or None)
