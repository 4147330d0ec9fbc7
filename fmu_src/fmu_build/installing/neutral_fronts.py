"""Compiles fronts without an identity, for the package's wheel; called by setup.py."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from xml.etree.ElementTree import Element

from ..binary import compile_fronts, compilers, made_of
from ..fronts.header import neutral_header
from ..fronts.prebuilt import keep
from ..sources import HERE, source


def compile_neutral(folder: Path) -> list[str]:
    """Compile the front of this machine's platform.

    Args:
        folder: The folder for them, which is made.

    Returns:
        FMI's names of the platforms.

    Raises:
        ImportError: pythonfmu, which describes the slave, or what the slave needs is missing.
        SystemExit: FMI's headers or a C compiler are missing, or the front does not compile.
    """
    root = describe_slave()
    folder.mkdir(parents=True, exist_ok=True)
    used = compile_fronts(neutral_header(root), lambda platform: folder / platform, compilers())
    keep(folder, made_of(root), used)
    return list(used)


def describe_slave() -> Element:
    """Root of the description that pythonfmu gives of the slave."""
    script = source("fmu_src/landing_fmu.py")
    sys.path.insert(0, str(HERE))
    spec = importlib.util.spec_from_file_location(script.stem, script)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    root: Element = module.RlvLanding(instance_name="", resources="").to_xml()
    return root
