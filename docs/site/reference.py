"""The reference pages of the site, made of the tables that the code itself uses."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator, Sequence

import click

import rlv_landing
from fmu_build.installing.neutral_fronts import describe_slave
from rlv_landing.cli import cli
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import MOST_LEGS, SPACE, TRIPOD, Interface, Quantity, interface_of
from rlv_ros_bridge.messages.tables import table_of
from rlv_ros_bridge.messages.topics import CLOCK, VARIABLES

Row = Sequence[str]
# of the legs, which have all the same, the one that is listed
LEG = "leg[1]."


def reference() -> dict[str, str]:
    """The text of each page, by its name."""
    return {
        "parameters": _parameters(),
        "inputs_outputs": _inputs_and_outputs(),
        "topics": _topics(),
        "fmu_variables": _fmu_variables(),
        "command_line": _command_line(),
        "python": _python(),
    }


def _table(head: Row, rows: Iterable[Row]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    cells = ([cell.replace("|", "\\|") for cell in line] for line in lines)
    return "\n".join(f"| {' | '.join(line)} |" for line in cells) + "\n"


def _parameters() -> str:
    groups: dict[str, list[Row]] = {}
    for q in PARAMETER_QUANTITIES.values():
        value = q.default if isinstance(q.default, str) else f"{q.default:.6g}"
        bounds = ", ".join(q.choices) if q.choices else f"{q.lo:g} to {q.hi:g}"
        row = (f"`{q.name}`", value, q.unit, bounds, q.source, q.meaning)
        groups.setdefault(q.name.partition(".")[0], []).append(row)
    head = ("name", "default", "unit", "bounds", "source", "meaning")
    text = "# Parameters\n\nIn SI units, as `rlv-landing parameters` lists them.\n"
    return text + "".join(f"\n## {name}\n\n{_table(head, rows)}" for name, rows in groups.items())


def _inputs_and_outputs() -> str:
    text = "# Inputs and outputs\n\nNames of a `History`'s columns and of the FMU's variables. "
    text += f"Of the legs the first is listed; `{LEG}` stands for each.\n"
    for title, interface in (
        ("Symmetric landings", interface_of("2-2")),
        ("Landings in space", interface_of(SPACE, MOST_LEGS)),
        ("Landings in space on tripods", interface_of(SPACE, MOST_LEGS, TRIPOD)),
    ):
        text += f"\n## {title}: inputs\n\n{_quantities(interface.inputs)}"
        text += f"\n## {title}: outputs\n\n{_quantities(_of_one_leg(interface))}"
    return text


def _of_one_leg(interface: Interface) -> list[Quantity]:
    return [q for q in interface.outputs if not q.name.startswith("leg[") or LEG in q.name]


def _quantities(quantities: Iterable[Quantity]) -> str:
    rows = ((f"`{q.name}`", q.unit, q.meaning) for q in quantities)
    return _table(("name", "unit", "meaning"), rows)


def _topics() -> str:
    table = table_of(interface_of("2-2"))
    text = (
        "# Topics\n\nBelow the node's namespace, `landing` by default; a name with a slash stands "
    )
    text += "by itself. [The ROS 2 node](../ros.md) says what they are for.\n\n"
    rows = [
        (f"`{t.name}`", t.type_name, f"every {t.period:g} s" if t.period else "each step")
        for t in (*table.topics.sampled, CLOCK)
    ]
    others = [t for t in (*table.topics.recorded, VARIABLES) if t not in table.topics.sampled]
    rows += [
        (f"`{t.name}`", t.type_name, f"every {t.period:g} s" if t.period else "when it changes")
        for t in others
    ]
    text += _table(("topic", "type", "how often"), rows)
    for topic in table.topics.sampled:
        if topic.name.startswith("leg_") and topic.name != "leg_1/contact":
            continue
        fields = [
            (
                ", ".join(f"`{path}`" for path in field.paths),
                ", ".join(f"`{o}`" for o in field.outputs),
            )
            for field in table.fields_of[topic.name]
        ]
        text += f"\n## {topic.name}\n\n{_table(('field', 'of the outputs'), fields)}"
    return text


def _fmu_variables() -> str:
    text = (
        "# Variables of the FMU\n\nOf an FMI 2.0 FMU of symmetric landings, as its description has "
    )
    text += f"them. Of the legs the first is listed; `{LEG}` stands for each.\n"
    kinds: dict[str, list[Row]] = {}
    for variable in describe_slave().iter("ScalarVariable"):
        name = variable.get("name", "")
        if "leg[" in name and LEG not in name:
            continue
        (kind,) = (child for child in variable if child.tag != "annotations")
        row = (f"`{name}`", kind.tag, kind.get("start", ""), variable.get("description", ""))
        kinds.setdefault(variable.get("causality", "local"), []).append(row)
    head = ("name", "type", "start", "meaning")
    return text + "".join(f"\n## {kind}\n\n{_table(head, rows)}" for kind, rows in kinds.items())


def commands(group: click.Group = cli, path: str = "rlv-landing") -> Iterator[tuple[str, str]]:
    """Name and help text of each command, those of groups too."""
    with click.Context(group, info_name=path) as context:
        for name in group.list_commands(context):
            command = group.get_command(context, name)
            assert command is not None
            whole = f"{path} {name}"
            inner = click.Context(command, info_name=whole, terminal_width=100)
            yield whole, command.get_help(inner)
            if isinstance(command, click.Group):
                yield from commands(command, whole)


def _command_line() -> str:
    text = "# Command line\n\nWhat `--help` prints of each command.\n"
    return text + "".join(
        f"\n## {name.removeprefix('rlv-landing ')}\n\n```text\n{shown}\n```\n"
        for name, shown in commands()
    )


def _python() -> str:
    text = (
        "# Python\n\nThe public names of `rlv_landing`, all typed. [In Python](../python.md) shows "
    )
    text += "how they are used.\n\n```{eval-rst}\n"
    for name in sorted(rlv_landing.__all__):
        value = getattr(rlv_landing, name)
        if inspect.isclass(value):
            # what a tuple has is said by its own text
            members = "" if issubclass(value, tuple) else "   :members:\n"
            text += f".. autoclass:: rlv_landing.{name}\n{members}\n"
        elif inspect.isfunction(value):
            text += f".. autofunction:: rlv_landing.{name}\n\n"
    return text + "```\n"
