"""A first vehicle from a few numbers: the legs' geometry, their dampers, and all parameters."""

from __future__ import annotations

from .damper import Damper, size_damper
from .leg_geometry import LegGeometry, leg_geometry
from .needs import LIKE, Needs, needs_like
from .vehicle import size_vehicle

__all__ = [
    "LIKE",
    "Damper",
    "LegGeometry",
    "Needs",
    "leg_geometry",
    "needs_like",
    "size_damper",
    "size_vehicle",
]
