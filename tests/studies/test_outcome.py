"""The outcome of real landings, each read again by a plain loop or known by a closed form."""

from __future__ import annotations

import pickle
from math import hypot, sin

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.quantities import LEGS
from rlv_landing.studies.limits import LIMITS
from rlv_landing.studies.outcome import SEVERITY, outcome
from rlv_landing.studies.whole_landing import whole_landing

FIGURES = "yue2022-figures"
HARD = {"drop.vertical_velocity": -3.5, "main_strut.stroke_max": 0.03}
ICE = {
    "ground.friction": 0.0,
    "ground.slope": 0.1,
    "drop.tilt": 0.1,
    "drop.pitch_rate": 0.0,
    "drop.horizontal_velocity": 0.0,
}
UPRIGHT = {"drop.tilt": 0.0, "drop.pitch_rate": 0.0, "drop.horizontal_velocity": 0.0}


def landed(
    until: float, mode: str = "2-2", moment: float = 0.0, every: float = 1e-3, **values: float | str
) -> History:
    named = {name.replace("__", "."): value for name, value in values.items()}
    landing = Landing(load_preset(FIGURES, mode).with_values({"drop.contact_time": 0.0, **named}))
    if moment:
        landing.set_inputs({"external.moment": moment})
    return landing.run(until, every)


@pytest.fixture(scope="module")
def landings() -> dict[str, History]:
    """One real landing of each name."""
    return {
        "settled": landed(6.0, **UPRIGHT),
        "standing": whole_landing(
            Landing(load_preset(FIGURES).with_values({"drop.contact_time": 0.0})), standing=True
        ),
        "moving": landed(0.3),
        "slid": landed(1.5, **ICE),
        "bottomed out": landed(0.4, **HARD),
        "body strike": landed(
            0.4, "space", vehicle__body_points="0 -2.12 0", drop__vertical_velocity=-2.0
        ),
        "toppled": landed(1.5, moment=5000.0),
    }


@pytest.mark.parametrize("name", SEVERITY)
def test_a_landing_is_called_what_it_came_to(landings, name):
    assert outcome(landings[name]).name == name


def test_settled_since_the_phase_last_became_2(landings):
    h = landings["settled"]
    phase = list(h["status.phase"])
    last_other = max(i for i, p in enumerate(phase) if p != 2.0)
    assert outcome(h).time == h.time[last_other + 1]


def test_moving_lasts_to_the_end(landings):
    assert outcome(landings["moving"]).time == landings["moving"].time[-1]


def test_toppled_since_the_cg_is_beyond_the_outermost_footpad_or_the_body_over(landings):
    h, found = landings["toppled"], outcome(landings["toppled"])
    feet = np.array([h[f"leg[{leg}].footpad.x"] for leg in LEGS])
    body, foot = h.parameters.vehicle.mass, h.parameters.vehicle.footpad_mass
    cg = (body * h["body.x"] + foot * feet.sum(axis=0)) / (body + foot * len(LEGS))
    beyond = (cg > feet.max(axis=0)) | (cg < feet.min(axis=0))
    over = np.abs(h["body.pitch"]) > np.pi / 2
    assert found.time == h.time[np.flatnonzero(~(beyond | over))[-1] + 1]
    assert found.margins["stability_end"] == h["status.stability_margin"][-1]
    assert found.margins["stability_min"] < 0.0


def test_the_first_leg_that_meets_its_stop_is_named_with_its_time(landings):
    h, found = landings["bottomed out"], outcome(landings["bottomed out"])
    first = min(
        (h.time[np.flatnonzero(h[f"leg[{leg}].main_strut.stroke"] > 0.03)[0]], leg)
        for leg in (1, 2)
    )
    assert (found.time, found.leg) == first
    assert found.margins["stroke_left"] == approx(
        0.03 - max(h.extreme(f"leg[{leg}].main_strut.stroke").maximum for leg in LEGS)
    )


def test_on_a_slope_without_friction_the_feet_slide_as_far_as_gravity_takes_them(landings):
    """The distance along the slope is v sin(slope) t + g sin(slope) t^2/2.

    v is the sinking speed; the footpads' spreading is apart.
    """
    h, found = landings["slid"], outcome(landings["slid"])
    assert found.margins["slid"] == approx(
        sin(0.1) * (1.379071 * 1.5 + 0.5 * 9.81 * 1.5**2), rel=0.03
    )
    start = {
        leg: next(i for i, on in enumerate(h[f"leg[{leg}].contact.active"]) if on) for leg in LEGS
    }

    def moved(leg: int, i: int) -> float:
        names = [f"leg[{leg}].footpad.{axis}" for axis in "xyz"]
        return hypot(*(h[n][i] - h[n][start[leg]] for n in names))

    first = min(i for i in range(len(h)) for leg in LEGS if i >= start[leg] and moved(leg, i) > 0.3)
    assert h.time[first - 1] < found.time <= h.time[first]
    assert outcome(h, slide=5.0).name != "slid"


def test_what_never_touches_has_not_slid():
    h = landed(0.05, drop__contact_time=0.1)
    assert outcome(h).margins["slid"] == 0.0
    assert outcome(h).name == "moving"


def test_margins_are_the_smallest_and_the_last_of_the_status(landings):
    for h in landings.values():
        margins = outcome(h).margins
        assert margins["stability_min"] == h.extreme("status.stability_margin").minimum
        assert margins["stability_end"] == h["status.stability_margin"][-1]


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
def test_joint_clearance_is_that_of_the_lowest_auxiliary_joint(mode):
    """In free flight the body's position is known.

    Radius and depth of the joints are turned by the pitch, above a slope.
    """
    h = landed(0.02, mode, ground__slope=0.1, drop__contact_time=0.03)
    p = h.parameters.auxiliary_strut
    lowest = np.inf
    for x, y, pitch in zip(h["body.x"], h["body.y"], h["body.pitch"]):
        for along in (
            np.cos(np.radians([45, 135] if mode == "2-2" else [0, 90, 180])) * p.joint_radius
        ):
            joint_x = x + along * np.cos(pitch) - p.joint_depth * np.sin(pitch)
            joint_y = y - along * np.sin(pitch) - p.joint_depth * np.cos(pitch)
            lowest = min(lowest, joint_x * sin(0.1) + joint_y * np.cos(0.1))
    assert outcome(h).margins["joint_clearance"] == approx(lowest, rel=1e-12)


def altered(h: History, **columns: np.ndarray | float) -> History:
    """The landing with some columns, by their short NAMES, replaced."""
    data = h.data.copy()
    for name, values in columns.items():
        data[:, h.names.index(NAMES[name])] = values
    return History(h.time, h.names, data, h.parameters)


NAMES = {"phase": "status.phase", "stroke": "leg[1].main_strut.stroke", "x": "leg[1].footpad.x"}


def test_the_severest_name_wins(landings):
    """All that is wrong is put on one settled landing, and taken away again from the top."""
    h = landings["settled"]
    slide, deep, over = (np.linspace(0.0, top, len(h)) for top in (2.0, 0.2, 3.9))
    worse = {"x": slide, "stroke": deep, "phase": np.floor(over)}
    assert outcome(altered(h, **worse)).name == "toppled"
    worse["phase"] = np.minimum(worse["phase"], 1.0)
    assert outcome(altered(h, **worse)).name == "bottomed out"
    del worse["stroke"]
    assert outcome(altered(h, **worse)).name == "slid"
    del worse["x"]
    assert outcome(altered(h, **worse)).name == "moving"


def test_beyond_its_feet_for_a_moment_and_back_has_not_toppled(landings):
    h = landings["settled"]
    phase = h["status.phase"].copy()
    phase[100:150] = 3.0
    assert outcome(altered(h, phase=phase)).name == "settled"


SIZES = {
    "main_strut.force": lambda h, leg: np.abs(h[f"leg[{leg}].main_strut.force"]),
    "auxiliary_strut.force": lambda h, leg: np.abs(h[f"leg[{leg}].auxiliary_strut.force"]),
    "main_strut.stroke": lambda h, leg: h[f"leg[{leg}].main_strut.stroke"],
    "main_strut.pressure_upper": lambda h, leg: h[f"leg[{leg}].main_strut.pressure_upper"],
    "main_strut.pressure_lower": lambda h, leg: h[f"leg[{leg}].main_strut.pressure_lower"],
    "contact.force": lambda h, leg: h[f"leg[{leg}].contact.force"],
    "body.top_axial_acceleration": lambda h, leg: h["body.top_axial_acceleration"],
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_is_passed_where_its_quantity_first_exceeds_it(landings, name):
    h = landed(0.3, every=2e-5)
    sizes = {leg: SIZES[name](h, leg) for leg in LEGS}
    limit = 0.8 * max(s.max() for s in sizes.values())
    passed = outcome(h, {name: limit}).first_limit
    first = min(
        (int(np.flatnonzero(s > limit)[0]), leg) for leg, s in sizes.items() if s.max() > limit
    )
    assert passed.time == h.time[first[0]]
    assert passed.leg == (None if name.startswith("body.") else first[1])
    assert (passed.name, passed.limit) == (name, limit)
    assert outcome(h, {name: 1.3 * limit}).first_limit is None


def test_of_several_limits_the_earliest_is_named(landings):
    h = landings["bottomed out"]
    alone = {name: outcome(h, {name: limit}).first_limit for name, limit in BOTH.items()}
    assert alone["main_strut.force"].time < alone["main_strut.stroke"].time
    assert outcome(h, BOTH).first_limit == alone["main_strut.force"]
    assert outcome(h, dict(reversed(BOTH.items()))).first_limit == alone["main_strut.force"]


BOTH = {"main_strut.stroke": 0.02, "main_strut.force": 3000.0}


def test_an_outcome_can_be_sent_to_another_process(landings):
    found = outcome(landings["bottomed out"], {"main_strut.force": 100.0})
    assert pickle.loads(pickle.dumps(found)) == found


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"limits": {"main_strut.farce": 1.0}},
            r"unknown limit 'main_strut\.farce'; did you mean main_strut\.force\?",
        ),
        (
            {"limits": {"main_strut.force": -1.0}},
            r"main_strut\.force = -1 N is outside \[0, 1e\+12\] N",
        ),
        ({"limits": {"main_strut.stroke": float("nan")}}, r"main_strut\.stroke = nan m is outside"),
        ({"slide": -0.1}, r"slide = -0\.1 m must be 0 m or more"),
    ],
)
def test_arguments_that_cannot_be_are_refused(landings, arguments, message):
    with pytest.raises(LandingError, match=message):
        outcome(landings["moving"], **arguments)


def test_a_history_without_parameters_is_refused(landings):
    h = landings["moving"]
    with pytest.raises(LandingError, match="does not know its parameters"):
        outcome(History(h.time, h.names, h.data))


def test_what_comes_after_toppling_does_not_count(landings):
    h = landings["toppled"]
    over = int(np.flatnonzero(h.time == outcome(h).time)[0])
    force = np.abs(h["leg[4].main_strut.force"])
    assert force[over + 1 :].max() > force[: over + 1].max()
    limits = {
        "main_strut.force": 1.001
        * max(np.abs(h[f"leg[{leg}].main_strut.force"][: over + 1]).max() for leg in LEGS)
    }
    assert outcome(h, limits).first_limit is None


def test_a_landing_that_bottoms_out_and_topples_names_the_leg_all_the_same(landings):
    h = landings["toppled"]
    stroke = np.zeros(len(h))
    stroke[100] = 0.06
    assert outcome(altered(h, stroke=stroke)).leg == 1
    assert outcome(h).leg is None
