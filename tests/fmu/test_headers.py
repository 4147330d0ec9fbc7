"""The front compiles with FMI's headers as other packages have them, and its bytes are the same."""

from __future__ import annotations

import re
import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest


def of_fmu_manipulation_toolbox(fmpy_headers: Path, folder: Path) -> Path:
    """FMI 2.0 and 3.0 as that package has them."""
    found = find_spec("fmu_manipulation_toolbox")
    assert found
    assert found.origin
    return Path(found.origin).parent / "resources" / "fmi"


def before_fmi_2_0_1(fmpy_headers: Path, folder: Path) -> Path:
    """FMPy's, with the const callbacks of FMI 2.0, as FMI Library has them."""
    changed = folder / "headers"
    shutil.copytree(fmpy_headers, changed)
    types = changed / "fmi2FunctionTypes.h"
    before = types.read_text()
    struct = re.compile(r"typedef struct \{([^}]*)\} fmi2CallbackFunctions;")
    members = struct.search(before)
    assert members
    const, count = re.subn(r"(?m)^( +)(fmi2\w+ +\w+;)", r"\1const \2", members[1])
    assert count == 5
    types.write_text(before.replace(members[1], const))
    return changed


@pytest.mark.parametrize("headers_of", [of_fmu_manipulation_toolbox, before_fmi_2_0_1])
def test_the_front_has_the_same_bytes_with_other_headers(
    headers_of, binary, header, tmp_path, monkeypatch
):
    from fmu_build.compilers import Compiler

    gcc, fronts = Compiler(("gcc",)), []
    for headers in (binary.HEADERS, headers_of(binary.HEADERS, tmp_path)):
        monkeypatch.setattr(binary, "HEADERS", headers)
        front = tmp_path / "front.so"
        binary.compile_front(front, header, gcc)
        fronts.append(front.read_bytes())
    assert fronts[0] == fronts[1]
