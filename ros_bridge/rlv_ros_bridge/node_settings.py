"""The node's ROS parameters: declared with description, unit and range, checked, and made into settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timezone
from itertools import count
from math import inf, isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rlv_landing import Parameters
from rlv_landing.choices import choose_parameters
from rlv_landing.errors import LandingError, unknown
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.presets import DEFAULT_PRESET

if TYPE_CHECKING:
    from rclpy.node import Node

# name -> (default, meaning, lower bound, upper bound)
SETTINGS: dict[str, tuple[Any, str, float, float]] = {
    "fmu": ("build/RlvLanding.fmu", "the FMU to step", 0.0, 0.0),
    "preset": ("", f"preset of parameters; empty: {DEFAULT_PRESET}", 0.0, 0.0),
    "mode": ("", "landing mode 2-2 or 1-2-1; empty: the parameters' own", 0.0, 0.0),
    "parameters_file": ("", "TOML file of parameters, instead of a preset", 0.0, 0.0),
    "realtime_factor": (1.0, "simulated seconds per second of wall time; 1 is real time, 0 as fast as possible", 0.0, 1e3),
    "step_size": (1e-3, "communication step and publishing period [s], a whole number of nanoseconds", 1e-6, 1.0),
    "stop_time": (1.0, "end of the landing [s]", 0.0, 3600.0),
    "record": ("", "folder to record to, which must not exist; empty: no recording", 0.0, 0.0),
    "log_root": ("", "record to a new folder below this one, named by UTC time and mode, where `record` is empty", 0.0, 0.0),
    "wait_for_subscribers": (0, "subscriptions on `struts` to wait for before the landing starts", 0.0, 1000.0),
    "wait_timeout": (30.0, "longest wait for them [s]", 0.0, 86400.0),
}
# What rclpy declares by itself for every node.
BUILT_IN = ("use_sim_time", "start_type_description_service")
# The landing mode is the setting `mode`, which also chooses the values that belong to one mode only.
MODE = "drop.mode"


@dataclass(frozen=True)
class Settings:
    """What the node does. Times in s; `step_ns` is the step in nanoseconds, from which all stamps are counted."""

    fmu: Path
    parameters: Parameters
    preset: str
    realtime_factor: float
    step_size: float
    step_ns: int
    stop_time: float
    record: Path | None
    wait_for_subscribers: int
    wait_timeout: float

    @property
    def mode(self) -> str:
        """The landing mode."""
        return self.parameters.drop.mode

    @property
    def steps(self) -> int:
        """Steps from 0 to the stop time; one more sample than steps is published."""
        return int(self.stop_time / self.step_size * (1.0 + 1e-12) + 1e-9)


def read_settings(node: Node) -> Settings:
    """Declares the node's parameters and reads them. Raises LandingError: unknown name, wrong type, out of bounds, no such preset."""
    # rclpy leaves overrides of undeclared parameters aside without a word; a misspelt name must not go unnoticed.
    given: dict[str, Any] = {name: p.value for name, p in node._parameter_overrides.items()}
    for name in given:
        if name not in (*SETTINGS, *PARAMETER_QUANTITIES, *BUILT_IN) and not name.startswith("qos_overrides."):
            raise unknown("ROS parameter", name, (*SETTINGS, *PARAMETER_QUANTITIES))
    if MODE in given:
        given.setdefault("mode", given.pop(MODE))
    values = {name: check_setting(name, given.get(name, SETTINGS[name][0])) for name in SETTINGS}
    parameters = choose_parameters(
        values["preset"] or None,
        values["parameters_file"] or None,
        values["mode"] or None,
        {n: v for n, v in given.items() if n in PARAMETER_QUANTITIES},
    )
    preset = values["parameters_file"] or values["preset"] or DEFAULT_PRESET
    step_ns = whole_nanoseconds(values["step_size"])
    if values["stop_time"] < values["step_size"]:
        raise LandingError(f"stop_time = {values['stop_time']:g} s is below the step of {values['step_size']:g} s; land for longer")
    _declare(node, {**values, "mode": parameters.drop.mode, "preset": "" if values["parameters_file"] else preset}, parameters)
    return Settings(
        fmu=Path(values["fmu"]),
        parameters=parameters,
        preset=preset,
        realtime_factor=values["realtime_factor"],
        step_size=values["step_size"],
        step_ns=step_ns,
        stop_time=values["stop_time"],
        record=_folder(values["record"], values["log_root"], parameters.drop.mode),
        wait_for_subscribers=values["wait_for_subscribers"],
        wait_timeout=values["wait_timeout"],
    )


def _folder(record: str, root: str, mode: str) -> Path | None:
    if record or not root:
        return Path(record) if record else None
    name = f"{datetime.now(timezone.utc):%Y%m%dT%H%M%SZ}-{mode}"
    # Two runs may start in one second.
    names = (name if n == 1 else f"{name}-{n}" for n in count(1))
    return next(folder for folder in (Path(root) / n for n in names) if not folder.exists())


def check_setting(name: str, value: Any) -> Any:
    """`value` as the setting `name` takes it. Raises LandingError: wrong type, not finite, out of bounds."""
    default, meaning, lo, hi = SETTINGS[name]
    if isinstance(default, str):
        if not isinstance(value, str):
            raise LandingError(f"{name} = {value!r} is not a text ({meaning}); put it in quotes")
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise LandingError(f"{name} = {value!r} is not a number ({meaning})")
    if not (isfinite(value) and lo <= value <= hi):
        raise LandingError(f"{name} = {value:g} is outside [{lo:g}, {hi:g}] ({meaning})")
    if isinstance(default, int) and value != int(value):
        raise LandingError(f"{name} = {value:g} is not a whole number ({meaning})")
    return type(default)(value)


def whole_nanoseconds(step: float) -> int:
    """The step in nanoseconds. Raises LandingError unless it is above 0 and a whole number of them: stamps are counted."""
    if not 0.0 < step < inf:
        raise LandingError(f"step_size = {step:g} s must be finite and above 0 s")
    nanoseconds = round(step * 1e9)
    if nanoseconds < 1 or nanoseconds / 1e9 != step:
        raise LandingError(f"step_size = {step!r} s is not a whole number of nanoseconds, which stamps are counted in; round it to 1e-9 s")
    return nanoseconds


def _declare(node: Node, values: Mapping[str, Any], parameters: Parameters) -> None:
    from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor

    for name, value in values.items():
        default, meaning, lo, hi = SETTINGS[name]
        descriptor = ParameterDescriptor(description=meaning, read_only=True)
        if isinstance(default, float):
            descriptor.floating_point_range = [FloatingPointRange(from_value=lo, to_value=hi, step=0.0)]
        elif isinstance(default, int):
            descriptor.integer_range = [IntegerRange(from_value=int(lo), to_value=int(hi), step=1)]
        node.declare_parameter(name, value, descriptor, ignore_override=True)
    for name, value in parameters.items():
        q = PARAMETER_QUANTITIES[name]
        if name == MODE:
            continue
        descriptor = ParameterDescriptor(description=f"{q.meaning} [{q.unit}]" if q.unit else q.meaning, read_only=True)
        if q.choices:
            descriptor.additional_constraints = f"one of {', '.join(q.choices)}"
        else:
            descriptor.floating_point_range = [FloatingPointRange(from_value=q.lo, to_value=q.hi, step=0.0)]
        node.declare_parameter(name, value, descriptor, ignore_override=True)
