"""Python's headers for another platform: the installed ones with a `pyconfig.h` of our own.

The installed `pyconfig.h` is that of this machine. Ours has what the limited API's headers ask for,
from what is known of the target. Sizes are checked by the compiler, so a wrong one does not
compile.
"""

from __future__ import annotations

import shutil
import sysconfig
from pathlib import Path

from ..targets import Target

# sizes in all targets [byte], by C's type
SIZES = {
    "short": 2,
    "int": 4,
    "long long": 8,
    "float": 4,
    "double": 8,
    "size_t": 8,
    "void *": 8,
    "_Bool": 1,
}
NAMES = {"void *": "VOID_P", "long long": "LONG_LONG", "_Bool": "_BOOL"}
EVERYWHERE = ("HAVE_LONG_LONG", "HAVE_STDDEF_H", "HAVE_WCHAR_H", "HAVE_SYS_STAT_H", "HAVE_SSIZE_T")
OF_SYSTEM = {
    "linux": ("HAVE_UNISTD_H", "HAVE_SYS_TIME_H"),
    "darwin": ("HAVE_UNISTD_H", "HAVE_SYS_TIME_H"),
    "windows": ("MS_WINDOWS", "MS_WIN64", "HAVE_DECLSPEC_DLL"),
}


def pyconfig(target: Target) -> str:
    """Text of `pyconfig.h` for a target."""
    sizes = {**SIZES, "long": target.long_size, "wchar_t": target.wchar_size}
    lines = [
        "/* Made by fmu_build/cross/python_headers.py, for extensions of the limited API. */",
        "#ifndef Py_PYCONFIG_H",
        "#define Py_PYCONFIG_H",
        "#ifndef Py_LIMITED_API",
        '#error "this pyconfig.h serves the limited API only"',
        "#endif",
        "#include <stddef.h>",
    ]
    for kind, size in sizes.items():
        lines.append(f"#define SIZEOF_{NAMES.get(kind, kind.upper())} {size}")
        lines.append(f'_Static_assert(sizeof({kind}) == {size}, "size of {kind}");')
    defined = (*EVERYWHERE, "WITH_THREAD", "Py_ENABLE_SHARED", *OF_SYSTEM[target.system])
    return "\n".join([*lines, *(f"#define {name} 1" for name in defined), "#endif"]) + "\n"


def write_python_headers(folder: Path, target: Target) -> None:
    """Put Python's headers for a target into `folder`, which is made.

    They are copied, since `Python.h` takes the `pyconfig.h` that stands beside it.
    """
    shutil.copytree(sysconfig.get_paths()["include"], folder)
    (folder / "pyconfig.h").write_text(pyconfig(target))
