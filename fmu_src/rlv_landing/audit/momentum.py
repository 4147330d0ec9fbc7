"""Linear and angular momentum of the whole vehicle, and what a landing must conserve of them.

They come from a history's outputs alone. No kernel of the core is used, so that the result is an
independent check.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

from ..history import History
from ..landing import Landing
from ..parameters import Parameters
from ..quantities import LEGS, SPACE, azimuth, groups_of
from ..touchdown import footpad_at_rest
from .bounds import TIGHT_RTOL, Check
from .cases import mass
from .spatial_momentum import rates_in_plane, spatial_impulse, spatial_momentum

Array = NDArray[np.float64]
FLIGHT = 0.3
# a smaller change is none, of the vertical momentum's; that times the footpads' radius
LEAST_CHANGE = 1e-3
SAMPLE_STEP, FINE_STEP, FINE_BEFORE, FINE_AFTER = 5e-5, 1e-6, 5e-5, 5e-4


@dataclass(frozen=True)
class Momentum:
    """Momentum of body and footpads at every sample, arrays (n,).

    Attributes:
        x: Along inertial x [N s].
        y: Along inertial y [N s].
        about_origin: About the inertial origin, clockwise positive as the pitch [N m s].
        about_cg: About the whole vehicle's CG, clockwise positive [N m s].
    """

    x: Array
    y: Array
    about_origin: Array
    about_cg: Array


def _mass_points(
    history: History, parameters: Parameters
) -> list[tuple[float, Array, Array, Array, Array]]:
    """(mass, x, y, vx, vy) of the body and every footpad, inertial axes.

    Footpads' velocities are solved from both struts' stroke rates.
    """
    v = parameters.vehicle
    x, y, pitch, vx, vy, rate = (
        history[f"body.{n}"] for n in ("x", "y", "pitch", "vx", "vy", "pitch_rate")
    )
    sine, cosine = np.sin(pitch), np.cos(pitch)
    points = [(v.mass, x, y, vx, vy)]
    turns = {leg: azimuth(g.azimuth) for g in groups_of(parameters.drop.mode) for leg, _ in g.legs}
    for leg in LEGS:
        sin_g, cos_g = turns[leg]
        dx, dy = history[f"leg[{leg}].footpad.x"] - x, history[f"leg[{leg}].footpad.y"] - y
        body_x, h = dx * cosine - dy * sine, dx * sine + dy * cosine
        r = body_x * cos_g + np.abs(history[f"leg[{leg}].footpad.z"]) * sin_g
        vr, vh = rates_in_plane(history, parameters, leg, r, h)
        along, up = vr * cos_g + rate * h, vh - rate * body_x
        points.append(
            (
                v.footpad_mass,
                x + dx,
                y + dy,
                vx + along * cosine + up * sine,
                vy - along * sine + up * cosine,
            )
        )
    return points


def momentum(history: History, parameters: Parameters) -> Momentum:
    """The momentum at every sample.

    The history needs the landing's own columns, stroke rates included.
    """
    points = _mass_points(history, parameters)
    total = sum(p[0] for p in points)
    px: Array = np.sum([m * vx for m, _, _, vx, _ in points], axis=0)
    py: Array = np.sum([m * vy for m, _, _, _, vy in points], axis=0)
    cx: Array = np.sum([m * x for m, x, *_ in points], axis=0) / total
    cy: Array = np.sum([m * y for m, _, y, _, _ in points], axis=0) / total
    turning: Array = np.sum([m * (y * vx - x * vy) for m, x, y, vx, vy in points], axis=0)
    origin = parameters.vehicle.inertia * history["body.pitch_rate"] + turning
    return Momentum(px, py, origin, origin - (cy * px - cx * py))


def impulse(history: History, parameters: Parameters) -> Momentum:
    """The impulse of contact forces and weight since the first sample.

    It is integrated by Simpson's rule over the samples; `about_cg` is left 0.
    """
    g, v = parameters.ground.gravity, parameters.vehicle
    t = history.time
    force_x: Array = np.zeros(len(t))
    force_y: Array = np.full(len(t), -g * v.mass)
    moment: Array = g * v.mass * history["body.x"]
    for leg in LEGS:
        fx, fy = (
            history[f"leg[{leg}].contact.force_x"],
            history[f"leg[{leg}].contact.force_y"] - g * v.footpad_mass,
        )
        force_x = force_x + fx
        force_y = force_y + fy
        moment = (
            moment + history[f"leg[{leg}].footpad.y"] * fx - history[f"leg[{leg}].footpad.x"] * fy
        )
    x, y, turn = (
        np.asarray(cumulative_simpson(f, x=t, initial=0.0)) for f in (force_x, force_y, moment)
    )
    return Momentum(x, y, turn, np.zeros(len(t)))


@dataclass(frozen=True)
class _Balance:
    """Momentum at every sample, and the impulse that it must have got, in whichever mode.

    Each is (found, given), with an array (n,) or in space (n, components).
    """

    across: tuple[Array, Array]
    up: tuple[Array, Array]
    turning: tuple[Array, Array]
    about_cg: Array


def _balance(history: History, parameters: Parameters) -> _Balance:
    if parameters.drop.mode == SPACE:
        whole, got = spatial_momentum(history, parameters), spatial_impulse(history, parameters)
        return _Balance(
            (whole.linear[:, ::2], got.linear[:, ::2]),
            (whole.linear[:, 1], got.linear[:, 1]),
            (whole.about_origin, got.about_origin),
            whole.about_cg,
        )
    found, given = momentum(history, parameters), impulse(history, parameters)
    return _Balance(
        (found.x, given.x),
        (found.y, given.y),
        (found.about_origin, given.about_origin),
        found.about_cg,
    )


def flight(parameters: Parameters) -> list[Check]:
    """Momentum in 0.3 s of turning free flight.

    The flight's state at touchdown is the landing's, but faster downward by gravity times 0.3 s.
    """
    drop, g = parameters.drop, parameters.ground.gravity
    rate = drop.pitch_rate if abs(drop.pitch_rate) > 0.1 else 0.2
    speed = max(drop.vertical_velocity - g * FLIGHT, -50.0)
    drop = replace(drop, contact_time=FLIGHT, vertical_velocity=speed, pitch_rate=rate)
    if drop.mode == SPACE:
        drop = replace(drop, roll_rate=drop.roll_rate or 0.15, yaw_rate=drop.yaw_rate or 0.1)
    flying = replace(parameters, drop=drop, by_mode={})
    history = Landing(flying, rtol=TIGHT_RTOL).run(0.95 * FLIGHT)
    found = _balance(history, flying)
    size = mass(parameters) * max(g, 1.0) * FLIGHT
    linear = max(np.abs(a - a[0] - b).max() for a, b in (found.across, found.up)) / size
    cg = found.about_cg
    angular = np.ptp(cg, axis=0).max() / np.abs(cg).max()
    consistent = parameters.vehicle.transverse_load_at == "footpad"
    return [
        Check("flight_momentum", float(linear)),
        Check("flight_angular", float(angular), consistent),
    ]


def contact(parameters: Parameters, until: float) -> list[Check]:
    """Change of momentum against the integral of contact forces and weight."""
    landing = Landing(parameters, rtol=TIGHT_RTOL)
    coarse = np.arange(int(until / SAMPLE_STEP) + 1) * SAMPLE_STEP
    history = _sample(landing, coarse)
    active = np.array([history[f"leg[{leg}].contact.active"] for leg in history.legs])
    changes = np.flatnonzero(np.any(np.diff(active, axis=1) != 0.0, axis=0))
    fine = [
        np.arange(coarse[i] - FINE_BEFORE, coarse[i + 1] + FINE_AFTER, FINE_STEP) for i in changes
    ]
    times = np.unique(np.round(np.concatenate([coarse, *fine]), 9))
    landing.reset()
    history = _sample(landing, times[(times >= 0.0) & (times <= until)])
    found = _balance(history, parameters)

    # of a level landing the horizontal and the angular momentum do not change but for rounding
    least = LEAST_CHANGE * float(np.ptp(found.up[0]))

    def left(a: Array, b: Array, least: float = 0.0) -> float:
        return float(np.abs(a - a[0] - b).max() / max(np.ptp(a, axis=0).max(), least))

    return [
        Check("momentum_x", left(*found.across, least)),
        Check("momentum_y", left(*found.up)),
        Check(
            "angular",
            left(*found.turning, least * footpad_at_rest(parameters)[0]),
            parameters.vehicle.transverse_load_at == "footpad",
        ),
    ]


def _sample(landing: Landing, times: Any) -> History:
    def values(time: float) -> list[float]:
        landing.advance_to(time)
        return landing.values()

    return History(
        times,
        landing.interface.output_names,
        np.array([values(t) for t in times.tolist()]),
        landing.parameters,
    )
