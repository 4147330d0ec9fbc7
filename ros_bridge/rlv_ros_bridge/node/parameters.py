"""The node's ROS parameters: one for each setting and each quantity of the model.

Each has a description, a unit and a range, and is checked when it is set. A quantity may be set to
a text with a unit, such as "-2 deg".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from rlv_landing import Parameters
from rlv_landing.choices import choose_parameters
from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import PARAMETER_QUANTITIES, parameters_of
from rlv_landing.text.listed import parse_parameter

from ..fmu.description import own_vehicle
from ..fmu.installed import fmu_path
from ..ros.rclpy_internals import parameter_overrides
from .settings import (
    SETTINGS,
    Setting,
    Settings,
    check_setting,
    make_settings,
    settings_of,
)

# The parameters that rclpy declares for every node.
BUILT_IN = ("use_sim_time", "start_type_description_service")
QOS_OVERRIDES = "qos_overrides."
# The setting `mode` stands for this quantity: it also chooses the values that depend on the mode.
MODE = "drop.mode"
# with these the outputs change, and with them the topics
AT_START = (MODE, "vehicle.legs", "leg.kind")


class NodeParameters:
    """Declares the parameters of `node`, and keeps their values.

    Args:
        node: the landing node.
        is_running: whether the node lands at present.
        on_change: called with the changed values by name.
        shared: names that a parameter file gives to every node. Those that are not this node's are
            ignored.

    Raises:
        LandingError: a bad value on the command line or in a parameter file: unknown name, wrong
            type, out of bounds, no such preset.
    """

    def __init__(
        self,
        node: Node,
        is_running: Callable[[], bool],
        on_change: Callable[[dict[str, Any]], None],
        shared: frozenset[str] = frozenset(),
    ) -> None:
        given = parameter_overrides(node)
        for name in given:
            if (
                name not in (*SETTINGS, *BUILT_IN)
                and name not in PARAMETER_QUANTITIES
                and not name.startswith(QOS_OVERRIDES)
                and name not in shared
            ):
                raise unknown("ROS parameter", name, (*SETTINGS, *PARAMETER_QUANTITIES))
        if MODE in given:
            given.setdefault("mode", given.pop(MODE))
        self._values = {
            name: check_setting(name, given.get(name, s.default)) for name, s in SETTINGS.items()
        }
        changes = {
            n: parse_parameter(PARAMETER_QUANTITIES[n], v)
            for n, v in given.items()
            if n in PARAMETER_QUANTITIES
        }
        self.parameters, self._origin = _vehicle(self._values, changes)
        self._values["mode"] = self.parameters.drop.mode
        legs = self.parameters.interface.legs
        own = settings_of(legs)
        for name in given:
            if name in SETTINGS and name not in own and name not in shared:
                raise unknown("ROS parameter", name, own)
        self.settings()
        self._is_running = is_running
        self._on_change = on_change
        self._refusal = ""
        self._declare(node, own)
        node.add_pre_set_parameters_callback(self._pre_set)
        node.add_on_set_parameters_callback(self._on_set)
        node.add_post_set_parameters_callback(self._post_set)

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def settings(self) -> Settings:
        """The settings with their current values.

        Raises:
            LandingError: two settings contradict each other.
        """
        return make_settings(self._values, self.parameters, self._origin)

    def _declare(self, node: Node, own: Mapping[str, Setting]) -> None:
        for name, s in own.items():
            descriptor = ParameterDescriptor(description=s.meaning, read_only=s.when == "start")
            if isinstance(s.default, float):
                descriptor.floating_point_range = [
                    FloatingPointRange(from_value=s.lo, to_value=s.hi, step=0.0)
                ]
            elif isinstance(s.default, int) and not isinstance(s.default, bool):
                descriptor.integer_range = [
                    IntegerRange(from_value=int(s.lo), to_value=int(s.hi), step=1)
                ]
            descriptor.additional_constraints = _constraints(
                s.choices, "" if s.when == "always" else s.when
            )
            node.declare_parameter(name, self._values[name], descriptor, ignore_override=True)
        for name, q in parameters_of(self.parameters.drop.mode).items():
            value, start = self.parameters[name], name in AT_START
            descriptor = ParameterDescriptor(
                description=f"{q.meaning} [{q.unit}]" if q.unit else q.meaning,
                read_only=start,
            )
            descriptor.additional_constraints = _constraints(
                q.choices, "start" if start else "paused"
            )
            if q.kind != "string":
                descriptor.floating_point_range = [
                    FloatingPointRange(from_value=q.lo, to_value=q.hi, step=0.0)
                ]
            node.declare_parameter(name, value, descriptor, ignore_override=True)

    def _pre_set(self, parameters: list[Parameter[Any]]) -> list[Parameter[Any]]:
        """Converts whole numbers to floats where the parameter is a float.

        A bad value is replaced by the current one, and its error kept for `_on_set`: rclpy's own
        checks come first, and their messages say less.
        """
        self._refusal = ""
        converted = []
        for p in parameters:
            known = p.name in SETTINGS or p.name in PARAMETER_QUANTITIES
            if known:
                try:
                    value = self._checked(p)
                except LandingError as e:
                    self._refusal = self._refusal or str(e)
                    value = self._current(p.name)
                p = Parameter(p.name, value=value)
            converted.append(p)
        return converted

    def _checked(self, p: Parameter[Any]) -> Any:
        if p.type_ == Parameter.Type.NOT_SET:
            raise LandingError(f"{p.name} cannot be deleted; set it to a value")
        when = (
            SETTINGS[p.name].when
            if p.name in SETTINGS
            else "start"
            if p.name in AT_START
            else "paused"
        )
        if when == "start":
            raise LandingError(f"{p.name} can only be given when the node is started")
        if when == "paused" and self._is_running():
            raise LandingError(
                f"{p.name} cannot be changed while the node lands; "
                "deactivate it first, and ~/reset it afterwards"
            )
        return (
            check_setting(p.name, p.value)
            if p.name in SETTINGS
            else parse_parameter(PARAMETER_QUANTITIES[p.name], p.value)
        )

    def _current(self, name: str) -> Any:
        return self._values[name] if name in SETTINGS else self.parameters[name]

    def _on_set(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        try:
            if self._refusal:
                raise LandingError(self._refusal)
            if _own(parameters):
                self._merged(parameters)
        except LandingError as e:
            return SetParametersResult(successful=False, reason=str(e))
        return SetParametersResult(successful=True)

    def _merged(self, parameters: list[Parameter[Any]]) -> tuple[dict[str, Any], Parameters]:
        """All values with `parameters` among them.

        Raises:
            LandingError: they contradict each other.
        """
        values = {**self._values, **{p.name: p.value for p in parameters if p.name in SETTINGS}}
        physical = self.parameters.with_values(
            {p.name: p.value for p in parameters if p.name in PARAMETER_QUANTITIES}
        )
        make_settings(values, physical, self._origin)
        return values, physical

    def _post_set(self, parameters: list[Parameter[Any]]) -> None:
        own = _own(parameters)
        if own:
            self._values, self.parameters = self._merged(own)
            self._on_change({p.name: p.value for p in own})


def unused_overrides(node: Node, shared: frozenset[str]) -> list[str]:
    """Which of the `shared` names are not parameters of `node`, which has all its topics.

    Args:
        node: the node.
        shared: names that a parameter file gives to every node.

    Raises:
        LandingError: an override that is not shared is of the quality of service of no topic.
    """
    unused = [name for name in parameter_overrides(node) if not node.has_parameter(name)]
    for name in unused:
        if name.startswith(QOS_OVERRIDES) and name not in shared:
            known = list(node.get_parameters_by_prefix(QOS_OVERRIDES.strip(".")))
            raise unknown("ROS parameter", name, [f"{QOS_OVERRIDES}{n}" for n in known])
    return [name for name in unused if name in shared]


def _own(parameters: Sequence[Parameter[Any]]) -> list[Parameter[Any]]:
    """The settings and quantities among `parameters`; others are rclpy's."""
    return [p for p in parameters if p.name in SETTINGS or p.name in PARAMETER_QUANTITIES]


def _vehicle(values: Mapping[str, Any], changes: Mapping[str, Any]) -> tuple[Parameters, str]:
    """The vehicle, and where it comes from; empty for a preset or a file.

    It is that of the preset or file; without one, of an FMU that was built for its own vehicle.

    Args:
        values: The settings.
        changes: Quantities that are given one by one, by name [SI].

    Raises:
        LandingError: There is no such preset, file or mode.
    """
    preset, file, mode = (values[n] or None for n in ("preset", "parameters_file", "mode"))
    fmu = fmu_path(values["fmu"])
    own = own_vehicle(fmu) if preset is None and file is None else None
    if own is None:
        return choose_parameters(preset, file, mode, changes), ""
    return own.for_mode(mode or own.drop.mode).with_values(changes), str(fmu)


def _constraints(choices: tuple[str, ...], when: str) -> str:
    parts = [f"one of {', '.join(choices)}"] if choices else []
    parts += {
        "start": ["given at the start only"],
        "paused": ["not while the node lands; acts from the next ~/reset or configure on"],
    }.get(when, [])
    return "; ".join(parts)
