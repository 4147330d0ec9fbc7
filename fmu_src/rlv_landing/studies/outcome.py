"""What a landing came to, as studies count it: one name, when and where, how much was left, and
which limit was passed first.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..core import Phase
from ..errors import LandingError, unknown
from ..history import History
from ..parameters import azimuth, check_value
from ..quantities import MODES, Quantity
from ..touchdown import AT_REST

Array = NDArray[np.float64]
Name = Literal["toppled", "bottomed out", "slid", "moving", "settled"]
# the outcomes, the severest first
SEVERITY: tuple[Name, ...] = get_args(Name)
SETTLED, TOPPLED = float(Phase.SETTLED), float(Phase.TOPPLED)
# the paper does not print its footpads' diameter; a leg's spreading alone moves a footpad by some
# centimetres
DEFAULT_SLIDE = 0.3

# what may be limited, by output name: the largest value is compared; of a load its magnitude
LIMITS: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity(
            "N",
            "main strut's axial force, either sign",
            0.0,
            1e12,
            name="main_strut.force",
            display_unit="kN",
        ),
        Quantity(
            "N",
            "auxiliary strut's axial force, either sign",
            0.0,
            1e12,
            name="auxiliary_strut.force",
            display_unit="kN",
        ),
        Quantity(
            "m",
            "damper's stroke in compression",
            0.0,
            100.0,
            name="main_strut.stroke",
            display_unit="mm",
        ),
        Quantity(
            "Pa",
            "absolute pressure in the upper chamber",
            0.0,
            1e12,
            name="main_strut.pressure_upper",
            display_unit="MPa",
        ),
        Quantity(
            "Pa",
            "absolute pressure in the lower chamber",
            0.0,
            1e12,
            name="main_strut.pressure_lower",
            display_unit="MPa",
        ),
        Quantity(
            "N",
            "force between ground and footpad, all directions together",
            0.0,
            1e12,
            name="contact.force",
            display_unit="kN",
        ),
        Quantity(
            "m/s2",
            "axial acceleration of the top, upward",
            0.0,
            1e6,
            name="body.top_axial_acceleration",
        ),
    )
}


@dataclass(frozen=True)
class Passed:
    """A limit that a landing passed: its name in LIMITS, the `leg` (None for the body), the time
    [s] of the first sample beyond it, and the limit itself [SI].
    """

    name: str
    leg: int | None
    time: float
    limit: float


@dataclass(frozen=True)
class Outcome:
    """What a landing came to.

    `name` is the severest that holds, in this order:

    - toppled: at the end the vehicle's CG is beyond the outermost footpad or the body has turned
      over (`status.phase` 3). A vehicle that was beyond its feet for a moment and came back has not
      toppled. `time` is when it went for good;
    - bottomed out: a damper's stroke has passed `main_strut.stroke_max`, where it meets its stop.
      `time` when the first did;
    - slid: a footpad is further than the threshold from where it first touched. `time` when it
      first was;
    - moving: neither at rest nor lost at the end, which is `time`: run it longer;
    - settled: at rest since `time`.

    `leg` is the first that bottomed out, whatever the name, else None; of legs that are mirror
    images the lower number stands for both. What comes after toppling is meaningless and counts in
    the stability margins only.

    `margins` [m]: `stability_min` and `stability_end`, the smallest and the last
    `status.stability_margin`; `stroke_left` to the stop; `slid`, the farthest that a footpad lies
    at the end from where on the ground it first touched, which may move (the legs' spreading is in
    it); `joint_clearance`, the least height above the ground of the body's lowest leg joints, the
    lowest of the body that the model knows. Peaks between samples are not seen.
    """

    name: Name
    time: float
    leg: int | None
    margins: Mapping[str, float]
    first_limit: Passed | None


def outcome(
    history: History, limits: Mapping[str, float] | None = None, slide: float = DEFAULT_SLIDE
) -> Outcome:
    """What the landing `history` came to; `limits` by name in LIMITS [SI]; `slide` [m] is what a
    footpad may move and has not slid.

    Raises LandingError where the history does not know its parameters, for an unknown limit, and
    for a limit or a `slide` that is negative or NaN.
    """
    if history.parameters is None:
        raise LandingError(
            "this history does not know its parameters; give one that Landing.run returned"
        )
    if not slide >= 0.0:
        raise LandingError(f"slide = {slide:g} m must be 0 m or more")
    p = history.parameters
    legs, joints = _legs(p.drop.mode)
    phase, margin = history["status.phase"], history["status.stability_margin"]
    toppled = bool(phase[-1] == TOPPLED)
    if toppled:
        over = _lasting(phase, TOPPLED) + 1
        history = History(
            history.time[:over], history.names, history.data[:over], p, history.ground
        )
    time = history.time
    strokes = [history[f"leg[{leg}].main_strut.stroke"] for leg in legs]
    deepest = [float(s.max()) for s in strokes]
    stop = p.main_strut.stroke_max
    slips = [_slip(history, leg) for leg in legs]
    margins = {
        "stability_min": float(margin.min()),
        "stability_end": float(margin[-1]),
        "stroke_left": stop - max(deepest),
        "slid": max((float(s[-1]) for s in slips if len(s)), default=0.0),
        "joint_clearance": _joint_clearance(history, joints),
    }
    name: Name
    met = [
        (int(np.argmax(s > stop)), leg)
        for s, leg, most in zip(strokes, legs, deepest)
        if most > stop
    ]
    if toppled:
        name, when = "toppled", float(time[-1])
    elif met:
        name, when = "bottomed out", float(time[min(met)[0]])
    elif any(len(s) and s.max() > slide for s in slips):
        name = "slid"
        when = min(
            float(time[len(time) - len(s) + int(np.argmax(s > slide))])
            for s in slips
            if len(s) and s.max() > slide
        )
    elif phase[-1] == SETTLED:
        name, when = "settled", float(time[_lasting(phase, SETTLED)])
    else:
        name, when = "moving", float(time[-1])
    leg = min(met)[1] if met else None
    return Outcome(
        name, when, leg, margins, _first_limit(history, legs, limits) if limits else None
    )


@lru_cache
def _legs(mode: str) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """One leg of each group of mirror images, its lowest number, and the cosine of its azimuth."""
    groups = sorted((min(leg for leg, _ in g.legs), azimuth(g.azimuth)[1]) for g in MODES[mode])
    return tuple(leg for leg, _ in groups), tuple(c for _, c in groups)


def _slip(history: History, leg: int) -> Array:
    """Distance [m] of the footpad from where on the ground it first touched, from then to the end;
    empty for one that never touches.
    """
    touching = history[f"leg[{leg}].contact.active"]
    start = int(np.argmax(touching > 0.0))
    if not touching[start] > 0.0:
        return np.empty(0)
    along, up, _ = _on_ground(history, *(history[f"leg[{leg}].footpad.{axis}"] for axis in "xy"))
    x, y, z = (values[start:] for values in (along, up, history[f"leg[{leg}].footpad.z"]))
    distance: Array = np.sqrt((x - x[0]) ** 2 + (y - y[0]) ** 2 + (z - z[0]) ** 2)
    return distance


def _on_ground(history: History, x: Array, y: Array) -> tuple[Array, Array, Array | float]:
    """A point's place along the ground and height above it [m], from its inertial `x` and `y` [m],
    and the ground's slope with its tilt [rad].
    """
    p = history.parameters
    assert p is not None
    slope: Array | float = p.ground.slope
    if history.ground != AT_REST:
        heave, tilt = history.ground.at(history.time - history.time[0])
        slope, y = slope + tilt, y - heave
    return x * np.cos(slope) - y * np.sin(slope), x * np.sin(slope) + y * np.cos(slope), slope


def _joint_clearance(history: History, cosines: tuple[float, ...]) -> float:
    """Least height [m] above the ground, along its normal, of the auxiliary struts' body joints."""
    p = history.parameters
    assert p is not None
    radius, depth = p.auxiliary_strut.joint_radius, p.auxiliary_strut.joint_depth
    _, height, slope = _on_ground(history, history["body.x"], history["body.y"])
    turned = history["body.pitch"] - slope
    height = height - depth * np.cos(turned)
    sine = np.sin(turned)
    return min(float((height - radius * c * sine).min()) for c in cosines)


def _lasting(phase: Array, which: float) -> int:
    """The sample from which on the phase is `which` until the end."""
    other = np.flatnonzero(phase != which)
    return int(other[-1]) + 1 if len(other) else 0


def _resultant(history: History, leg: int) -> Array:
    x, y, z = (history[f"leg[{leg}].contact.force_{axis}"] for axis in "xyz")
    force: Array = np.sqrt(x * x + y * y + z * z)
    return force


def _magnitude(name: str) -> Callable[[History, int], Array]:
    return lambda history, leg: np.abs(history[f"leg[{leg}].{name}"])


def _plain(name: str) -> Callable[[History, int], Array]:
    return lambda history, leg: history[f"leg[{leg}].{name}"]


READERS: dict[str, Callable[[History, int], Array]] = {
    "main_strut.force": _magnitude("main_strut.force"),
    "auxiliary_strut.force": _magnitude("auxiliary_strut.force"),
    "main_strut.stroke": _plain("main_strut.stroke"),
    "main_strut.pressure_upper": _plain("main_strut.pressure_upper"),
    "main_strut.pressure_lower": _plain("main_strut.pressure_lower"),
    "contact.force": _resultant,
}


def check_limits(limits: Mapping[str, float]) -> dict[str, float]:
    """`limits` by name [SI].

    Raises LandingError for a name that is not in LIMITS, and a value that is negative, NaN or no
    number.
    """
    for name in limits:
        if name not in LIMITS:
            raise unknown("limit", name, LIMITS)
    return {name: float(check_value(LIMITS[name], value)) for name, value in limits.items()}


def _first_limit(
    history: History, legs: tuple[int, ...], limits: Mapping[str, float]
) -> Passed | None:
    """The limit that is passed at the earliest sample; of several there, the one that is passed by
    the largest part of itself.
    """
    found: list[tuple[int, float, Passed]] = []
    for name, limit in check_limits(limits).items():
        whose = legs if name in READERS else (None,)
        for leg in whose:
            values = READERS[name](history, leg) if leg is not None else history[name]
            if not values.max() > limit:
                continue
            i = int(np.argmax(values > limit))
            excess = float(values[i]) / limit if limit > 0.0 else np.inf
            found.append((i, -excess, Passed(name, leg, float(history.time[i]), limit)))
    return min(found, key=lambda f: f[:2])[2] if found else None
