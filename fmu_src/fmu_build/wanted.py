"""The FMU that a user wants: vehicle, name, names of variables."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import ceil

from rlv_landing import MODEL_NAME
from rlv_landing.errors import LandingError
from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters

from .targets import OWN, TARGETS, Target, own_machine

LONGEST_NAME = 64
FMI_VERSIONS = ("2", "3")
# words of C, which are no identifiers, and names that Windows gives no file
NO_NAMES = re.compile(
    r"auto|break|case|char|const|continue|default|do|double|else|enum|extern|float|for|goto|if"
    r"|inline|int|long|register|restrict|return|short|signed|sizeof|static|struct|switch|typedef"
    r"|union|unsigned|void|volatile|while|(?i:con|prn|aux|nul|com\d|lpt\d)"
)
# the default experiment's end [s], and how long after the first contact it is at least
END, AFTER_CONTACT = 1.0, 0.5


@dataclass(frozen=True)
class Wanted:
    """The FMU that is wanted.

    Attributes:
        parameters: The vehicle, its ground and its drop: the start values.
        source: The name of where they come from, for the FMU's description.
        name: The model's name, also that of its binary.
        flat_names: Whether the variables' names have neither dots nor brackets.
        fmi: The version of FMI.
        pure: Whether to leave the compiled core out.
        platforms: Which platforms it is for, this machine's (`own`) or all.

    Raises:
        LandingError: `name` is no identifier of C or no name of a file, or FMI's version is not to
            be had.
    """

    parameters: Parameters = field(default_factory=Parameters)
    source: str = ""
    name: str = MODEL_NAME
    flat_names: bool = False
    fmi: str = "2"
    pure: bool = False
    platforms: str = OWN

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", self.name, re.ASCII):
            raise LandingError(
                f"model name {self.name!r} must be letters, digits and underscores, no digit "
                "first: it names the FMU's binary; for example F9Landing"
            )
        if NO_NAMES.fullmatch(self.name):
            raise LandingError(
                f"model name {self.name!r} is a word of C or a device of Windows, after which no "
                "binary can be called; add to it, for example a version"
            )
        if len(self.name) > LONGEST_NAME:
            raise LandingError(
                f"model name {self.name!r} has {len(self.name)} characters; at most "
                f"{LONGEST_NAME} fit"
            )
        if self.fmi not in FMI_VERSIONS:
            raise LandingError(
                f"FMI {self.fmi} FMUs cannot be built; the versions are {', '.join(FMI_VERSIONS)}"
            )

    @property
    def values(self) -> dict[str, float | str]:
        """The parameters by name; empty where all are the defaults."""
        own = dict(self.parameters.items())
        is_default = all(own[name] == q.default for name, q in PARAMETER_QUANTITIES.items())
        return {} if is_default else own

    @property
    def other_targets(self) -> list[Target]:
        """The platforms besides this machine's that it has a compiled core for."""
        if self.pure or self.platforms == OWN:
            return []
        return [target for target in TARGETS.values() if target.name != own_machine()]

    @property
    def stop_time(self) -> float:
        """The end of the default experiment [s]: after the touchdown, in whole seconds."""
        return max(END, ceil(self.parameters.drop.contact_time + AFTER_CONTACT))

    @property
    def vehicle(self) -> str:
        """The vehicle and its drop, in words."""
        p = self.parameters
        mass = p.vehicle.mass + 4.0 * p.vehicle.footpad_mass
        return (
            f"{mass:.4g} kg on four legs, {p.drop.mode} at {abs(p.drop.vertical_velocity):.3g} m/s"
        )
