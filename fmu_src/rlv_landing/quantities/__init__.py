"""The table of quantities: the model's inputs and outputs with unit, meaning, bounds and source.

Everything that names a quantity is made from this table or from the annotated parameters in
`parameters`: the FMU's variables, the TOML reader, `--set`, the columns of a history and the
reference pages.
"""

from .inputs import INPUT_NAMES, INPUT_QUANTITIES, INPUTS_BY_NAME
from .interface import Interface, interface_of, widest_interfaces
from .legs import (
    LEAST_LEGS,
    LEGS,
    MIRRORED,
    MODES,
    MOST_LEGS,
    RADIAL,
    SPACE,
    TRIPOD,
    LegGroup,
    azimuth,
    groups_of,
    touchdown_groups,
)
from .outputs import (
    BODY_QUANTITIES,
    ENERGY_QUANTITIES,
    LEG_QUANTITIES,
    OUTPUT_NAMES,
    OUTPUT_QUANTITIES,
    OUTPUTS_BY_NAME,
    SHARED_QUANTITIES,
    STATUS_QUANTITIES,
)
from .peaks import PEAK_QUANTITIES, PEAKS, Peak
from .quantity import BASE_UNITS, DISPLAY_UNITS, NOMINALS, Quantity, flat_name, shown, whole_name
from .space import SPACE_INPUTS, leg_quantities_in_space
from .statistics import STATISTIC_QUANTITIES

__all__ = [
    "BASE_UNITS",
    "BODY_QUANTITIES",
    "DISPLAY_UNITS",
    "ENERGY_QUANTITIES",
    "INPUTS_BY_NAME",
    "INPUT_NAMES",
    "INPUT_QUANTITIES",
    "LEAST_LEGS",
    "LEGS",
    "LEG_QUANTITIES",
    "MIRRORED",
    "MODES",
    "MOST_LEGS",
    "NOMINALS",
    "OUTPUTS_BY_NAME",
    "OUTPUT_NAMES",
    "OUTPUT_QUANTITIES",
    "PEAKS",
    "PEAK_QUANTITIES",
    "RADIAL",
    "SHARED_QUANTITIES",
    "SPACE",
    "SPACE_INPUTS",
    "STATISTIC_QUANTITIES",
    "STATUS_QUANTITIES",
    "TRIPOD",
    "Interface",
    "LegGroup",
    "Peak",
    "Quantity",
    "azimuth",
    "flat_name",
    "groups_of",
    "interface_of",
    "leg_quantities_in_space",
    "shown",
    "touchdown_groups",
    "whole_name",
    "widest_interfaces",
]
