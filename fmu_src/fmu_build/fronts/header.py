"""The header `variables.h`, by which the front's sources know of their FMU.

The identity in it (names, GUID, variables) is data of the binary, with a mark before it. So it can
be written into a front that was compiled before, for another FMU.
"""

from __future__ import annotations

import sys
from xml.etree.ElementTree import Element

from rlv_landing.parameters import Parameters
from rlv_landing.quantities import MOST_LEGS, SPACE, TRIPOD

from ..fmi3.arrays import variables
from ..sources import source
from ..wanted import Wanted

FRONT = source("fmu_src/fmu_front")
# those of a landing in space on as many legs as there may be, of the kind that has more
MOST_VARIABLES = len(
    Wanted(
        Parameters().with_values(
            {"drop.mode": SPACE, "vehicle.legs": float(MOST_LEGS), "leg.kind": TRIPOD}
        )
    ).quantities
)
CAUSALITIES = {"parameter": "p", "input": "i", "output": "o"}
# kind, causality, name; and in FMI 3.0 count, stride and name of the array that it is the first of
Row = tuple[str, str, str, int, int, str]
MARK = b"rlv-landing: identity"
# sizes of the identity's texts, a zero at the end of each included; the GUID's also in state.c
MARK_SIZE, GUID_SIZE, TEXT_SIZE, NAME_SIZE = 24, 40, 72, 62


def variables_header(root: Element, module: str) -> str:
    """C header with what the front knows of its FMU.

    The description's variables, log categories and GUID, the slave's script, and the Python text
    that makes the slave.

    Args:
        root: Root of the FMU's modelDescription.xml.
        module: Name of the slave's script, without `.py`.

    Raises:
        SystemExit: The value references are not 0, 1, 2, ... in order, or a name is too long.
    """
    return _header(categories(root), front_identity(root, module))


def neutral_header(root: Element) -> str:
    """The header of a front that gets its identity later; the same for all FMUs that it fits."""
    return _header(categories(root), _identity("", "", "", 0, []))


def front_identity(root: Element, module: str) -> bytes:
    """The identity of an FMU's front, from the mark on, as it stands in the binary.

    Args:
        root: Root of the FMU's modelDescription.xml.
        module: Name of the slave's script, without `.py`.

    Raises:
        SystemExit: The value references are not 0, 1, 2, ... in order, or a name is too long.
    """
    rows = []
    scalars = _variables(root)
    first = {v.reference: v for v in variables([v.attrib["name"] for v in scalars])}
    for i, variable in enumerate(scalars):
        name = variable.attrib["name"]
        if int(variable.attrib["valueReference"]) != i:
            raise SystemExit(
                f"error: value reference of {name} is not {i}; the front needs them in order"
            )
        causality = CAUSALITIES.get(variable.attrib["causality"], "-")
        whole = first.get(i)
        array = (len(whole.elements), whole.stride, whole.name) if whole else (0, 0, "")
        rows.append((variable[0].tag[0], causality, name, *array))
    return _identity(
        root.attrib["guid"], root.attrib["modelName"], module, sys.version_info.minor, rows
    )


def categories(root: Element) -> list[str]:
    """The names of the description's log categories, in order."""
    return [c.attrib["name"] for c in root.findall("LogCategories/Category")]


def _variables(root: Element) -> list[Element]:
    return root.findall("ModelVariables/ScalarVariable")


def _identity(guid: str, model: str, module: str, minor: int, rows: list[Row]) -> bytes:
    found = MARK.ljust(MARK_SIZE, b"\0") + _text(guid, GUID_SIZE)
    found += _text(model, TEXT_SIZE) + _text(module, TEXT_SIZE) + bytes([minor])
    found += len(rows).to_bytes(2, "little")
    for kind, causality, name, count, stride, whole in rows:
        found += f"{kind}{causality}".encode() + bytes([count, stride])
        found += _text(name, NAME_SIZE) + _text(whole, NAME_SIZE)
    return found + bytes((MOST_VARIABLES - len(rows)) * (4 + 2 * NAME_SIZE))


def _text(text: str, size: int) -> bytes:
    encoded = text.encode()
    if len(encoded) >= size:
        raise SystemExit(
            f"error: {text!r} has {len(encoded)} bytes; the FMU's front takes {size - 1}"
        )
    return encoded.ljust(size, b"\0")


def _header(log_categories: list[str], identity: bytes) -> str:
    lines = [
        "/* Made by fmu_build/fronts/header.py from modelDescription.xml. */",
        "/* In FMI 3.0 it is the first of `count` elements of `whole`, `stride` apart. */",
        "struct variable {",
        "    char kind, causality;",
        "    unsigned char count, stride; /* count 0: no variable of its own */",
        f"    char name[{NAME_SIZE}], whole[{NAME_SIZE}];",
        "};",
        f"enum {{ MOST_VARIABLES = {MOST_VARIABLES} }};",
        "struct identity {",
        f"    char mark[{MARK_SIZE}], guid[{GUID_SIZE}];",
        f"    char model[{TEXT_SIZE}], module[{TEXT_SIZE}], python_minor;",
        "    unsigned char count[2]; /* of variables, the lower byte first */",
        "    struct variable variables[MOST_VARIABLES];",
        "};",
        "extern const struct identity IDENTITY;",
        "#define VARIABLES IDENTITY.variables",
        "#define VARIABLE_COUNT ((uint32_t)(IDENTITY.count[0] + 256 * IDENTITY.count[1]))",
        "#define GUID IDENTITY.guid",
        "#define MODEL_NAME IDENTITY.model",
        "#define SLAVE_MODULE IDENTITY.module",
        "#define BUILD_PYTHON_MINOR IDENTITY.python_minor",
        "static const char *const CATEGORIES[] __attribute__((unused)) = {",
        *(f"    {quoted(name)}," for name in log_categories),
        "};",
        "#define CREATE_SLAVE \\",
        *(
            f"    {quoted(line + chr(10))} \\"
            for line in (FRONT / "create_slave.py").read_text().splitlines()
        ),
        '    ""',
        "#define IDENTITY_VALUES \\",
        *(f"    {line} \\" for line in _values(identity)),
        "    }",
    ]
    return "\n".join(lines) + "\n"


def _values(identity: bytes) -> list[str]:
    """C's values of the members of a `struct identity`, without the last brace."""
    texts, at = [], 0
    for size in (MARK_SIZE, GUID_SIZE, TEXT_SIZE, TEXT_SIZE):
        texts.append(quoted(identity[at : at + size].rstrip(b"\0").decode()) + ",")
        at += size
    lines = [*texts, f"{identity[at]},", f"{{{identity[at + 1]}, {identity[at + 2]}}},", "{"]
    count = int.from_bytes(identity[at + 1 : at + 3], "little")
    size, at = 4 + 2 * NAME_SIZE, at + 3
    # of an array without variables C would want an element
    for row in range(at, at + max(count, 1) * size, size):
        kind, causality = (chr(byte or ord("-")) for byte in identity[row : row + 2])
        count, stride = identity[row + 2 : row + 4]
        name, whole = (
            quoted(identity[start : start + NAME_SIZE].rstrip(b"\0").decode())
            for start in (row + 4, row + 4 + NAME_SIZE)
        )
        lines.append(f"{{'{kind}', '{causality}', {count}, {stride}, {name}, {whole}}},")
    return lines


def quoted(text: str) -> str:
    """`text` as a C string."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
