"""Compares the compiled core with the files that it was compiled from. It is no kernel."""

from __future__ import annotations

import warnings
from hashlib import sha256
from pathlib import Path
from types import ModuleType


def is_fresh(compiled: ModuleType) -> bool:
    """Whether the module `compiled` is of the present files; a RuntimeWarning where it is not.

    Files that are not there are not compared: an installed package may be without sources.
    """
    core = Path(__file__).parent
    kept: dict[str, str] = getattr(compiled, "SOURCES", {})
    changed = [
        name
        for name, digest in kept.items()
        if (core / name).is_file() and sha256((core / name).read_bytes()).hexdigest() != digest
    ]
    if kept and not changed:
        return True
    warnings.warn_explicit(
        f"the core was compiled before {', '.join(changed) or 'its files'} changed: the present "
        f"files run, ten times as slow; {how_to_compile()} compiles them",
        RuntimeWarning,
        # the place that the warning names, without a line of code
        str(compiled.__file__),
        0,
        "rlv_landing.core",
    )
    return False


def how_to_compile() -> str:
    """What compiles the core: in a checkout setup.py, elsewhere an installation by a compiler."""
    if Path(__file__).parents[3].joinpath("setup.py").is_file():
        return "python setup.py build_ext --inplace"
    return (
        "an installation anew where gcc and Python.h (on Debian: gcc, python3-dev) are: "
        "pip install --force-reinstall --no-cache-dir --no-deps with the same source or wheel"
    )
