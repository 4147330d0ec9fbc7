"""The touchdown of a vertical-landing rocket stage on four legs.

The quasi-3D model of Yue, Lin, Zheng and Du (2022).
"""

from .errors import LandingError
from .landing import Landing
from .parameters import Parameters

__version__ = "0.1.0"
__all__ = ["Landing", "LandingError", "Parameters", "__version__", "load_preset"]


def load_preset(name: str, mode: str | None = None) -> Parameters:
    """The parameters of a preset for a landing mode.

    Args:
        name: The preset; `rlv_landing.presets.preset_names()` lists all.
        mode: `2-2` or `1-2-1`; default is the preset's own.

    Raises:
        LandingError: There is no such preset or mode.
    """
    from .presets import load_preset as load

    return load(name, mode)
