"""Identification of vehicles of other sizes: priors follow them, and their own data are fitted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from pytest import approx
from scaled import scaled

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.priors import PRIORS
from rlv_landing.identification.vehicle_priors import following
from rlv_landing.parameters import PARAMETER_QUANTITIES, Parameters
from rlv_landing.presets import read_toml, to_toml
from rlv_landing.studies.sweep.responses import Measure
from rlv_landing.studies.whole_landing import whole_landing

HOPPER, STAGE = 60.0, 25_000.0
ORIFICE, FRICTION = "main_strut.orifice_area_compression", "ground.friction"
CURVES = ("leg[1].main_strut.stroke", "leg[3].main_strut.force")
RESPONSES = ("leg[1].main_strut.force.min", "leg[3].main_strut.stroke.max", "leg[3].contact.time")
SEARCH = ("--population", "8", "--evaluations", "100", "--polish", "50", "--sigma", "0.2")


def vehicle(mass: float) -> Parameters:
    """The prototype without play, scaled."""
    none = {name: 0.0 for name, _ in Parameters().items() if "strut.play_" in name}
    return scaled(load_preset("yue2022-figures").with_values(none), mass)


def truth(mass: float) -> dict[str, float]:
    """Numbers well away from those with which the search starts."""
    return {ORIFICE: 1.5 * vehicle(mass).main_strut.orifice_area_compression, FRICTION: 0.22}


@pytest.mark.parametrize("mass", [5.0, HOPPER, STAGE, 8e4])
def test_priors_of_another_vehicle_hold_its_own_start(mass):
    """No number is moved to a bound, and each can move both ways."""
    base = vehicle(mass)
    numbers = FreeNumbers(base)
    assert numbers.outside == []
    assert numbers.numbers(numbers.start()) == approx(numbers.starts(), rel=1e-9)
    assert all(0.0 < z < 1.0 for z in numbers.start())
    # play of 0 has no size to follow
    left_out = {p.name for p in PRIORS} - {p.name for p, _ in numbers.columns}
    assert left_out == {n for n, _ in base.items() if "strut.play_" in n}
    for prior, _ in numbers.columns:
        q = PARAMETER_QUANTITIES.get(prior.name)
        assert prior.lo < prior.hi
        assert q is None or q.lo <= prior.lo <= prior.hi <= q.hi


@given(st.sampled_from(PRIORS), st.floats(1e-3, 1e3))
def test_bounds_that_follow_a_start_hold_it_and_are_as_wide_as_the_prototypes(prior, factor):
    """As a ratio where numbers grow with a vehicle, and at least by width for touchdown states."""
    start = factor * (prior.lo if prior.by_mode else prior.hi)
    q = PARAMETER_QUANTITIES.get(prior.name)
    assume(q is None or q.lo <= start <= q.hi)
    found = following(prior, start)
    assert found is not None
    assert found.lo <= start <= found.hi
    assert found.lo < found.hi
    if q is not None and (found.lo == q.lo or found.hi == q.hi):
        return
    if prior.by_mode:
        assert found.hi - found.lo >= (prior.hi - prior.lo) * (1.0 - 1e-9)
    elif prior.lo > 0.0:
        assert found.hi / found.lo == approx(prior.hi / prior.lo)


def test_priors_of_the_papers_vehicle_are_the_papers():
    columns = FreeNumbers(load_preset("yue2022-figures")).columns
    assert {p for p, _ in columns} == set(PRIORS)


def test_a_number_without_size_is_free_only_with_bounds():
    base = vehicle(HOPPER)
    with pytest.raises(LandingError, match=r"give them: --bound auxiliary_strut\.play_tension=LO"):
        FreeNumbers(base, ["auxiliary_strut.play_tension"])
    bounds = {"auxiliary_strut.play_tension": (0.0, 1e-3)}
    assert FreeNumbers(base, list(bounds), bounds).start() == [0.0]


@pytest.mark.parametrize(
    ("name", "value"),
    [("ground.friction", 0.7), ("vehicle.inertia", 400.0), ("main_strut.volume_upper", 1e-5)],
)
def test_a_users_start_outside_the_papers_priors_is_refused_with_the_remedy(name, value):
    base = load_preset("yue2022-figures").with_values({name: value})
    with pytest.raises(LandingError, match=f"{name} = {value:g}.* is outside its prior") as refused:
        FreeNumbers(base)
    assert len(str(refused.value)) < 300
    remedy = str(refused.value).partition(f"--bound {name}=")[2].split("..")
    numbers = FreeNumbers(base, [name], {name: (float(remedy[0]), float(remedy[1]))})
    assert numbers.outside == []
    assert numbers.numbers(numbers.start()) == approx([value])


def test_a_start_that_one_mode_has_outside_is_refused_by_mode():
    base = load_preset("yue2022-figures").with_mode_values({"1-2-1": {"drop.tilt": -0.4}})
    with pytest.raises(LandingError, match=r"drop.tilt = -0.4 rad in 1-2-1 is outside its prior"):
        FreeNumbers(base)
    assert "2-2: drop.tilt" in FreeNumbers(base, modes=["2-2"]).labels


@pytest.fixture(scope="module", params=[HOPPER, STAGE], ids=["hopper", "stage"])
def mass(request: pytest.FixtureRequest) -> float:
    return float(request.param)


@pytest.fixture(scope="module")
def landed(mass: float) -> History:
    """The landing whose numbers are to be found."""
    landing = Landing(vehicle(mass).with_values(truth(mass)), "2-2")
    return whole_landing(landing, every=2e-4)


def test_numbers_of_another_vehicle_are_found_from_its_curves_and_scalars(
    command, mass, landed, tmp_path, monkeypatch
):
    """Curves have times in ms and forces in kN; scalars are responses, in the user's units."""
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(to_toml(vehicle(mass)))
    rows = np.column_stack([1e3 * landed.time, *(landed[c] for c in CURVES)])[:3000:5]
    rows[:, 2] *= 1e-3
    heading = f"time [ms],{CURVES[0]} [m],{CURVES[1]} [kN]"
    np.savetxt("curves.csv", rows, delimiter=",", header=heading, comments="", fmt="%.12g")
    force, stroke, time = Measure(RESPONSES)(landed, 0)
    Path("targets.csv").write_text(
        "id,value,unit,mode,weight\n"
        f"{RESPONSES[0]},{force / 1e3!r},kN,2-2,1\n"
        f"{RESPONSES[1]},{stroke * 1e3!r},mm,2-2,0.5\n"
        f"{RESPONSES[2]},{time!r},s,2-2,\n"
    )
    data = ("--targets", "targets.csv", "--series", "2-2=curves.csv")
    done = command(
        "identify", "--parameters", "mine.toml", *data, "--free", ",".join(truth(mass)), *SEARCH
    )
    assert done.code == 0, done.err
    assert done.err == ""
    found = read_toml("identification/identified.toml")
    for name, value in truth(mass).items():
        assert found[name] == approx(value, rel=0.02)
        assert found.source(name) == "identified"
    assert found["vehicle.mass"] == vehicle(mass).vehicle.mass
    assert "scalars within 5 / 10 / 20 %: 3 / 3 / 3 of 3\n" in done.out
    report = Path("identification/report.md").read_text()
    for name in CURVES:
        assert f"| 2-2: {name} | " in report
        assert f"2-2: {name}: RMS " in done.out
    for name in RESPONSES:
        assert f"| 2-2: {name} | " in report
    assert "Prediction" not in report
    assert "22-" not in report
