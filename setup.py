"""Compiles the core if Cython and a C compiler are installed: Zig's, else the usual one.

Without them the package runs the same files uncompiled, slowly. From Python 3.11 on the binary uses
the limited API, so one serves all later versions, in the FMU as well. The limited API of 3.10 has
no buffers, so a binary compiled there serves 3.10 alone.

A wheel also carries what the FMU's build needs: the sources of slave and front, and the compiled
front, where FMPy, which has FMI's headers, pythonfmu and a C compiler are installed. An isolated
build has the first two by pyproject.toml. It has the examples, and what ROS 2 finds in `share`.
"""

import os
import shlex
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist

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
            # linked, so that its functions are the newest, without the wrappers of old ones
            libraries=[] if sys.platform == "win32" else ["m"],
            py_limited_api=LIMITED,
            optional=True,
        )
    ]


class BuildWithFmuSources(build_py):
    """Builds the packages, and carries into `fmu_build` what stands outside of them."""

    def run(self) -> None:
        """Build; an editable install finds the files where they are."""
        super().run()
        if not self.editable_mode:
            from fmu_build.sources import carry, carry_examples

            package = Path(self.build_lib) / "fmu_build"
            carry(package)
            carry_examples(Path(self.build_lib) / "rlv_landing" / "examples")
            try:
                from fmu_build.installing.neutral_fronts import compile_neutral

                made = ", ".join(compile_neutral(package / "fronts" / "compiled"))
            except (ImportError, SystemExit) as e:
                made = f"none: `rlv-landing fmu build` will need a C compiler ({e})"
            print(f"compiled fronts of the FMU: {made}")


class DatedSources(sdist):
    """The sources with their date, which git tells in a checkout alone."""

    def make_release_tree(self, base_dir: str, files: list[str]) -> None:
        """Copy the files, and write the date beside them."""
        from fmu_build.sources import DATE, source_date

        super().make_release_tree(base_dir, files)
        (Path(base_dir) / DATE).write_text(f"{int(source_date().timestamp())}\n")


def ros_files() -> list[tuple[str, list[str]]]:
    """What ROS 2 finds below the environment: package, launch file, layouts, and the node."""
    bridge = Path("ros_bridge")
    name = "rlv_ros_bridge"
    share = f"share/{name}"
    return [
        ("share/ament_index/resource_index/packages", [str(bridge / "resource" / name)]),
        (share, [str(bridge / "package.xml")]),
        *(
            (f"{share}/{part}", sorted(map(str, (bridge / part).glob(pattern))))
            for part, pattern in (("launch", "*.launch.py"), ("config", "*.*"))
        ),
        (f"lib/{name}", [str(bridge / "lib" / "landing_node")]),
    ]


setup(
    cmdclass={"build_py": BuildWithFmuSources, "sdist": DatedSources},
    data_files=ros_files(),
    ext_modules=extensions(),
    options={"bdist_wheel": {"py_limited_api": "cp311"}} if LIMITED else {},
)
