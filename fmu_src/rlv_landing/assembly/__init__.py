"""The kernels' vehicle, and its state at the start, from the user's parameters."""

from .legs import (
    LEG_SCALE,
    bearing_nothing_at_rest,
    leg_model,
    tangential_stiffness,
    touchdown_energy,
)
from .planar import (
    BODY_SCALE,
    body_model,
    ground_motion,
    leg_models,
    leg_places,
    planar_start,
    planar_system,
)
from .sea import waves_of
from .spatial import spatial_system
from .spatial_flight import DeckMotion
from .start import begin, landing_system, new_solver

__all__ = [
    "BODY_SCALE",
    "LEG_SCALE",
    "DeckMotion",
    "bearing_nothing_at_rest",
    "begin",
    "body_model",
    "ground_motion",
    "landing_system",
    "leg_model",
    "leg_models",
    "leg_places",
    "new_solver",
    "planar_start",
    "planar_system",
    "spatial_system",
    "tangential_stiffness",
    "touchdown_energy",
    "waves_of",
]
