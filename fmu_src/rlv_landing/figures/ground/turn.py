"""How a deck that moved has turned the ground, in axes with z up."""

from __future__ import annotations

import numpy as np

from ...core import SpatialInputs
from ...core.bodies.deck import deck_turn, on_deck
from ...core.records import Vector
from .drawn import in_view
from .shape import Points


def deck_matrix(deck: SpatialInputs) -> Points:
    """The rotation of the ground on `deck` from that on a deck at rest, (3, 3), ROS's axes."""
    turn = deck_turn(deck)
    # the images of ROS's axes x, y (the model's -z) and z (the model's y)
    ends = (Vector(1.0, 0.0, 0.0), Vector(0.0, 0.0, -1.0), Vector(0.0, 1.0, 0.0))
    return in_view(np.array([on_deck(end, turn) for end in ends])).T


def deck_place(deck: SpatialInputs) -> Points:
    """Place of the ground's origin [m], ROS's axes."""
    return in_view(np.array([deck.surge, deck.heave, deck.sway]))
