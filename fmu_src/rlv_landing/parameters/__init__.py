"""The vehicle, its ground and its drop: annotated values, checked on construction.

The defaults are the preset `yue2022-figures`. The source of each separates the paper's own values
from identified ones. Lengths down from the CG are positive depths, as in the paper's Table 1.
"""

from .drop import Drop, Integration
from .ground import Ground
from .one_leg import groups_of_a_leg, leg_of
from .operators import operators_from_table
from .parameters import Parameters
from .sea import Sea
from .surroundings import terrain_from_table, terrain_of
from .table import GROUPS, PARAMETER_QUANTITIES, ParameterTable, check_value, parameters_of
from .vehicle import AuxiliaryStrut, MainStrut, Vehicle

__all__ = [
    "GROUPS",
    "PARAMETER_QUANTITIES",
    "AuxiliaryStrut",
    "Drop",
    "Ground",
    "Integration",
    "MainStrut",
    "ParameterTable",
    "Parameters",
    "Sea",
    "Vehicle",
    "check_value",
    "groups_of_a_leg",
    "leg_of",
    "operators_from_table",
    "parameters_of",
    "terrain_from_table",
    "terrain_of",
]
