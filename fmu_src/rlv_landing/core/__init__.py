"""The kernels: plain Python on `math` alone, compiled where a compiler was there, the same digits either way.

`Solver` and `Model` come from the compiled module if there is one for this Python, else from the plain files.
RLV_LANDING_PURE=1 in the environment asks for the plain files.
"""

import os

from . import layout

try:
    if os.environ.get("RLV_LANDING_PURE") == "1":
        raise ImportError("the pure core is asked for")
    from .compiled import DormandPrince, Exponential, Model, Solver, output_size, state_size

    COMPILED = True
except ImportError:
    from .dormand_prince import DormandPrince
    from .exponential import Exponential
    from .integrator import Solver, output_size, state_size
    from .model import Model

    COMPILED = False

__all__ = [
    "COMPILED",
    "DormandPrince",
    "Exponential",
    "Model",
    "Solver",
    "layout",
    "output_size",
    "state_size",
]
