"""The landing in a log as a Rerun scene. Needs rerun-sdk."""

from __future__ import annotations

import numpy as np

from rlv_landing.figures.ground.drawn import in_view
from rlv_landing.figures.ground.shape import decks_of
from rlv_landing.figures.wireframe import contact_forces, wireframe
from rlv_landing.history import History
from rlv_landing.parameters import Parameters
from rlv_landing.touchdown import AT_REST

from .rerun_scene import AUXILIARY, BODY, MAIN, Scene


def landing_scene(history: History, parameters: Parameters) -> Scene:
    """The scene of a landing, with every sample.

    Args:
        history: the landing.
        parameters: its vehicle and ground.
    """
    scene = Scene(parameters.drop.mode, int(parameters.vehicle.legs), parameters.leg.kind)
    time = history.time
    parts = {
        part: in_view(lines)
        for part, lines in wireframe(history, parameters, np.arange(len(history))).items()
    }
    scene.lines(BODY, time, (parts["outline"], parts["hull"]))
    scene.lines(MAIN, time, (parts["main"],))
    scene.lines(AUXILIARY, time, (parts["auxiliary"],))
    feet = parts["feet"][:, :, 0]
    scene.ground(parameters, 1.0 + float(np.abs(feet[..., :2]).max()))
    if history.decks is not None or history.ground != AT_REST:
        scene.decks(time, decks_of(history, range(len(time))))
    scene.footpads(time, feet)
    scene.contacts(time, feet, in_view(contact_forces(history, parameters, np.arange(len(time)))))
    scene.curves(time, {name: history[name] for name in history.names})
    return scene
