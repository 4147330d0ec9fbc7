"""The node's settings: name, default, meaning, bounds, and when each may be changed.

Needs no ROS 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timezone
from itertools import count
from math import inf, isfinite
from pathlib import Path
from typing import Any, Literal

from rlv_landing import Parameters
from rlv_landing.effort import check_duration
from rlv_landing.errors import LandingError
from rlv_landing.presets import DEFAULT_PRESET
from rlv_landing.quantities import MOST_LEGS, Quantity
from rlv_landing.text.values import to_si

from ..fmu.installed import fmu_path
from ..messages.qos import PROFILES
from ..messages.topics import CLOCK, OCCASIONAL, Topic, check_frame_prefix, topics_of

# When a setting may be changed: at the start only, while the node is not active, or at any time.
When = Literal["start", "paused", "always"]


@dataclass(frozen=True)
class Setting:
    """A setting of the node.

    `default` also gives the type. Numbers have the bounds `lo` and `hi`; texts may have `choices`.
    `when` says when it may be changed, `unit` is the SI unit of a number.
    """

    default: Any
    meaning: str
    lo: float = 0.0
    hi: float = 0.0
    when: When = "paused"
    choices: tuple[str, ...] = ()
    unit: str = ""


def downsampling_setting(topic: Topic) -> str:
    """The name of the setting that thins out the messages of `topic`."""
    return f"publish_every.{topic.name.strip('/').replace('/', '_')}"


# with the contacts of as many legs as a vehicle can have
PUBLISHED: tuple[Topic, ...] = (
    *topics_of(tuple(range(1, MOST_LEGS + 1))).sampled,
    *OCCASIONAL,
    CLOCK,
)
SETTINGS: dict[str, Setting] = {
    "fmu": Setting("", "the FMU to step; empty: that of this installation"),
    "preset": Setting(
        "",
        f"preset of parameters; empty: the FMU's own vehicle, else {DEFAULT_PRESET}",
        when="start",
    ),
    "mode": Setting(
        "", "landing mode 2-2, 1-2-1 or space; empty: the parameters' own", when="start"
    ),
    "parameters_file": Setting("", "TOML file of parameters, instead of a preset", when="start"),
    "realtime_factor": Setting(
        1.0,
        "simulated seconds per second of wall time; 1 is real time, 0 as fast as possible",
        0.0,
        1e3,
        "always",
    ),
    "step_size": Setting(
        1e-3,
        "communication step and publishing period [s], a whole number of nanoseconds",
        1e-6,
        1.0,
        unit="s",
    ),
    "stop_time": Setting(1.0, "end of the landing [s]", 0.0, 3600.0, unit="s"),
    "step_count": Setting(1, "steps that one call of ~/step does", 1.0, 1e6, "always"),
    "input_timeout": Setting(
        0.5,
        "wall time [s] without a message after which external_wrench becomes 0 and a velocity of "
        "ground ends; 0: never",
        0.0,
        3600.0,
        "always",
        unit="s",
    ),
    "qos": Setting(
        "telemetry",
        "quality of service of what is published at every step",
        when="start",
        choices=tuple(PROFILES),
    ),
    "clock": Setting(
        default=True,
        meaning="whether /clock is published; of several nodes in one ROS domain one should",
        when="start",
    ),
    "frame_prefix": Setting(
        "",
        'put before the names of all frames but "map", as in "stage_1/"; of several vehicles each '
        "has its own",
        when="start",
    ),
    "autostart": Setting(
        default=True,
        meaning="land at once and end afterwards; else wait for lifecycle transitions, and stay",
        when="start",
    ),
    "record": Setting("", "folder to record to, which must not exist; empty: no recording"),
    "log_root": Setting(
        "",
        "record to a new folder below this one, named by UTC time and mode, if `record` is empty",
    ),
    "log_must_be_complete": Setting(
        default=False,
        meaning="wait for a disk that is slower than the landing, instead of leaving messages out",
    ),
    "wait_for_subscribers": Setting(
        0, "subscriptions on `struts` to wait for before the landing starts", 0.0, 1000.0
    ),
    "wait_timeout": Setting(30.0, "longest wait for them [s]", 0.0, 86400.0, unit="s"),
    "start_delay": Setting(
        0.0,
        "wall time [s] for which the landing waits after that, while /clock is held",
        0.0,
        86400.0,
        unit="s",
    ),
    **{
        downsampling_setting(t): Setting(
            0,
            f"publish one of so many samples on {t.name}; "
            f"0: {'its own rate' if t.period else 'each'}",
            0.0,
            1e9,
        )
        for t in PUBLISHED
    },
}


def settings_of(legs: tuple[int, ...]) -> dict[str, Setting]:
    """The settings of a node whose vehicle has the legs of these numbers."""
    other = set(PUBLISHED).difference(topics_of(legs).sampled, OCCASIONAL, (CLOCK,))
    left_out = {downsampling_setting(topic) for topic in other}
    return {name: setting for name, setting in SETTINGS.items() if name not in left_out}


@dataclass(frozen=True)
class Settings:
    """The checked settings of a landing.

    Times are in s; `step_ns` is the step in ns, from which all stamps are counted. `every`
    gives, by topic, of how many samples one is published.
    """

    fmu: Path
    parameters: Parameters
    preset: str
    realtime_factor: float
    step_size: float
    step_ns: int
    stop_time: float
    record: str
    log_root: str
    log_must_be_complete: bool
    wait_for_subscribers: int
    frame_prefix: str
    wait_timeout: float
    start_delay: float
    every: Mapping[Topic, int] = field(default_factory=dict)

    @property
    def mode(self) -> str:
        """The landing mode."""
        return self.parameters.drop.mode

    @property
    def steps(self) -> int:
        """Number of steps from 0 to the stop time; the samples are one more."""
        return int(self.stop_time / self.step_size * (1.0 + 1e-12) + 1e-9)

    def folder(self) -> Path | None:
        """A log folder that does not exist yet; None: no recording.

        `record` is returned as it is.
        """
        if self.record:
            return Path(self.record)
        if not self.log_root:
            return None
        name = f"{datetime.now(timezone.utc):%Y%m%dT%H%M%SZ}-{self.mode}"
        return unused_folder(Path(self.log_root) / name)


def unused_folder(folder: Path) -> Path:
    """`folder`, or the first of `folder`-2, -3, ... that does not exist."""
    names = (folder if n == 1 else folder.with_name(f"{folder.name}-{n}") for n in count(1))
    return next(f for f in names if not f.exists())


def make_settings(values: Mapping[str, Any], parameters: Parameters, origin: str = "") -> Settings:
    """Makes the settings of a landing.

    Args:
        values: settings by name, each checked.
        parameters: vehicle, ground and drop.
        origin: where they come from, if neither from a preset nor from a file.

    Raises:
        LandingError: two settings contradict each other, or the landing would take longer than 30
            days.
    """
    step_ns = whole_nanoseconds(values["step_size"])
    if values["stop_time"] < values["step_size"]:
        raise LandingError(
            f"stop_time = {values['stop_time']:g} s is below the step of "
            f"{values['step_size']:g} s; land for longer"
        )
    if values["realtime_factor"]:
        check_duration(
            f"stop_time = {values['stop_time']:g} s at realtime_factor = "
            f"{values['realtime_factor']:g}",
            values["stop_time"] / values["realtime_factor"],
            "land faster or shorter",
        )
    own = {t: max(1, round(t.period / values["step_size"])) for t in PUBLISHED}
    return Settings(
        fmu=fmu_path(values["fmu"]),
        parameters=parameters,
        preset=origin or values["parameters_file"] or values["preset"] or DEFAULT_PRESET,
        realtime_factor=values["realtime_factor"],
        step_size=values["step_size"],
        step_ns=step_ns,
        stop_time=values["stop_time"],
        record=values["record"],
        log_root=values["log_root"],
        log_must_be_complete=values["log_must_be_complete"],
        wait_for_subscribers=values["wait_for_subscribers"],
        frame_prefix=values["frame_prefix"],
        wait_timeout=values["wait_timeout"],
        start_delay=values["start_delay"],
        every={t: values[downsampling_setting(t)] or own[t] for t in PUBLISHED},
    )


def check_setting(name: str, value: Any) -> Any:
    """`value` converted to the type of the setting `name`; a number may be a text: "1 ms".

    Raises:
        LandingError: wrong type or unit, not finite, out of bounds, or not one of its choices.
    """
    s = SETTINGS[name]
    if isinstance(s.default, bool):
        if not isinstance(value, bool):
            raise LandingError(f"{name} = {value!r} is neither true nor false ({s.meaning})")
        return value
    if isinstance(s.default, str):
        if not isinstance(value, str):
            raise LandingError(f"{name} = {value!r} is not a text ({s.meaning}); put it in quotes")
        if s.choices and value not in s.choices:
            raise LandingError(
                f"{name} = {value!r} is not one of {', '.join(s.choices)} ({s.meaning})"
            )
        if name == "frame_prefix":
            check_frame_prefix(value)
        return value
    if isinstance(value, str):
        quantity = Quantity(s.unit, s.meaning, name=name, default=s.default)
        value = to_si(quantity, value)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise LandingError(f"{name} = {value!r} is not a number ({s.meaning})")
    if not (isfinite(value) and s.lo <= value <= s.hi):
        raise LandingError(f"{name} = {value:g} is outside [{s.lo:g}, {s.hi:g}] ({s.meaning})")
    if isinstance(s.default, int) and value != int(value):
        raise LandingError(f"{name} = {value:g} is not a whole number ({s.meaning})")
    if name == "step_size":
        whole_nanoseconds(value)
    return type(s.default)(value)


def whole_nanoseconds(step: float) -> int:
    """The step [s] in nanoseconds, in which stamps are counted.

    Raises:
        LandingError: it is not above 0, or no whole number of nanoseconds.
    """
    if not 0.0 < step < inf:
        raise LandingError(f"step_size = {step:g} s must be finite and above 0 s")
    nanoseconds = round(step * 1e9)
    if nanoseconds < 1 or nanoseconds / 1e9 != step:
        raise LandingError(
            f"step_size = {step!r} s is not a whole number of nanoseconds, "
            "in which stamps are counted; round it to 1e-9 s"
        )
    return nanoseconds
