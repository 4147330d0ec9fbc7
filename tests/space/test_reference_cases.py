"""A three-legged landing in space against two engines that share no code with this one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from space_vehicles import THREE_LEGS, vehicle

from rlv_landing import Landing

CASES = json.loads((Path(__file__).parent / "cases" / "three_legs.json").read_text())
# of a strut: its output, and whether the reference's sense is the opposite
STRUTS = {
    "main": ("main_strut.force", True),
    "aux": ("auxiliary_strut.force", True),
    "stroke": ("main_strut.stroke", False),
}


def landed(values: dict[str, Any], case: dict[str, Any], rtol: float) -> tuple[Landing, float]:
    """The landing at the last time of the `case`, and its largest distance from it [m, 1]."""
    landing = Landing(vehicle(THREE_LEGS | values), rtol=rtol)
    farthest = 0.0
    for time in sorted(case["pose"], key=float):
        landing.advance_to(float(time))
        now, then = landing.outputs(), case["pose"][time]
        found = [now[f"body.{axis}"] for axis in "xyz"]
        found += [now[f"body.q_{part}"] for part in "wxyz"]
        told = [*then["position"], *then["quaternion_wxyz"]]
        farthest = max([farthest, *(abs(a - b) for a, b in zip(found, told))])
    return landing, farthest


def peak(landing: Landing, strut: str, leg: int, side: str) -> float:
    """The `side`, min or max, of a strut's quantity in the reference's sense."""
    name, turned = STRUTS[strut]
    found = landing.extremes()[f"leg[{leg}].{name}"]
    low, high = found.minimum, found.maximum
    if turned:
        low, high = -high, -low
    return low if side == "min" else high


PEAKS = [
    pytest.param(strut, leg, side, id=f"{strut}-{leg}-{side}")
    for strut in STRUTS
    for leg in (1, 2, 3)
    for side in ("min", "max")
]


@pytest.fixture(scope="module")
def frictionless() -> tuple[Landing, float]:
    return landed({}, CASES["frictionless"], 1e-8)


@pytest.fixture(scope="module")
def sliding() -> tuple[Landing, float]:
    # the reference is the ideal slider: the footpads stick within some micrometres
    values = {"ground.friction": 0.3, "ground.stick_displacement": 2e-5, "ground.stick_damping": 0}
    return landed(values, CASES["friction"], 1e-6)


def test_pose_without_friction(frictionless: tuple[Landing, float]) -> None:
    assert frictionless[1] < 1e-8


@pytest.mark.parametrize(("strut", "leg", "side"), PEAKS)
def test_peaks_without_friction(
    frictionless: tuple[Landing, float], strut: str, leg: int, side: str
) -> None:
    told = CASES["frictionless"]["peaks"][strut][side][leg - 1]
    assert peak(frictionless[0], strut, leg, side) == pytest.approx(told, rel=1e-4)


def test_pose_with_friction(sliding: tuple[Landing, float]) -> None:
    assert sliding[1] < 1e-3


@pytest.mark.parametrize(("strut", "leg", "side"), PEAKS)
def test_peaks_with_friction(
    sliding: tuple[Landing, float], strut: str, leg: int, side: str
) -> None:
    told = CASES["friction"]["peaks"][strut]
    # of what the quantity goes through: a rebound of 0.5 mm is no peak by itself
    span = told["max"][leg - 1] - told["min"][leg - 1]
    off = peak(sliding[0], strut, leg, side) - told[side][leg - 1]
    assert abs(off) < 0.01 * span


def test_contact_times_without_friction() -> None:
    landing = Landing(vehicle(THREE_LEGS), rtol=1e-8)
    touched: dict[int, float] = {1: 0.0}
    while len(touched) < 3:
        landing.advance_within_step(0.3, 0.3, to_event=True)
        now = landing.outputs()
        for leg in (1, 2, 3):
            if now[f"leg[{leg}].contact.active"]:
                touched.setdefault(leg, landing.time)
    told = CASES["frictionless"]["contact_times"]
    assert [touched[leg] for leg in (1, 2, 3)] == pytest.approx(told, abs=1e-6)
