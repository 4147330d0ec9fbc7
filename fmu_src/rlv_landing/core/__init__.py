"""The kernels: plain Python on `math` alone, compiled where a compiler was there, the same digits
either way.

The classes come from the compiled module if there is one for this Python, else from the plain
files. RLV_LANDING_PURE=1 in the environment asks for the plain files. Records and laws' names are
those of the plain files always.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from .ground.kinds import FRICTION_LAWS
from .records import (
    Accounts,
    BodyModel,
    BodyState,
    Fault,
    Inputs,
    LegModel,
    LegPlace,
    LegState,
    Phase,
)
from .struts.kinds import AUXILIARY_STRUTS, MAIN_STRUTS

COMPILED = False
if not TYPE_CHECKING and os.environ.get("RLV_LANDING_PURE") != "1":
    try:
        from .compiled import DormandPrince, Exponential, Planar, Solver, System

        COMPILED = True
    except ImportError:
        pass
if not COMPILED:
    from .bodies.planar import Planar
    from .bodies.system import System
    from .solvers.dormand_prince import DormandPrince
    from .solvers.exponential import Exponential
    from .solvers.solver import Solver

__all__ = [
    "AUXILIARY_STRUTS",
    "COMPILED",
    "FRICTION_LAWS",
    "MAIN_STRUTS",
    "Accounts",
    "BodyModel",
    "BodyState",
    "DormandPrince",
    "Exponential",
    "Fault",
    "Inputs",
    "LegModel",
    "LegPlace",
    "LegState",
    "Phase",
    "Planar",
    "Solver",
    "System",
]
