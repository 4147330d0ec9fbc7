"""The landing in a log as a Rerun scene. Needs rerun-sdk."""

from __future__ import annotations

from typing import Any

import numpy as np

from rlv_landing.figures.wireframe import wireframe
from rlv_landing.history import History
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS

from .rerun_scene import AUXILIARY, BODY, MAIN, Array, Scene


def landing_scene(history: History, parameters: Parameters) -> Scene:
    """The scene of a landing, with every sample.

    Args:
        history: the landing.
        parameters: its vehicle and ground.
    """
    scene = Scene(parameters.drop.mode)
    scene.ground(parameters.ground.slope)
    time = history.time
    parts = {
        part: in_ros_axes(lines)
        for part, lines in wireframe(history, parameters, np.arange(len(history))).items()
    }
    scene.lines(BODY, time, (parts["outline"], parts["hull"]))
    scene.lines(MAIN, time, (parts["main"],))
    scene.lines(AUXILIARY, time, (parts["auxiliary"],))
    feet = parts["feet"][:, :, 0]
    scene.footpads(time, feet)
    forces = [[history[f"leg[{leg}].contact.force_{axis}"] for axis in "xyz"] for leg in LEGS]
    scene.contacts(time, feet, in_ros_axes(np.array(forces).transpose(2, 0, 1)))
    scene.curves(time, {name: history[name] for name in history.names})
    return scene


def in_ros_axes(points: Any) -> Array:
    """Points in REP-103 axes (x forward, y left, z up).

    Args:
        points: (..., 3), in the paper's axes (x forward, y up, z right).
    """
    return np.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)
