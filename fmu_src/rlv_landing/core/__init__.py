"""The kernels: plain Python on `math` alone, compiled where there was a compiler.

Both give the same digits. The classes come from the compiled module if there is one for this
Python and for the present files, else from the plain files. RLV_LANDING_PURE=1 in the environment
asks for the plain files. Records and laws' names are those of the plain files always.
A compiled module of other files is told by a RuntimeWarning. WHY_NOT_COMPILED is the reason why
there is none; it is empty where the plain files were asked for.

An FMU for several platforms has their compiled modules in folders of `compiled_for`, by FMI 3.0's
names of the platforms.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING

from .ground.kinds import FRICTION_LAWS
from .records import (
    Accounts,
    AcrossState,
    BodyModel,
    BodyPoint,
    BodyState,
    Fault,
    HeightField,
    Inputs,
    LegModel,
    LegPlace,
    LegState,
    Phase,
    PointState,
    SpatialInputs,
    SpatialModel,
    SpatialState,
)
from .struts.kinds import AUXILIARY_STRUTS, MAIN_STRUTS


def _platform() -> str:
    """FMI 3.0's name of this platform; of Windows and macOS, of the Python that runs."""
    if sys.platform == "win32":
        # Python for Arm has (ARM64) there
        return f"{'x86_64' if '(AMD64)' in sys.version else 'other'}-windows"
    machine = os.uname().machine
    return f"{'aarch64' if machine == 'arm64' else machine}-{sys.platform}"


COMPILED = False
WHY_NOT_COMPILED = ""
if not TYPE_CHECKING and os.environ.get("RLV_LANDING_PURE") != "1":
    # the compiled module imports it unchecked: without it, or interrupted there, the process
    # crashes
    import inspect  # noqa: F401

    _own = os.path.join(os.path.dirname(__file__), "compiled_for", _platform())  # noqa: PTH118, PTH120
    if os.path.isdir(_own):  # noqa: PTH112
        __path__.insert(0, _own)
    try:
        compiled = import_module(".compiled", __name__)
    except ImportError as e:
        WHY_NOT_COMPILED = str(e)
    else:
        COMPILED = True
        # an FMU's copy has another name, and the build has compared it
        if __name__ == "rlv_landing.core":
            from .freshness import is_fresh

            COMPILED = is_fresh(compiled)
        if COMPILED:
            from .compiled import (
                DormandPrince,
                Exponential,
                Legged,
                Planar,
                Sea,
                Solver,
                Spatial,
                System,
            )
if not COMPILED:
    from .bodies.legged import Legged
    from .bodies.planar import Planar
    from .bodies.sea import Sea
    from .bodies.spatial import Spatial
    from .bodies.system import System
    from .solvers.dormand_prince import DormandPrince
    from .solvers.exponential import Exponential
    from .solvers.solver import Solver

__all__ = [
    "AUXILIARY_STRUTS",
    "COMPILED",
    "FRICTION_LAWS",
    "MAIN_STRUTS",
    "WHY_NOT_COMPILED",
    "Accounts",
    "AcrossState",
    "BodyModel",
    "BodyPoint",
    "BodyState",
    "DormandPrince",
    "Exponential",
    "Fault",
    "HeightField",
    "Inputs",
    "LegModel",
    "LegPlace",
    "LegState",
    "Legged",
    "Phase",
    "Planar",
    "PointState",
    "Sea",
    "Solver",
    "Spatial",
    "SpatialInputs",
    "SpatialModel",
    "SpatialState",
    "System",
]
