"""examples/ship_deck: as a user runs it, and the mechanics of a landing on a deck that moves."""

import re
from math import pi

import numpy as np
import pytest
import system
from fmpy.validation import validate_fmu
from master import simulate
from matplotlib.image import imread
from pyssp_standard.ssp import SSP
from pytest import approx

LEGS = (1, 2, 3, 4)
WEIGHT = (178.0 + 4 * 4.2) * 9.81
NO_ENGINE = {"thrust": 0.0}
AT_REST = {"heave_amplitude": 0.0, "tilt_amplitude": 0.0}


def run(fmus, until, landing=system.DROP, deck=AT_REST, engine=NO_ENGINE):
    return simulate(
        fmus, system.CONNECTIONS, {"landing": landing, "deck": deck, "engine": engine}, until=until
    )


def normal_forces(result):
    return np.array([result[f"landing.leg[{leg}].contact.force_y"] for leg in LEGS])


def test_command_writes_fmus_system_results_and_picture_and_says_what_happened(ran):
    out, output = ran
    files = {"ShipDeck.fmu", "EngineTailOff.fmu", "calm.ssp", "moving.ssp", "ship_deck.png"}
    assert {p.name for p in out.iterdir()} == files | {
        f"{d}-{i}.csv" for d in ("calm", "moving") for i in ("fmpy", "ecos")
    }
    assert imread(out / "ship_deck.png").shape[0] > 500
    touched = {
        name: float(time) for name, time in re.findall(r"(\w+) deck: touches at ([\d.]+) s", output)
    }
    assert touched["moving"] < touched["calm"], "the deck rises towards the vehicle"


@pytest.mark.parametrize("deck", ["calm", "moving"])
def test_ecos_gives_the_python_masters_trajectory_from_the_ssp_file(ran, deck):
    """To 1e-9 of every output's largest value.

    Both are Jacobi masters with the same communication points.
    """
    out, _ = ran
    ours, theirs = (
        np.genfromtxt(out / f"{deck}-{i}.csv", delimiter=",", names=True, deletechars="")
        for i in ("fmpy", "ecos")
    )
    assert len(ours) == 1001
    assert len(ours.dtype.names) == len(theirs.dtype.names) > 90
    for name in ours.dtype.names:
        assert np.abs(ours[name] - theirs[name]).max() <= 1e-9 * np.abs(ours[name]).max(), name


def test_ecos_command_line_a_cpp_program_runs_the_same_system(ran, simulated_by_ecos):
    """Three FMUs made with Python in a program without; it writes six decimals."""
    out, _ = ran
    ours = np.genfromtxt(out / "moving-fmpy.csv", delimiter=",", names=True, deletechars="")
    theirs = simulated_by_ecos(
        out / "moving.ssp", "--stopTime", "1.0005", "--parameterSet", "start"
    )
    assert len(theirs) == len(ours)
    for name in ours.dtype.names[1:]:
        component, output = name.split(".", 1)
        difference = np.abs(ours[name] - theirs[f"{component}::{output}[REAL]"]).max()
        assert difference <= 1e-9 * np.abs(ours[name]).max() + 5.01e-7, name


@pytest.mark.parametrize("deck", ["calm", "moving"])
def test_ssp_file_is_valid_and_its_connections_are_those_of_the_system(ran, deck):
    """By the schema of SSP 1.0, and read by a library that did not write it."""
    out, _ = ran
    with SSP(out / f"{deck}.ssp", mode="r") as archive, archive.system_structure as structure:
        structure.__check_compliance__()
        read = {
            ((c.start_element, c.start_connector), (c.end_element, c.end_connector))
            for c in structure.connections()
        }
        assert read == set(system.CONNECTIONS.items())
        assert structure.check_connections(unconnected_inputs=True) == []
        assert {component.name: component.source for component in structure.system.elements} == {
            "landing": "resources/RlvLanding.fmu",
            "deck": "resources/ShipDeck.fmu",
            "engine": "resources/EngineTailOff.fmu",
        }  # fmt: skip


@pytest.mark.parametrize("component", ["deck", "engine"])
def test_the_examples_own_fmus_are_valid_and_all_their_variables_have_units(fmus, component):
    import fmpy

    assert validate_fmu(str(fmus[component])) == []
    assert all(v.unit for v in fmpy.read_model_description(str(fmus[component])).modelVariables)


def test_deck_starts_at_rest_and_its_rates_are_those_of_its_positions(fmus):
    result = run(fmus, 1.0, deck={"heave_phase": 1.0, "tilt_phase": -0.5})
    for name in ("heave", "tilt"):
        value, rate = result[f"deck.{name}"], result[f"deck.{name}_rate"]
        assert value[0] == rate[0] == 0.0
        # the acceleration jumps at the end of the fade, which a difference over 2 ms sees by half
        # its step
        assert (
            np.abs(np.gradient(value, 1e-3)[1:-1] - rate[1:-1]).max() <= 2e-3 * np.abs(rate).max()
        )


def test_only_the_speed_relative_to_the_deck_counts(fmus):
    """A deck that rises at 0.3 m/s is a deck at rest for a vehicle that falls 0.3 m/s faster.

    The deck is 1 s of a wave of 400 s: steady within 1.3e-4 of its speed.
    """
    rise = 0.3
    speed = system.DROP["drop.vertical_velocity"]
    drop = {**system.DROP, "drop.vertical_velocity": speed - rise}
    moving = run(
        fmus,
        1.0,
        deck={
            **AT_REST,
            "heave_amplitude": rise * 400.0 / (2.0 * pi),
            "heave_period": 400.0,
            "start_up": 0.0,
        },
    )
    resting, slower = run(fmus, 1.0, landing=drop), run(fmus, 1.0)
    assert (
        np.abs(moving["landing.body.y"] - moving["deck.heave"] - resting["landing.body.y"]).max()
        < 1e-5
    )
    for leg in (1, 3):
        for quantity in (
            "main_strut.stroke",
            "main_strut.pressure_lower",
            "auxiliary_strut.force",
            "contact.force_y",
        ):
            name = f"landing.leg[{leg}].{quantity}"
            assert moving[name].max() == approx(resting[name].max(), rel=1e-3), name
    hits = [normal_forces(result).max(axis=0) for result in (moving, resting, slower)]
    # each touches its deck at drop.contact_time, after step 200
    assert [int(np.argmax(hit > 0.0)) for hit in hits] == [200, 200, 200]
    assert hits[0].max() > 1.03 * hits[2].max()


def test_a_vehicle_that_stands_goes_with_the_deck(fmus):
    """At the end, height above the deck, speed and pitch are the deck's.

    The tolerance is what struts and friction give under 4 % of g.
    """
    result = run(fmus, 5.0, deck={}, engine={})
    standing = result["time"] > 2.5
    end = {name: values[standing] for name, values in result.items()}
    assert np.ptp(end["deck.heave"]) > 0.2
    deck_below = end["deck.heave"] - end["landing.body.x"] * np.tan(end["deck.tilt"])
    assert np.ptp(end["landing.body.y"] - deck_below) < 5e-3
    assert (
        np.abs(end["landing.body.vy"] - end["deck.heave_rate"]).max()
        < 0.03 * np.abs(end["deck.heave_rate"]).max()
    )
    assert (
        np.abs(end["landing.body.pitch"] - end["deck.tilt"]).max()
        < 0.2 * np.abs(end["deck.tilt"]).max()
    )
    assert np.abs(end["landing.energy.balance"]).max() < 1e-3
    assert normal_forces(end).sum(axis=0) == approx(np.full(standing.sum(), WEIGHT), rel=0.05)


def test_thrust_and_tail_off_do_the_work_that_the_energy_outputs_say(fmus):
    """Force times way of every step, force held: that is `energy.work_external`.

    In the flight, impulse less weight is momentum.
    """
    result = run(fmus, 1.0, engine={"direction": 0.05, "arm": 0.02})
    ways = {"force_x": "body.x", "force_y": "body.y", "moment": "body.pitch"}
    steps = sum(
        result[f"engine.{load}"][:-1] * np.diff(result[f"landing.{way}"])
        for load, way in ways.items()
    )
    booked = result["landing.energy.work_external"]
    assert np.abs(np.cumsum(steps) - booked[1:]).max() <= 1e-6 * np.abs(booked).max()
    time, thrust, speed = result["time"], result["engine.force_y"], result["landing.body.vy"]
    tail_off = time >= 0.3
    impulse = np.sum(0.5 * (thrust[tail_off][1:] + thrust[tail_off][:-1])) * 1e-3
    assert impulse == approx(1700.0 * 0.08 * np.cos(0.05), rel=1e-3)
    landed = int(np.argmax(normal_forces(result).max(axis=0) > 0.0)) - 1
    assert landed > 450, "most of the tail-off is in the flight"
    momentum = WEIGHT / 9.81 * (speed[landed] - speed[0])
    assert momentum == approx(np.sum(thrust[:landed]) * 1e-3 - WEIGHT * time[landed], rel=1e-3)
