"""The audit of a landing in space: it keeps every bound, and misses them where it is not right."""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest
from five_legs import five_legs

from rlv_landing import Landing, Parameters, load_preset
from rlv_landing.audit.audit import Audit
from rlv_landing.audit.bounds import BOUNDS
from rlv_landing.audit.cases import cases, mass
from rlv_landing.audit.energy import energy
from rlv_landing.audit.momentum import contact, flight
from rlv_landing.audit.rest import rest
from rlv_landing.audit.spatial_momentum import spatial_impulse, spatial_momentum
from rlv_landing.history import History
from rlv_landing.tables.study_tables import audit_tables

END = 0.5


@pytest.fixture(scope="module")
def vehicle() -> Parameters:
    return five_legs()


@pytest.fixture(scope="module")
def history(vehicle: Parameters) -> History:
    return Landing(vehicle, rtol=1e-8).run(END, 2e-5)


def test_energy_mass_momentum_and_rest_of_five_legs_keep_their_bounds(vehicle: Parameters) -> None:
    assert mass(vehicle) == pytest.approx(178.0 + 4 * 4.2 + 4.8, rel=1e-12)
    as_it_is = cases(vehicle)[0]
    state, at_rest = rest(as_it_is)
    checks = [*energy(as_it_is, END)[1], *at_rest, *flight(vehicle), *contact(vehicle, END)]
    assert [c.id for c in checks if not c.passed] == []
    assert all(c.applies for c in checks)
    left = {"smooth_error", "smooth_slope", "contacts_error", "contacts_force"}
    assert {c.id for c in checks} == set(BOUNDS) - left
    assert {f"stroke_{leg}" for leg in range(1, 6)} <= state.keys()


def test_what_settles_shortly_before_the_end_may_decay_before_its_drift_is_measured() -> None:
    changed = {"drop.heading": radians(20.0), "drop.roll": radians(1.0)}
    three = load_preset("yue2022-figures").with_values(
        {"drop.mode": "space", "vehicle.legs": 3.0, "drop.lateral_velocity": 0.2, **changed}
    )
    loaded = cases(three)[-1]
    state, checks = rest(loaded)
    assert 5.0 < state["settled_since"] - three.drop.contact_time < 10.0
    assert [c.id for c in checks if not c.passed] == []


def test_struts_without_liquid_keep_the_bound_on_its_mass() -> None:
    lander = Path(__file__).parents[2] / "examples" / "tripod_lander.toml"
    checks = energy(cases(Landing.from_toml(lander).parameters)[0], END)[1]
    assert [c.id for c in checks if not c.passed] == []
    assert {c.id: c.value for c in checks}["liquid_mass"] == 0.0


@pytest.mark.parametrize("legs", [3, 8])
def test_the_tables_name_the_stroke_of_every_leg(legs: int) -> None:
    strokes = {f"stroke_{leg}": leg / 1e3 for leg in range(1, legs + 1)}
    rest_state = {"settled_since": 1.0, "pitch": 0.0, "stability_margin": 1.0, **strokes}
    printed = audit_tables([Audit("space", "as it is", (), {}, rest_state)])
    assert f"strokes {', '.join(f'{leg}.00' for leg in range(1, legs + 1))} mm" in printed


@pytest.mark.parametrize(
    ("name", "factor", "part"),
    [
        ("vehicle.mass", 1.05, "linear"),
        ("vehicle.footpad_mass", 1.2, "linear"),
        ("vehicle.inertia_yaw", 1.1, "about_origin"),
        ("vehicle.inertia_xy", 0.0, "about_origin"),
        ("ground.gravity", 0.99, "linear"),
    ],
)
def test_the_momentum_of_another_vehicle_is_not_that_of_its_loads(
    vehicle: Parameters, history: History, name: str, factor: float, part: str
) -> None:
    def left(parameters: Parameters) -> float:
        found = getattr(spatial_momentum(history, parameters), part)
        given = getattr(spatial_impulse(history, parameters), part)
        return abs(found - found[0] - given).max() / abs(found - found[0]).max()

    # without the finer samples at contacts that the audit takes
    assert left(vehicle) < 5e-4
    other = vehicle.with_values({name: vehicle[name] * factor})
    assert left(other) > 5.0 * left(vehicle)


def test_the_command_audits_space_alone_and_the_paper_is_no_landing_in_space(
    command, vehicle: Parameters, monkeypatch: pytest.MonkeyPatch, tmp_path
) -> None:
    from rlv_landing.audit import audit as module
    from rlv_landing.presets import to_toml

    file = tmp_path / "five.toml"
    file.write_text(to_toml(vehicle))
    audited: list[str] = []
    whole = module._audit_mode
    monkeypatch.setattr(
        module, "_audit_mode", lambda own: (audited.append(own.drop.mode), whole(own))[1]
    )
    done = command("audit", "--parameters", str(file))
    assert (done.code, audited) == (0, ["space"])
    assert "space, slope of 5 deg: audit" in done.out
    done = command("validate", "--parameters", str(file))
    assert done.code == 2
    assert "this needs a symmetric landing; choose 2-2 or 1-2-1" in done.err
    assert done.err.count("\n") == 1
