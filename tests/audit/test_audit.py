"""The audit: its result on the preset, the faults that it detects, and its account of momentum."""

from __future__ import annotations

import json

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.audit.bounds import BOUNDS
from rlv_landing.audit.cases import cases
from rlv_landing.audit.convergence import smooth_arc
from rlv_landing.audit.energy import DISSIPATED, HELD, SUPPLIED
from rlv_landing.audit.momentum import impulse, momentum
from rlv_landing.audit.rest import rest
from rlv_landing.history import History

FIGURES = "yue2022-figures"
FOOTPAD = "vehicle.transverse_load_at=footpad"
LEGS = (1, 2, 3, 4)


def test_the_preset_keeps_every_bound_and_every_bound_has_a_reason(every_audit, audits, mode):
    cases = [a for a in every_audit if a.mode == mode]
    assert [a.case for a in cases] == [
        "as it is",
        "slope of 5 deg",
        "side load of a tenth of the weight",
    ]
    assert [a.missed for a in cases] == [[], [], []]
    assert all(c.applies for a in cases for c in a.checks)
    assert {c.id for c in audits[mode].checks} == set(BOUNDS)
    assert all(b.reason for b in BOUNDS.values())


def test_the_energy_table_has_every_term_of_the_balance(audits, mode):
    energy = audits[mode].energy
    assert tuple(energy) == HELD + DISSIPATED + SUPPLIED
    ends = {t: end - start for t, (start, end) in energy.items()}
    held = sum(ends[t] for t in HELD + DISSIPATED) - sum(ends[t] for t in SUPPLIED)
    assert held == approx(0.0, abs=1e-5 * sum(ends[t] for t in DISSIPATED))


def test_error_is_in_proportion_to_tolerance_on_the_smooth_arc_and_larger_across_contacts(
    audits, mode
):
    found = audits[mode].convergence
    assert 0.5 < found.smooth_slope < 1.2
    assert [e.rtol for e in found.smooth] == [e.rtol for e in found.contacts]
    for smooth, contacts in zip(found.smooth[1:], found.contacts[1:]):
        assert smooth.worst < contacts.worst
    assert all(a.steps <= b.steps for a, b in zip(found.contacts, found.contacts[1:]))


def test_the_smooth_arc_is_in_contact_and_free_of_events():
    history = Landing(load_preset(FIGURES)).run(1.0, 1e-4)
    start, end = smooth_arc(history)
    inside = (history.time >= start) & (history.time <= end)
    assert inside.sum() > 100
    for leg in LEGS:
        assert np.ptp(history[f"leg[{leg}].contact.active"][inside]) == 0.0
    assert max(history[f"leg[{leg}].contact.active"][inside].min() for leg in LEGS) == 1.0


def test_momentum_is_the_rate_of_the_mass_points_own_positions(mode):
    """Central differences of sum(m x), sum(m y), and of each point's position."""
    parameters = load_preset(FIGURES, mode)
    landing = Landing(parameters, rtol=1e-10)
    landing.advance_to(0.3)
    step = 1e-6
    history = landing.run(0.3 + 40 * step, step)
    found = momentum(history, parameters)
    v = parameters.vehicle
    points = [(v.mass, history["body.x"], history["body.y"])]
    points += [
        (v.footpad_mass, history[f"leg[{leg}].footpad.x"], history[f"leg[{leg}].footpad.y"])
        for leg in LEGS
    ]
    rates = [(m, x, y, np.gradient(x, step), np.gradient(y, step)) for m, x, y in points]
    inner = slice(2, -2)
    assert found.x[inner] == approx(
        sum(m * vx for m, _, _, vx, _ in rates)[inner], rel=1e-6, abs=1e-4
    )
    assert found.y[inner] == approx(
        sum(m * vy for m, _, _, _, vy in rates)[inner], rel=1e-6, abs=1e-4
    )
    turning = sum(m * (y * vx - x * vy) for m, x, y, vx, vy in rates) + v.inertia * np.gradient(
        history["body.pitch"], step
    )
    assert found.about_origin[inner] == approx(turning[inner], rel=1e-6, abs=1e-4)


def test_a_contact_force_that_is_1_per_cent_wrong_does_not_pass_the_momentum_audit():
    parameters = load_preset(FIGURES)
    history = Landing(parameters, rtol=1e-8).run(0.6, 2e-5)

    def left(h: History) -> float:
        found, given = momentum(h, parameters), impulse(h, parameters)
        return float(np.abs(found.x - found.x[0] - given.x).max() / np.ptp(found.x))

    assert left(history) < BOUNDS["momentum_x"].limit
    wrong = History(history.time, history.names, history.data.copy())
    wrong.data[:, history.names.index("leg[1].contact.force_x")] *= 1.01
    assert left(wrong) > 10.0 * BOUNDS["momentum_x"].limit


def test_the_joint_is_reported_to_drop_angular_momentum_and_not_held_to_it(command):
    done = command(
        "audit", FIGURES, "--mode", "2-2", "--set", "vehicle.transverse_load_at=joint", "--json"
    )
    assert done.code == 0, done.err
    found, *_ = json.loads(done.out)["audits"]
    checks = {c["id"]: c for c in found["checks"]}
    assert not checks["angular"]["applies"]
    assert checks["angular"]["value"] > 1e-2
    assert checks["momentum_x"]["passed"]
    assert found["energy"]["work_transverse"]["end"] != 0.0


def test_a_vehicle_that_topples_fails_the_audit_with_a_line_and_exit_code_1(command):
    done = command(
        "audit", "--mode", "2-2", "--set", "drop.pitch_rate=6", "--set", "drop.contact_time=0"
    )
    assert done.code == 1
    assert "missed: 2-2: settled 10 s after first contact, 60 s where it rocks" in done.err
    assert "MISSED" in done.out


def test_any_parameter_file_can_be_audited(command, tmp_path):
    (tmp_path / "mine.toml").write_text(
        'preset = "yue2022-table2"\n[vehicle]\nmass = "150 kg"\n[ground]\nslope = "-2 deg"\n'
    )
    done = command(
        "audit", "--parameters", str(tmp_path / "mine.toml"), "--mode", "1-2-1", "--json"
    )
    assert done.code == 0, done.err
    record = json.loads(done.out)
    assert record["passed"]
    assert record["parameters"] == "mine.toml"
    assert [a["mode"] for a in record["audits"]] == ["1-2-1"] * 3


def test_the_papers_friction_is_reported_to_supply_energy_and_to_creep(command):
    done = command("audit", "--mode", "2-2", "--set", "ground.friction_law=paper", "--set", FOOTPAD)
    assert done.code == 1
    missed = [line for line in done.err.splitlines() if line.startswith("missed: ")]
    fall = "fall of any account of dissipated energy"
    for case in ("2-2", "2-2, slope of 5 deg", "2-2, side load of a tenth of the weight"):
        assert any(line.startswith(f"missed: {case}: {fall}") for line in missed)
    assert any("slope of 5 deg: drift of a footpad" in line for line in missed)


def test_what_friction_cannot_hold_is_not_asked_to_rest(command):
    done = command("audit", "--mode", "2-2", "--set", "ground.friction=0.05", "--json")
    cases = {a["case"]: a for a in json.loads(done.out)["audits"]}
    asked = {
        name: {c["id"] for c in a["checks"] if c["applies"]} & {"rest_drift", "rest_phase"}
        for name, a in cases.items()
    }
    assert len(asked["as it is"]) == 2
    assert asked["slope of 5 deg"] == asked["side load of a tenth of the weight"] == set()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("yue2022-figure",), "did you mean yue2022-figures?"),
        (("yue2022-figures", "--preset", "yue2022-table2"), "named twice"),
        (("yue2022-figures", "--parameters", "x.toml"), "not both"),
        (("--mode", "4"), "unknown landing mode '4'"),
    ],
)
def test_bad_input_is_one_clear_line_and_exit_code_2(command, arguments, message):
    done = command("audit", *arguments)
    assert done.code == 2
    assert message in done.err
    assert len(done.err.strip().splitlines()) == 1


def test_momentum_needs_a_landings_own_columns():
    with pytest.raises(LandingError, match="unknown column"):
        momentum(History(np.zeros(2), ["body.x"], np.zeros((2, 1))), load_preset(FIGURES))


def test_a_vehicle_that_rocks_for_longer_than_10_s_is_given_the_time_to_rest():
    slow = load_preset(FIGURES, "2-2").with_values({"vehicle.inertia": 1500.0})
    state, checks = rest(cases(slow)[0])
    assert 10.2 < state["settled_since"] < 30.0
    assert [c.id for c in checks if not c.passed] == []
