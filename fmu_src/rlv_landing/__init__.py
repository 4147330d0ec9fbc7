"""The touchdown of a vertical-landing rocket stage on four legs.

The quasi-3D model of Yue, Lin, Zheng and Du (2022).
"""

from __future__ import annotations

# as in `typing`, whose import would take most of the time until Ctrl-C is answered
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .errors import IntegrationError, LandingError
    from .history import History
    from .landing import Landing
    from .outputs import Extreme
    from .parameters import Parameters
    from .presets import read_toml
    from .studies.many import land_many

__version__ = "0.1.0"
# of the model in FMI, where its user gives it no other
MODEL_NAME = "RlvLanding"
__all__ = [
    "Extreme",
    "History",
    "IntegrationError",
    "Landing",
    "LandingError",
    "Parameters",
    "__version__",
    "land_many",
    "load_preset",
    "read_toml",
]
# the modules of the names that are imported when they are asked for: the command line's first
# lines come before all that takes time
_MODULES = {
    "Extreme": "outputs",
    "History": "history",
    "IntegrationError": "errors",
    "Landing": "landing",
    "LandingError": "errors",
    "Parameters": "parameters",
    "land_many": "studies.many",
    "read_toml": "presets",
}


def __getattr__(name: str) -> Any:
    """One of the names that are imported when they are asked for."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = globals()[name] = getattr(import_module(f".{_MODULES[name]}", __name__), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULES})


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
