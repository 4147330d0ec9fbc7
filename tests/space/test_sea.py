"""A deck at sea: its spectrum and operators by closed forms, its motion, and landings on it."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from space_vehicles import SPACE, TURNING, vehicle

from rlv_landing import Landing, LandingError, Parameters, land_many
from rlv_landing.assembly.sea import HARMONICS, uniform, wave_components, waves_of
from rlv_landing.core.bodies.sea import FREEDOMS, WAVE
from rlv_landing.parameters import operators_from_table
from rlv_landing.parameters.operators import FREEDOMS as NAMES
from rlv_landing.parameters.sea import HIGHEST, LOWEST
from rlv_landing.presets import parse_toml, to_toml
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import whole_landing

SEA: dict[str, Any] = {
    "sea.wave_height": 2.5,
    "sea.direction": 0.7,
    "sea.seed": 3.0,
    "sea.time": 41.0,
    "sea.deck_x": -30.0,
    "sea.deck_y": 8.0,
    "sea.deck_z": 2.0,
}
AT_SEA = SPACE | SEA | TURNING | {"drop.vertical_velocity": -2.5}
HEAD = ", ".join(
    f"{name} [{'deg/m' if name in NAMES[3:] else 'm/m'}], {name} phase [deg]" for name in NAMES
)


def table(frequencies: list[float], heave: list[float], direction: float = 0.0) -> str:
    """A table of operators in heave alone."""
    rows = [
        ", ".join(map(repr, (w, direction, 0.0, 0.0, a, 0.0, *[0.0] * 8)))
        for w, a in zip(frequencies, heave)
    ]
    return "\n".join([f"frequency [rad/s], direction [deg], {HEAD}", *rows])


def summed(parameters: Parameters, times: Any) -> tuple[np.ndarray, np.ndarray]:
    """Places and rates of the deck at times of the landing, (6, n): every harmonic by itself."""
    waves = waves_of(parameters)
    numbers = np.array(waves.numbers).reshape(-1, WAVE)
    w, parts = numbers[:, 0], numbers[:, 1:].reshape(-1, FREEDOMS, 2)
    angle = np.outer(w, waves.start + np.asarray(times))
    a, b = parts[..., 0].T, parts[..., 1].T
    places = a @ np.cos(angle) + b @ np.sin(angle)
    return places, (b * w) @ np.cos(angle) - (a * w) @ np.sin(angle)


@pytest.mark.parametrize("gamma", [1.0, 3.3])
def test_the_waves_have_the_variance_of_the_height_by_construction(gamma: float) -> None:
    sea = vehicle(AT_SEA | {"sea.peak_enhancement": gamma}).sea
    found = np.array(list(wave_components(sea)))
    assert len(found) == HARMONICS
    assert 0.5 * (found[:, 1] ** 2).sum() == pytest.approx(sea.wave_height**2 / 16.0, rel=1e-14)
    # band by band it is the integral of Pierson and Moskowitz's spectrum
    if gamma == 1.0:
        peak = 2.0 * pi / sea.peak_period
        edges = LOWEST + (HIGHEST - LOWEST) * np.arange(HARMONICS + 1) / HARMONICS
        below = np.exp(-1.25 / edges**4)
        share = np.diff(below) / (below[-1] - below[0])
        told = 0.5 * found[:, 1] ** 2 * 16.0 / sea.wave_height**2
        assert told == pytest.approx(share, abs=1e-7)
        assert (np.diff(found[:, 0] / peak) > 0.0).all()
        assert ((found[:, 0] / peak > edges[:-1]) & (found[:, 0] / peak < edges[1:])).all()


def test_random_numbers_are_those_of_numpy_s_philox() -> None:
    for key in (0, 7, 2**53 - 1):
        theirs = np.random.Generator(np.random.Philox(key=key)).random(150)
        assert uniform(key, 150) == theirs.tolist()


def test_the_motion_is_the_sum_of_its_harmonics_and_its_rates_are_its_derivatives() -> None:
    parameters = vehicle(AT_SEA)
    waves, times = waves_of(parameters), np.linspace(0.0, 40.0, 4001)
    rows = np.zeros((len(times), 2 * FREEDOMS))
    waves.kernel().places(times, len(times), rows.reshape(-1))
    places, rates = summed(parameters, times)
    assert pytest.approx(places, abs=1e-12) == rows[:, ::2].T
    assert pytest.approx(rates, abs=1e-12) == rows[:, 1::2].T
    # asked for in any order it is the same
    back = np.zeros_like(rows)
    waves.kernel().places(times[::-1].copy(), len(times), back.reshape(-1))
    assert np.array_equal(back[::-1], rows)


def test_a_small_barge_follows_the_surface_and_its_slope() -> None:
    small = {"sea.ship_length": 5.0, "sea.ship_beam": 2.0, "sea.ship_draught": 0.1}
    calm = {"sea.peak_period": 30.0, "sea.deck_x": 0.0, "sea.deck_y": 0.0, "sea.deck_z": 0.0}
    parameters = vehicle(AT_SEA | small | calm)
    times = np.linspace(0.0, 60.0, 61)
    w, a, phase = np.array(list(wave_components(parameters.sea))).T[..., None]
    angle = w * (waves_of(parameters).start + times) + phase
    k, towards = w * w / 9.80665, parameters.sea.direction
    height, slope = (a * np.cos(angle)).sum(axis=0), (a * k * np.sin(angle)).sum(axis=0)
    ahead = (a * np.sin(angle)).sum(axis=0)
    places, _ = summed(parameters, times)
    found = dict(zip(NAMES, places))
    size = 2.5
    assert found["heave"] == pytest.approx(height, abs=0.01 * size)
    assert found["surge"] == pytest.approx(cos(towards) * ahead, abs=0.01 * size)
    assert found["sway"] == pytest.approx(sin(towards) * ahead, abs=0.01 * size)
    # a surface that rises along +x turns the deck anticlockwise, along +z the same about -x
    steep = np.abs(slope).max()
    assert found["tilt"] == pytest.approx(-cos(towards) * slope, abs=0.02 * steep)
    assert found["roll"] == pytest.approx(-sin(towards) * slope, abs=0.02 * steep)


def test_the_deck_s_place_on_the_ship_turns_with_it() -> None:
    at_deck, at_ship = vehicle(AT_SEA), vehicle(AT_SEA | dict.fromkeys(list(SEA)[-3:], 0.0))
    times = np.linspace(0.0, 30.0, 31)
    (deck, _), (ship, _) = summed(at_deck, times), summed(at_ship, times)
    turn = np.array([ship[3], ship[4], -ship[5]]).T
    arm = np.array([SEA["sea.deck_x"], SEA["sea.deck_y"], SEA["sea.deck_z"]])
    assert deck[:3] == pytest.approx(ship[:3] + np.cross(turn, arm).T, abs=1e-12)
    assert deck[3:] == pytest.approx(ship[3:], abs=1e-15)


def test_a_table_gives_amplitude_and_lead_between_its_rows() -> None:
    text = operators_from_table(
        "\n".join(
            [
                f"frequency [Hz], direction [deg], {HEAD}",
                *(
                    f"{f}, {d}, 0.5, 90, {heave}, {lead}, 0, 0, 2, -90, 0, 0, 0, 0"
                    for d, heave in ((0.0, 1.0), (90.0, 0.6))
                    for f, lead in ((0.0, 0.0), (1.0, 60.0))
                ),
            ]
        ),
        "ship.csv",
    )
    values = AT_SEA | {"sea.operators": text, "sea.direction": pi / 4}
    values |= {"sea.deck_x": 0.0, "sea.deck_y": 0.0, "sea.deck_z": 0.0}
    parameters = vehicle(values)
    times = np.linspace(0.0, 20.0, 21)
    w, a, phase = np.array(list(wave_components(parameters.sea))).T[..., None]
    part = w / (2.0 * pi)
    lead = np.exp(1j * pi / 3.0)
    # half way between both directions, and so far between both frequencies
    heave = 0.8 * ((1.0 - part) + part * lead)
    angle = w * (waves_of(parameters).start + times) + phase
    places, _ = summed(parameters, times)
    assert places[1] == pytest.approx((a * heave * np.exp(1j * angle)).real.sum(axis=0), abs=1e-12)
    # a turn more is the same direction
    around = text.replace(f"directions 0.0 {pi / 2!r}", f"directions {-2 * pi!r} {-1.5 * pi!r}")
    assert around != text
    turned = vehicle(values | {"sea.operators": around})
    assert summed(turned, times)[0] == pytest.approx(places, abs=1e-12)
    assert places[0] == pytest.approx((-0.5 * a * np.sin(angle)).sum(axis=0), abs=1e-12)
    assert places[3] == pytest.approx((2.0 * pi / 180 * a * np.sin(angle)).sum(axis=0), abs=1e-12)


def test_the_vehicle_touches_the_deck_where_it_is_then() -> None:
    parameters = vehicle(AT_SEA | {"drop.contact_time": 0.3})
    landing = Landing(parameters)
    # the legs are elastic: their footpads hang by some micrometres
    before, after = 0.3 - 1e-5, 0.3 + 1e-5
    landing.advance_to(before)
    depths = [landing.get(f"leg[{leg}].contact.penetration") for leg in landing.interface.legs]
    assert -5e-5 < max(depths) < 0.0
    landing.advance_to(after)
    depths = [landing.get(f"leg[{leg}].contact.penetration") for leg in landing.interface.legs]
    assert 0.0 < max(depths) < 5e-5
    # another moment of the same sea: the record goes on
    moved = vehicle(AT_SEA | {"drop.contact_time": 0.3, "sea.time": 42.0})
    then, later = summed(parameters, [1.3])[0], summed(moved, [0.3])[0]
    assert then == pytest.approx(later, abs=1e-12)
    places = landing.ground_places()
    told = [places[f"ground.{name}"] for name in NAMES]
    assert told == pytest.approx(summed(parameters, [after])[0][:, 0], abs=1e-12)


def test_energy_is_balanced_by_the_deck_s_work_and_steps_change_no_digit() -> None:
    parameters = vehicle(AT_SEA)
    landing, stepped = Landing(parameters), Landing(parameters)
    landing.advance_to(1.0)
    for k in range(1, 98):
        stepped.advance_to(k / 97.0)
    assert stepped.values() == landing.values()
    now = landing.outputs()
    assert abs(now["energy.work_ground"]) > 0.1 * now["energy.dissipated"]
    assert abs(now["energy.balance"]) < 2e-5 * now["energy.dissipated"]
    assert landing.statistics["asleep"] == 0


def test_inputs_move_the_deck_on_top_of_the_sea() -> None:
    """A ship under way carries the vehicle with it, whose start moves as fast."""
    way = {"ground.surge_rate": 5.0, "ground.sway_rate": -2.0}
    moved = AT_SEA | {"drop.horizontal_velocity": 5.0, "drop.lateral_velocity": -2.0}
    at_rest = AT_SEA | {"drop.horizontal_velocity": 0.0, "drop.lateral_velocity": 0.0}
    still = Landing(vehicle(at_rest), rtol=1e-8)
    carried = Landing(vehicle(moved), rtol=1e-8, inputs=way)
    for landing in (still, carried):
        landing.advance_to(0.3)
    one, two = still.outputs(), carried.outputs()
    since = 0.3 - carried.parameters.drop.contact_time
    # at the contact the CG is above the inertial origin, the deck's origin is not
    assert two["body.vx"] - one["body.vx"] == pytest.approx(5.0, abs=1e-2)
    assert two["body.x"] - one["body.x"] == pytest.approx(5.0 * since, abs=1e-2)
    assert two["body.z"] - one["body.z"] == pytest.approx(-2.0 * since, abs=1e-2)


def test_one_harmonic_is_the_motion_that_fine_inputs_make() -> None:
    """Heave alone, by a table that answers one wave; the rate is linear between inputs."""
    base = AT_SEA | {"drop.contact_time": 0.0, "sea.deck_x": 0.0, "sea.direction": 0.0}
    w, a, phase = list(wave_components(vehicle(base).sea))[20]
    # none of its neighbours is so near
    text = operators_from_table(table([0.0, w - 1e-6, w, w + 1e-6, 9.0], [0, 0, 1, 0, 0]), "one")
    parameters = vehicle(base | {"sea.operators": text})
    assert np.count_nonzero(np.ptp(summed(parameters, np.linspace(0, 9, 50))[0], axis=1)) == 1
    landing = Landing(parameters, rtol=1e-8)
    until = 0.24
    landing.advance_to(until)
    start = waves_of(parameters).start

    def rate(t: float) -> float:
        return -a * w * sin(w * (start + t) + phase)

    calm = vehicle(base | {"sea.wave_height": 0.0})
    heave = a * cos(w * start + phase)
    away = []
    for step in (0.04, 0.02):
        driven = Landing(calm, rtol=1e-8, inputs={"ground.heave": heave})
        for k in range(round(until / step)):
            now, then = rate(k * step), rate((k + 1) * step)
            driven.set_inputs(
                {"ground.heave_rate": now}, {"ground.heave_rate": (then - now) / step}
            )
            driven.advance_to((k + 1) * step)
        away.append(abs(driven.get("body.y") - landing.get("body.y")))
    assert away[0] < 1e-4
    assert away[1] < 0.3 * away[0]


def test_it_settles_rather_than_stands_and_slides_by_what_it_slides_on_the_deck() -> None:
    upright = {"drop.tilt": 0.0, "drop.pitch_rate": 0.0, "drop.horizontal_velocity": 0.0}
    values = SPACE | SEA | {"sea.deck_x": 0.0, "drop.contact_time": 0.0, **upright}
    values |= {"ground.friction": 1.0, "drop.vertical_velocity": -2.5, "sea.wave_height": 4.0}
    landing = Landing(vehicle(values), rtol=1e-4)
    history = whole_landing(landing, until=6.0, every=5e-3, standing=True)
    assert history.time[-1] == pytest.approx(6.0)
    found = outcome(history)
    assert found.name == "settled"
    # the deck moves by much more
    way = np.ptp(summed(landing.parameters, history.time)[0][:3], axis=1)
    assert way.max() > 0.25
    calm = whole_landing(Landing(vehicle(values | {"sea.wave_height": 0.0}), rtol=1e-4), every=5e-3)
    assert found.margins["slid"] < outcome(calm).margins["slid"] + 0.05


def test_a_file_names_a_table_and_all_digits_are_kept(tmp_path: Path) -> None:
    (tmp_path / "ship.csv").write_text(table([0.1, 1.0, 3.0], [1.0, 0.7, 0.0], 180.0))
    text = '[drop]\nmode = "space"\n[sea]\nwave_height = "150 cm"\noperators = "ship.csv"\n'
    text += 'direction = "180 deg"\nseed = 12\n'
    parameters = parse_toml(text, "mine.toml", tmp_path)
    assert parameters.sea.wave_height == 1.5
    again = parse_toml(to_toml(parameters), "again")
    assert again.sea == parameters.sea
    assert Landing(again).values() == Landing(parameters).values()


def test_moments_and_seeds_of_a_sea_are_what_a_study_may_vary() -> None:
    upright = vehicle(SPACE | SEA | {"drop.contact_time": 0.0, "drop.vertical_velocity": -2.5})
    states = {"sea.time": [5.0, 6.0, 5.0, 5.0], "sea.seed": [1.0, 1.0, 2.0, 1.9]}
    found = land_many(upright, states, until=0.1)
    assert found.errors == (None,) * 4
    loads = found["legs.main_strut.force.min"]
    # of a seed the whole part counts
    assert len(set(loads)) == 3
    assert loads[0] == loads[3]
    first = upright.with_values({"sea.time": 5.0, "sea.seed": 1.0})
    landing = Landing(first, rtol=1e-4)
    landing.advance_to(0.1)
    forces = [landing.extremes()[f"leg[{leg}].main_strut.force"].minimum for leg in (1, 2, 3, 4)]
    assert loads[0] == pytest.approx(min(forces), rel=1e-3)


GOOD = table([0.1, 1.0, 3.0], [1.0, 0.7, 0.0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD.replace("1.0, 0.0, 0.0, 0.0, 0.7", "0.05, 0.0, 0.0, 0.0, 0.7"), "frequencies do not"),
        (GOOD.replace("0.7", "", 1), "has a hole for heave"),
        (GOOD.replace("0.7", "nan", 1), "heave = nan is not finite"),
        (GOOD.replace("0.7", "-0.7", 1), "heave of amplitude -0.7"),
        (GOOD.replace("0.7", "x", 1), "has 'x' for heave"),
        (GOOD.replace("heave [m/m]", "heave [deg/m]"), "has no unit of its kind; write heave"),
        (GOOD.replace("frequency [rad/s]", "frequency"), "has no unit of its kind"),
        (GOOD.replace("frequency [rad/s]", "frequency [s]"), r"frequency \[rad/s\] or \[Hz\]"),
        (GOOD.replace("yaw phase", "yaw lag"), "has a column 'yaw lag'"),
        (GOOD.replace("1.0, 0.0, 0.0", "1.0, 0.0", 1), "13 values under 14 headings"),
        (GOOD + "\n0.1" + GOOD.splitlines()[1][3:].replace("0.0", "10.0", 1), "has 4 rows for 3"),
        (GOOD + "\n0.2" + GOOD.splitlines()[1][3:].replace("0.0", "10.0", 1), "not the next"),
        ("frequency [rad/s]", "no rows of operators"),
    ],
)
def test_what_is_no_table_is_refused(text: str, message: str) -> None:
    with pytest.raises(LandingError, match=message) as caught:
        operators_from_table(text, "ship.csv")
    assert "ship.csv" in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"sea.wave_height": -1.0}, r"sea\.wave_height = -1 m is outside"),
        ({"sea.peak_period": 0.0}, r"sea\.peak_period = 0 s is outside"),
        ({"sea.wave_height": 5.0, "sea.peak_period": 5.0}, "steepness of 0.128, the limit is"),
        ({"sea.operators": "ship.csv"}, "is no table of operators; name its file"),
        ({"sea.operators": operators_from_table(GOOD, "g")}, r"sea\.direction = 40\.107"),
        (
            {"sea.operators": operators_from_table(GOOD, "g"), "sea.peak_period": 6.0},
            "has frequencies from 0.1 to 3 rad/s; the sea has waves",
        ),
        ({"drop.mode": "2-2"}, r"needs drop\.mode = space"),
    ],
)
def test_what_is_no_sea_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(LandingError, match=message):
        vehicle(SPACE | SEA | values)


def test_a_deck_that_turns_over_is_refused() -> None:
    wild = GOOD.replace("roll [deg/m]", "roll [rad/m]").replace(
        "0.7, 0.0, 0.0, 0.0, 0.0", "0.7, 0.0, 0.0, 0.0, 0.9"
    )
    text = operators_from_table(wild, "wild.csv")
    parameters = vehicle(AT_SEA | {"sea.operators": text, "sea.direction": 0.0})
    with pytest.raises(LandingError, match="the deck's roll has a significant amplitude"):
        Landing(parameters)
