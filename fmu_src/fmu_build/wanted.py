"""The FMU that a user wants: vehicle, name, names of variables."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from math import ceil

from rlv_landing import MODEL_NAME
from rlv_landing.errors import LandingError
from rlv_landing.parameters import Parameters, parameters_of
from rlv_landing.quantities import STATISTIC_QUANTITIES, Interface, Quantity

from .targets import OWN, TARGETS, Target, own_machine

LONGEST_NAME = 64
FMI_VERSIONS = ("2", "3")
# words of C, which are no identifiers, and names that Windows gives no file
NO_NAMES = re.compile(
    r"auto|break|case|char|const|continue|default|do|double|else|enum|extern|float|for|goto|if"
    r"|inline|int|long|register|restrict|return|short|signed|sizeof|static|struct|switch|typedef"
    r"|union|unsigned|void|volatile|while|(?i:con|prn|aux|nul|com\d|lpt\d)"
)
COUNTS = {3: "three", 4: "four", 5: "five", 6: "six", 7: "seven", 8: "eight"}
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
    def table(self) -> dict[str, Quantity]:
        """Its parameters by name."""
        return parameters_of(self.parameters.drop.mode)

    @property
    def interface(self) -> Interface:
        """Its inputs and outputs."""
        return self.parameters.interface

    @property
    def quantities(self) -> dict[str, Quantity]:
        """What its variables are in FMI 2.0, by name, in the order of their value references."""
        i = self.interface
        calculated = (*i.outputs, *STATISTIC_QUANTITIES, *i.peak_quantities)
        return {**self.table, **{q.name: q for q in (*i.inputs, *calculated)}}

    @property
    def values(self) -> dict[str, float | str]:
        """The parameters by name; empty where all are the defaults."""
        own = {name: self.parameters[name] for name in self.table}
        is_default = all(own[name] == q.default for name, q in self.table.items())
        return {} if is_default and not self.interface.in_space else own

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
        legs = int(p.vehicle.legs)
        how = "in space" if self.interface.in_space else p.drop.mode
        speed = abs(p.drop.vertical_velocity)
        return f"{p.whole_mass:.4g} kg on {COUNTS[legs]} legs, {how} at {speed:.3g} m/s"
