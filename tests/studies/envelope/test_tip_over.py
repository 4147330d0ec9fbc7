"""The landing with locked struts and sticking feet against the closed form of a rigid block."""

from __future__ import annotations

from math import atan, cos, radians, sin, tan

import pytest
from pytest import approx

from rlv_landing import Landing, Parameters
from rlv_landing.studies.envelope.judged_landing import judged_landing
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.envelope.tip_over import RigidBlock, locked_vehicle
from rlv_landing.studies.outcome import outcome
from rlv_landing.studies.whole_landing import whole_landing

V = "drop.horizontal_velocity"
DAMPING = "auxiliary_strut__damping"
BLOCK = RigidBlock(194.8, 290.0, 1.0, 1.96, 9.81)


def higher(by: float) -> dict[str, float]:
    """The CG lies `by` [m] higher above the legs."""
    return {"main_strut__joint_depth": 1.103 + by, "auxiliary_strut__joint_depth": 1.513 + by}


def side(parameters: Parameters, vx: float) -> str:
    """The side to which the model's vehicle topples; empty where it does not."""
    axes = Axis(V, -50.0, 50.0, 1.0), Axis("drop.tilt", -1.5, 1.5, 0.1)
    return judged_landing(EnvelopeStudy(parameters, *axes, until=4.5), {V: vx}).towards


def test_a_strike_keeps_the_angular_momentum_about_the_foot():
    """Cartesian components: r x M v + I w before, r x M (w x r) + I w after.

    Clockwise is positive.
    """
    pitch, vx, vy, rate = 0.15, 2.0, -0.7, 0.3
    # body axes to inertial, clockwise: the foot is at (1, -1.96)
    rx, ry = -(1.0 * cos(pitch) - 1.96 * sin(pitch)), -(-1.0 * sin(pitch) - 1.96 * cos(pitch))
    before = 290.0 * rate + 194.8 * (ry * vx - rx * vy)
    w = BLOCK.rate_after_contact(pitch, vx, vy, rate)
    after = 290.0 * w + 194.8 * (ry * (w * ry) - rx * (-w * rx))
    assert after == approx(before, rel=1e-12)


def test_the_critical_speed_has_just_the_energy_to_lift_the_cg_over_the_foot():
    speed = BLOCK.critical_speed(0.1, -0.5)
    w = BLOCK.rate_after_contact(0.1, speed, -0.5)
    lifted = BLOCK.radius - (1.0 * sin(0.1) + 1.96 * cos(0.1))
    assert 0.5 * BLOCK.pivot_inertia * w * w == approx(194.8 * 9.81 * lifted, rel=1e-9)
    assert BLOCK.topples(0.1, 0.0, 1.001 * speed, -0.5) == "+x"
    assert BLOCK.topples(0.1, 0.0, 0.999 * speed, -0.5) == ""


def test_the_block_is_its_own_mirror_image():
    for vx in (-4.0, -2.0, 1.0, 3.5):
        for pitch in (-0.2, -0.05, 0.1):
            mirrored = {"+x": "-x", "-x": "+x", "": ""}[
                BLOCK.topples(-pitch, -0.04, -vx, -0.5, -0.2)
            ]
            assert BLOCK.topples(pitch, 0.04, vx, -0.5, 0.2) == mirrored


@pytest.mark.parametrize(
    ("parameters", "tolerance"),
    [
        (locked_vehicle(), 0.02),
        (locked_vehicle(drop__tilt=0.2), 0.02),
        (locked_vehicle(drop__tilt=0.1, drop__vertical_velocity=-1.4), 0.02),
        (locked_vehicle(ground__slope=0.1, drop__tilt=0.2), 0.02),
        (locked_vehicle(**higher(-0.5), drop__tilt=0.05), 0.02),
        (locked_vehicle(**higher(0.5), drop__tilt=0.05), 0.02),
        (locked_vehicle(**higher(1.0), ground__slope=0.05, drop__tilt=0.1), 0.02),
        (locked_vehicle("1-2-1", drop__tilt=0.05), 0.02),
        (locked_vehicle("1-2-1", ground__slope=0.1, drop__tilt=0.1), 0.02),
        # the trailing feet strike in the same instant, hard enough to take part before they lift
        (locked_vehicle(ground__slope=0.1, drop__tilt=0.1, drop__vertical_velocity=-1.4), 0.04),
    ],
)
def test_the_critical_speed_of_the_locked_vehicle_is_the_blocks(parameters, tolerance):
    """Feet at +x first, or all at once; over several heights of the CG and slopes."""
    drop = parameters.drop
    speed = RigidBlock.of(parameters).critical_speed(drop.tilt, drop.vertical_velocity)
    assert side(parameters, (1.0 - tolerance) * speed) == ""
    assert side(parameters, (1.0 + tolerance) * speed) == "+x"


def test_the_low_vehicle_on_one_foot_stands_more_as_the_strike_throws_it_off():
    """A damped auxiliary strut gives nothing back, and the critical speed is the block's."""
    low = {**higher(-0.5), "drop__tilt": radians(4.0)}
    elastic, damped = (
        locked_vehicle("1-2-1", **low, **values) for values in ({}, {DAMPING: 1.5e5})
    )
    speed = RigidBlock.of(elastic).critical_speed(elastic.drop.tilt, -0.5)
    assert side(elastic, 1.03 * speed) == ""
    assert side(damped, 1.03 * speed) == "+x"
    thrown = Landing(elastic.with_values({V: 1.1 * speed})).run(0.2, 1e-3)
    assert all(thrown[f"leg[{leg}].contact.active"][50:].max() == 0.0 for leg in (1, 2, 3))


@pytest.mark.parametrize(
    ("parameters", "speeds"),
    [
        # the trailing feet strike first, and the vehicle slaps down on the leading ones
        (locked_vehicle(drop__tilt=-0.1), (-4.0, 2.5, 4.2)),
        # uphill: one that does not get over its leading feet swings back and topples over the
        # others
        (locked_vehicle(ground__slope=-0.1), (-3.3, 2.5, 3.3)),
        (locked_vehicle("1-2-1", drop__tilt=-0.1), (-3.3, 5.0)),
        (locked_vehicle("1-2-1", ground__slope=-0.1), (-4.1, 4.2)),
    ],
)
def test_the_locked_vehicle_swings_from_foot_to_foot_as_the_block_does(parameters, speeds):
    block, drop = RigidBlock.of(parameters), parameters.drop
    for vx in speeds:
        assert side(parameters, vx) == block.topples(
            drop.tilt, parameters.ground.slope, vx, drop.vertical_velocity
        ), vx


def test_the_envelopes_boundary_of_the_locked_vehicle_is_the_blocks():
    """Found by the envelope's own refinement and bisection, in speed and tilt."""
    study = EnvelopeStudy(
        locked_vehicle(),
        Axis(V, 1.7, 3.5, 0.06),
        Axis("drop.tilt", radians(0.5), radians(8.0), radians(1.0)),
        cells=2,
        levels=0,
        until=3.0,
    )
    ((line,),) = (f.lines for f in envelope(study, workers=2).families)
    block = RigidBlock.of(study.parameters)
    assert len(line) >= 3
    for c in line:
        assert c.x == approx(block.critical_speed(c.y, -0.5), rel=0.03)


def test_at_rest_on_a_slope_it_topples_where_the_tangent_passes_half_track_over_height():
    """Stiff ground, that it does not rock when let go."""
    parameters = locked_vehicle(ground__stiffness=1e8, drop__vertical_velocity=-1e-3)
    tipping = tan(RigidBlock.of(parameters).tipping_slope)
    for part, name in ((0.99, "settled or moving"), (1.005, "toppled")):
        slope = atan(part * tipping)
        found = outcome(
            whole_landing(
                Landing(parameters.with_values({"ground.slope": slope, "drop.tilt": slope})), 3.0
            )
        )
        assert found.name in name


@pytest.mark.parametrize("mode", ["2-2", "1-2-1"])
@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_at_rest_on_a_slope_it_slides_where_the_tangent_passes_the_friction(mode, friction):
    parameters = locked_vehicle(mode, ground__friction=friction, drop__vertical_velocity=-1e-3)
    for part, name in ((0.99, "settled"), (1.01, "slid")):
        slope = atan(part * friction)
        history = whole_landing(
            Landing(parameters.with_values({"ground.slope": slope, "drop.tilt": slope})), 4.0
        )
        assert outcome(history, slide=0.05).name == name
