"""The touchdown of a vertical-landing rocket stage on four legs: Yue, Lin, Zheng and Du (2022),
quasi-3D.
"""

from .errors import LandingError
from .landing import Landing
from .parameters import Parameters

__version__ = "0.1.0"
__all__ = ["Landing", "LandingError", "Parameters", "__version__", "load_preset"]


def load_preset(name: str, mode: str | None = None) -> Parameters:
    """The parameters of a preset, for the landing `mode`; `rlv_landing.presets.preset_names()`
    lists them.
    """
    from .presets import load_preset as load

    return load(name, mode)
