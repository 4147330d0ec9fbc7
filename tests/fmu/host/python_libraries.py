"""The Python libraries of this machine, for hosts that have no Python."""

from __future__ import annotations

import ctypes.util
import os
import sysconfig
from pathlib import Path

# a host's whole environment: no variable that says where Python is
BARE = {name: os.environ[name] for name in ("HOME",) if name in os.environ} | {
    "PATH": "/usr/bin:/bin"
}


def python_libraries() -> list[str]:
    """Python libraries, 3.10 to 3.13, of this machine.

    That of the running Python, those beside it, and those that the loader finds.
    """
    found = {}
    here = Path(sysconfig.get_config_var("LIBDIR") or "/usr/lib")
    for minor in range(10, 14):
        name = f"libpython3.{minor}.so.1.0"
        places = [here / name, *sorted(here.parent.parent.glob(f"3.{minor}*/lib/{name}"))]
        path = next((str(p) for p in places if p.is_file()), "") or (
            ctypes.util.find_library(f"python3.{minor}") and name
        )
        if path:
            found[minor] = path
    return list(found.values())
