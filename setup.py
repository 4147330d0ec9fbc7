"""Compiles the core if Cython and a C compiler are installed: Zig's, else the usual one.

Without them the package runs the same files uncompiled, slowly. From Python 3.11 on the binary uses
the limited API, so one serves all later versions, in the FMU as well. The limited API of 3.10 has
no buffers, so a binary compiled there serves 3.10 alone.
"""

import os
import shlex
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup

ROOT = Path(__file__).parent
LIMITED = sys.version_info >= (3, 11) and not sysconfig.get_config_var("Py_GIL_DISABLED")
sys.path.insert(0, str(ROOT / "fmu_src"))


def extensions() -> list[Extension]:
    """The one extension module, or none without Cython."""
    try:
        from Cython.Build import cythonize
    except ImportError:
        return []
    from fmu_build.compilers import environment, for_linux
    from fmu_build.core_source import (
        COMPILE_ARGS,
        CORE,
        DIRECTIVES,
        GCC_ARGS,
        LIMITED_API,
        MODULE,
        ZIG_ARGS,
        write_source,
    )

    if LIMITED:
        # Python would import it rather than the binary of the limited API
        (CORE / f"{MODULE}{sysconfig.get_config_var('EXT_SUFFIX')}").unlink(missing_ok=True)
    compiler = for_linux()
    own_args = ZIG_ARGS if compiler.is_zig else GCC_ARGS
    if compiler.is_zig:
        os.environ.update({**environment(), "CC": shlex.join(compiler.command)})
    source = write_source(Path("build") / "core")
    translated = cythonize(
        [Extension(f"{source.parent.name}.{MODULE}", [str(source)])],
        compiler_directives=DIRECTIVES,
        quiet=True,
    )
    return [
        Extension(
            f"rlv_landing.core.{MODULE}",
            translated[0].sources,
            extra_compile_args=[*COMPILE_ARGS, *compiler.flags, *own_args],
            define_macros=[("Py_LIMITED_API", LIMITED_API)] if LIMITED else [],
            py_limited_api=LIMITED,
            optional=True,
        )
    ]


setup(
    ext_modules=extensions(),
    options={"bdist_wheel": {"py_limited_api": "cp311"}} if LIMITED else {},
)
