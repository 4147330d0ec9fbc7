"""Compiles the core where Cython and a C compiler are there; without them the package works, slowly, from the same files."""

import sys
from pathlib import Path

from setuptools import Extension, setup

ROOT = Path(__file__).parent
sys.path.insert(0, str(ROOT / "fmu_src"))


def extensions() -> list[Extension]:
    """The one extension module, or none without Cython."""
    try:
        from Cython.Build import cythonize
    except ImportError:
        return []
    from core_source import COMPILE_ARGS, DIRECTIVES, MODULE, write_source

    source = write_source(Path("build") / "core")
    translated = cythonize([Extension(f"{source.parent.name}.{MODULE}", [str(source)])], compiler_directives=DIRECTIVES, quiet=True)
    return [Extension(f"rlv_landing.core.{MODULE}", translated[0].sources, extra_compile_args=COMPILE_ARGS, optional=True)]


setup(ext_modules=extensions())
