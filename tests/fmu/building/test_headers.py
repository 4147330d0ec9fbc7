"""The front compiles with FMI's headers as others have them, and its bytes are the same."""

from __future__ import annotations

import re
import shutil
from importlib.util import find_spec
from pathlib import Path


def headers_before_fmi_2_0_1(folder: Path) -> Path:
    """Those of fmu-manipulation-toolbox, with the const callbacks of FMI 2.0.

    FMI Library has such headers. No package that is installed here has.
    """
    found = find_spec("fmu_manipulation_toolbox")
    assert found
    assert found.origin
    headers = folder / "headers"
    shutil.copytree(Path(found.origin).parent / "resources" / "fmi", headers)
    types = headers / "fmi2FunctionTypes.h"
    before = types.read_text()
    members = re.search(r"typedef struct \{([^}]*)\} fmi2CallbackFunctions;", before)
    assert members
    const, count = re.subn(r"(?m)^( +)(fmi2\w+ +\w+;)", r"\1const \2", members[1])
    assert count == 5
    types.write_text(before.replace(members[1], const))
    return headers


def test_the_front_has_the_same_bytes_with_older_headers_of_another_package(
    binary, header, tmp_path, monkeypatch
):
    from fmu_build.compilers import Compiler

    gcc, fronts = Compiler(("gcc",)), []
    for headers in (binary.HEADERS, headers_before_fmi_2_0_1(tmp_path)):
        monkeypatch.setattr(binary, "HEADERS", headers)
        front = tmp_path / "front.so"
        binary.compile_front(front, header, gcc)
        fronts.append(front.read_bytes())
    assert fronts[0] == fronts[1]
