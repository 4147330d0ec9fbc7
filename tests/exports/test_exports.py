"""The exported vehicle as others read it: MuJoCo lands it, yourdfpy places its parts."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from math import cos, radians

import mujoco
import numpy as np
import pytest
import yourdfpy
from five_legs import five_legs
from scipy.spatial.transform import Rotation

from rlv_landing import Landing, LandingError, Parameters, load_preset
from rlv_landing.assembly.legs import leg_model
from rlv_landing.core.struts.liquid_spring import liquid_spring, orifice_flow
from rlv_landing.exports.linear import (
    auxiliary_strut,
    ground,
    main_strut,
    orifice_pressure,
    stroke_rate,
)
from rlv_landing.exports.mechanism import mechanism
from rlv_landing.exports.mjcf import mjcf
from rlv_landing.exports.rods import ROD_MASS
from rlv_landing.exports.sdf import sdf
from rlv_landing.exports.urdf import urdf
from rlv_landing.parameters import terrain_of
from rlv_landing.touchdown import footpad_at_rest

PLANE = {"ground.terrain": ""}
# struts and ground exactly linear, no friction; the rest has no symmetry
LINEAR = {
    **PLANE,
    "vehicle.body_points": "",
    "leg[2].ground.step": 0.0,
    "main_strut.kind": "spring-damper",
    "main_strut.stiffness": 2.3e5,
    "main_strut.damping": 3000.0,
    "auxiliary_strut.exponent": 1.0,
    "auxiliary_strut.play_tension": 0.0,
    "auxiliary_strut.play_compression": 0.0,
    "auxiliary_strut.damping": 7000.0,
    "auxiliary_strut.stiffness": 3e5,
    "ground.stiffness": 5e6,
    "ground.exponent": 1.0,
    "ground.damping": 0.0,
    "ground.friction": 0.0,
    "leg[4].ground.friction": 0.0,
    "ground.stribeck_gain": 0.0,
    "drop.contact_time": 0.01,
}
UNTIL, STEP = 0.35, 1e-4


def linear_vehicle() -> Parameters:
    return five_legs().with_values(LINEAR)


def landed_by_mujoco(text: str, lengths: list[float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Main and auxiliary forces (times, legs) [N], and the pose of the CG at UNTIL, z up."""
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.timestep = STEP
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("touchdown").id)
    slides = [model.joint(f"leg{leg}_auxiliary") for leg in range(1, len(lengths) + 1)]
    places, dofs = (
        [int(a[0]) for a in all_] for all_ in zip(*((s.qposadr, s.dofadr) for s in slides))
    )
    stiffness = np.array([s.stiffness[0] for s in slides])
    main, auxiliary = [], []
    for _ in range(round(UNTIL / STEP)):
        mujoco.mj_step(model, data)
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        stroke = np.array(lengths) - data.ten_length
        main.append(model.tendon_damping * data.ten_velocity - model.tendon_stiffness * stroke)
        auxiliary.append(-stiffness * data.qpos[places] - model.dof_damping[dofs] * data.qvel[dofs])
    return np.array(main), np.array(auxiliary), data.qpos[:7].copy()


def test_mujoco_lands_the_exported_vehicle_as_we_do() -> None:
    parameters = linear_vehicle()
    main, auxiliary, pose = landed_by_mujoco(mjcf(parameters), [parameters.main_strut.length] * 5)
    landing = Landing(parameters, rtol=1e-8)
    landing.advance_to(UNTIL)
    now, extremes = landing.outputs(), landing.extremes()
    assert pose[:3] == pytest.approx([now["body.x"], -now["body.z"], now["body.y"]], abs=2e-6)
    turned = [now["body.q_w"], now["body.q_x"], -now["body.q_z"], now["body.q_y"]]
    assert pose[3:] == pytest.approx(turned, abs=2e-6)
    for leg in range(5):
        for ours, theirs, near in (("main", main, 3e-4), ("auxiliary", auxiliary, 3e-3)):
            found = extremes[f"leg[{leg + 1}].{ours}_strut.force"]
            size = max(-found.minimum, found.maximum)
            assert theirs[:, leg].min() == pytest.approx(found.minimum, abs=near * size)
            assert theirs[:, leg].max() == pytest.approx(found.maximum, abs=near * size)


def test_mujoco_lands_the_exported_tripod_as_we_do() -> None:
    parameters = linear_vehicle().with_values({"leg.kind": "tripod"})
    model = mujoco.MjModel.from_xml_string(mjcf(parameters))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    landing, struts = Landing(parameters, rtol=1e-7), ("auxiliary", "auxiliary", "main")
    lengths = np.array([getattr(parameters, f"{strut}_strut").length for strut in struts] * 5)
    names = ("auxiliary_strut", "auxiliary_strut_2", "main_strut")
    largest = 0.0
    for k in range(1, 13):
        while data.time < k * 0.01 - 0.5 * model.opt.timestep:
            mujoco.mj_step(model, data)
        mujoco.mj_fwdPosition(model, data)
        landing.advance_to(k * 0.01)
        now = landing.outputs()
        place = [now["body.x"], -now["body.z"], now["body.y"]]
        assert data.qpos[:3] == pytest.approx(place, abs=1e-5)
        ours = [now[f"leg[{leg}].{name}.stroke"] for leg in range(1, 6) for name in names]
        assert lengths - data.ten_length == pytest.approx(ours, abs=2e-5)
        largest = max(largest, *np.abs(ours))
    assert largest > 0.01


def test_mujoco_holds_the_exported_prototype_at_full_length_and_stops_it() -> None:
    parameters = load_preset("yue2022-figures").for_mode("1-2-1")
    model = mujoco.MjModel.from_xml_string(mjcf(parameters))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    start = Landing(parameters).outputs()
    speeds = (start["body.vx"], 0.0, start["body.vy"], 0.0, start["body.pitch_rate"], 0.0)
    assert data.qvel[:6] == pytest.approx(speeds, abs=1e-12)
    mujoco.mj_forward(model, data)
    m = parameters.main_strut
    assert data.ten_length == pytest.approx(m.length, abs=1e-9)
    preload = (m.area_lower - m.area_upper) * (m.charge_pressure - m.ambient_pressure)
    held = model.tendon_stiffness * (model.tendon_lengthspring[:, 0] - model.tendon_range[:, 1])
    assert held == pytest.approx(preload)
    while data.time < 0.6:
        mujoco.mj_step(model, data)
    # down, upright, and shorter by less than the stroke
    assert np.all(data.ten_length < m.length + 1e-3)
    assert np.all(data.ten_length > m.length - m.stroke_max)
    assert data.body("base_link").xmat[8] > cos(radians(10.0))


@pytest.mark.parametrize(
    "parameters", [five_legs().with_values(PLANE), load_preset("yue2022-figures").for_mode("2-2")]
)
def test_urdf_places_joints_and_footpads_where_the_model_has_them(parameters: Parameters) -> None:
    robot = yourdfpy.URDF.load(_file(urdf(parameters)), load_meshes=False)
    robot.update_cfg(dict.fromkeys(robot.actuated_joint_names, 0.0))
    landing = Landing(parameters)
    turn, place = _pose(landing)
    for leg in range(1, int(parameters.vehicle.legs) + 1):
        foot = robot.get_transform(f"leg{leg}_footpad", "base_link")[:3, 3]
        x, y, z = (landing.get(f"leg[{leg}].footpad.{axis}") for axis in "xyz")
        assert turn.apply(foot.copy()) + place == pytest.approx([x, -z, y], abs=1e-9)
        assert robot.get_transform(f"leg{leg}_main_end", "base_link")[:3, 3] == pytest.approx(foot)
    # a stroke of 20 mm brings the footpad 20 mm nearer to the auxiliary joint
    robot.update_cfg({"leg1_auxiliary": 0.02})
    near = robot.get_transform("leg1_footpad", "leg1_auxiliary_upper")[:3, 3]
    assert np.linalg.norm(near) == pytest.approx(parameters.auxiliary_strut.length - 0.02)
    masses = [link.inertial.mass for link in robot.robot.links if link.inertial]
    assert sum(masses) == pytest.approx(_whole_mass(parameters), abs=0.02)


def test_urdf_and_sdf_of_a_tripod_have_three_struts_that_meet() -> None:
    parameters = five_legs().with_values({**PLANE, "leg.kind": "tripod"})
    robot = yourdfpy.URDF.load(_file(urdf(parameters)), load_meshes=False)
    robot.update_cfg(dict.fromkeys(robot.actuated_joint_names, 0.0))
    landing = Landing(parameters)
    turn, place = _pose(landing)
    a = parameters.auxiliary_strut
    for leg in range(1, 6):
        foot = robot.get_transform(f"leg{leg}_footpad", "base_link")[:3, 3]
        x, y, z = (landing.get(f"leg[{leg}].footpad.{axis}") for axis in "xyz")
        assert turn.apply(foot.copy()) + place == pytest.approx([x, -z, y], abs=1e-9)
        for end in ("main_end", "auxiliary2_end"):
            near = robot.get_transform(f"leg{leg}_{end}", "base_link")[:3, 3]
            assert near == pytest.approx(foot)
        joints = [
            robot.get_transform(f"leg{leg}_auxiliary{k}_upper", "base_link")[:3, 3] for k in (1, 2)
        ]
        assert np.linalg.norm(joints[0] - joints[1]) == pytest.approx(2.0 * a.joint_spread)
        assert np.linalg.norm(joints[1] - foot) == pytest.approx(a.length)
    # both hinges turn the strut across itself: the footpad moves in two directions
    ways = []
    for hinge in ("leg1_auxiliary1_hinge", "leg1_auxiliary1_hinge2"):
        robot.update_cfg({**dict.fromkeys(robot.actuated_joint_names, 0.0), hinge: 1e-6})
        moved = robot.get_transform("leg1_footpad", "base_link")[:3, 3]
        robot.update_cfg(dict.fromkeys(robot.actuated_joint_names, 0.0))
        ways.append((moved - robot.get_transform("leg1_footpad", "base_link")[:3, 3]) / 1e-6)
    assert np.linalg.norm(np.cross(*ways)) > 0.9 * a.length**2
    world = ET.fromstring(sdf(parameters)).find("world")
    assert world is not None
    model = world.find("model[@name='rlv_landing']")
    assert model is not None
    kinds = {j.get("name"): j.get("type") for j in model.iter("joint")}
    for strut in ("main", "auxiliary1", "auxiliary2"):
        assert kinds[f"leg3_{strut}_hinge"] == "universal"
        assert kinds[f"leg3_{strut}"] == "prismatic"
        first, second = (
            np.array([float(word) for word in axis.text.split()])
            for tag in ("axis", "axis2")
            for axis in model.iterfind(f"joint[@name='leg3_{strut}_hinge']/{tag}/xyz")
        )
        assert first @ second == pytest.approx(0.0, abs=1e-12)
    assert [kinds[f"leg3_{end}_end"] for end in ("main", "auxiliary2")] == ["ball", "ball"]
    assert "leg3_auxiliary1_end" not in kinds
    masses = [float(m.text) for m in model.iterfind("link/inertial/mass")]
    assert sum(masses) == pytest.approx(_whole_mass(parameters), abs=0.03)


def test_mujoco_reads_the_urdf_with_our_mass_inertia_and_free_fall() -> None:
    """A second reader of URDF: its tree as a floating body, joints free, at full length."""
    parameters = five_legs().with_values(PLANE)
    kept = '<mujoco><compiler fusestatic="false"/></mujoco></robot>'
    spec = mujoco.MjSpec.from_string(urdf(parameters).replace("</robot>", kept))
    spec.body("base_link").add_freejoint()
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    model = spec.compile()
    data = mujoco.MjData(model)
    made = mechanism(parameters)
    light = 3 * ROD_MASS * len(made.legs)
    whole = parameters.whole_mass
    assert model.body_mass.sum() == pytest.approx(whole + light, rel=1e-12)
    mujoco.mj_forward(model, data)
    center = sum(leg.mass * leg.foot for leg in made.legs) / whole
    found = data.subtree_com[model.body("base_link").id]
    assert found == pytest.approx(center, abs=2.0 * light / whole)
    # nothing but gravity: the whole falls, and no strut moves
    assert data.qacc[:3] == pytest.approx([0.0, 0.0, -9.81], abs=1e-9)
    assert data.qacc[3:] == pytest.approx(0.0, abs=1e-9)
    tensor = made.inertia + sum(
        leg.mass * (leg.foot @ leg.foot * np.eye(3) - np.outer(leg.foot, leg.foot))
        for leg in made.legs
    )
    for axis in (*np.eye(3), *Rotation.random(3, rng=1).as_matrix()[:, 0]):
        data.qvel[:] = 0.0
        data.qvel[3:6] = axis
        mujoco.mj_forward(model, data)
        mujoco.mj_energyVel(model, data)
        assert 2.0 * data.energy[1] == pytest.approx(axis @ tensor @ axis, rel=1e-3)


def test_sdf_and_mjcf_have_the_same_inertia_joints_and_laws() -> None:
    parameters = five_legs().with_values(PLANE)
    world = ET.fromstring(sdf(parameters)).find("world")
    assert world is not None
    model = world.find("model[@name='rlv_landing']")
    robot, theirs = (
        ET.fromstring(urdf(parameters)),
        mujoco.MjModel.from_xml_string(mjcf(parameters)),
    )
    inertia = model.find("link[@name='base_link']/inertial/inertia")
    tensor = np.array(
        [[float(inertia.find("i" + "".join(sorted(a + b))).text) for a in "xyz"] for b in "xyz"]
    )
    body = theirs.body("base_link")
    axes = Rotation.from_quat(np.roll(body.iquat, -1)).as_matrix()
    assert axes @ np.diag(body.inertia) @ axes.T == pytest.approx(tensor, abs=1e-9)
    v = parameters.vehicle
    # z up: their y is our -z
    assert tensor[0, 2] == pytest.approx(v.inertia_xy)
    assert tensor[1, 2] == pytest.approx(-v.inertia_yz)
    names = {joint.get("name") for joint in model.iter("joint")}
    links = {link.get("name") for link in model.iter("link")}
    assert {j.find("parent").text for j in model.iter("joint")} <= links
    assert {j.find("child").text for j in model.iter("joint")} <= links
    assert {j.get("name") for j in robot.iter("joint") if j.get("type") != "fixed"} == {
        name for name in names if not name.endswith("_end")
    }
    for leg in range(1, 6):
        strut = model.find(f"joint[@name='leg{leg}_main']/axis/dynamics")
        own = main_strut(parameters.of_leg(leg))
        assert float(strut.find("spring_stiffness").text) == own.stiffness
        assert float(strut.find("damping").text) == theirs.tendon_damping[leg - 1]
        assert float(strut.find("spring_reference").text) == pytest.approx(
            -own.preload / own.stiffness
        )


def test_liquid_springs_are_linearised_at_charge_and_touchdown_speed() -> None:
    parameters = load_preset("yue2022-figures").for_mode("1-2-1")
    own = main_strut(parameters)
    # slow: against the law itself, whose seal friction is left out
    quiet = parameters.with_values(
        {
            "main_strut.seal_coulomb": 0.0,
            "main_strut.seal_stribeck": 0.0,
            "main_strut.seal_pressure": 0.0,
        }
    )
    p = leg_model(quiet)
    z, ds = parameters.main_strut.charge_pressure, 1e-6
    # one pressure in both chambers that keeps the liquid, by a step of Newton's
    law = liquid_spring(ds, 0.0, z, z, p)
    rise = (p.fill - law.liquid_mass) / (law.mass_1 + law.mass_2)
    moved = liquid_spring(ds, 0.0, z + rise, z + rise, p)
    resting = liquid_spring(0.0, 0.0, z, z, p)
    assert (moved.force - resting.force) / ds == pytest.approx(own.stiffness, rel=1e-3)
    assert resting.force == pytest.approx(own.preload)
    pressure = orifice_pressure(2e-4, 1.0, p)
    assert orifice_flow(pressure, 1.0, p) == pytest.approx(2e-4, rel=1e-12)
    m, a = parameters.main_strut, parameters.auxiliary_strut
    foot = np.array(footpad_at_rest(parameters)) - (a.joint_radius, -a.joint_depth)
    joint = np.array([m.joint_radius - a.joint_radius, a.joint_depth - m.joint_depth])
    # the footpad turned about the auxiliary joint until it is 1 um higher
    turned = np.arctan2(foot[1], foot[0]) + 1e-6 / foot[0]
    raised = a.length * np.array([np.cos(turned), np.sin(turned)])
    shorter = (m.length - np.linalg.norm(raised - joint)) / 1e-6
    sink = -parameters.drop.vertical_velocity
    assert stroke_rate(parameters) == pytest.approx(sink * shorter, rel=1e-4)
    assert own.damping > main_strut(quiet).damping > 0.0


def test_secants_hold_the_footpads_energy_and_linear_laws_stay() -> None:
    parameters = linear_vehicle()
    assert auxiliary_strut(parameters).stiffness == pytest.approx(3e5)
    assert ground(parameters).stiffness == pytest.approx(5e6)
    assert main_strut(parameters)[:2] == (2.3e5, 3000.0)


def test_what_cannot_be_exported_is_refused(command, tmp_path) -> None:
    field = terrain_of([-9.0, 9.0], [-9.0, 9.0], [[0.0, 0.0], [0.0, 0.0]])
    with pytest.raises(LandingError, match=r"ground\.terrain cannot be exported"):
        mjcf(five_legs().with_values({"ground.terrain": field}))
    with pytest.raises(LandingError, match=r"sea\.wave_height = 2 m cannot be exported"):
        mjcf(five_legs().with_values({**PLANE, "sea.wave_height": 2.0}))
    file = tmp_path / "stage.xml"
    none = command("export")
    assert (none.code, none.err.count("\n")) == (2, 1)
    assert "--mjcf FILE.xml" in none.err
    wrong = command("export", "--urdf", str(file))
    assert (wrong.code, ".urdf" in wrong.err) == (2, True)
    done = command(
        "export", "--mjcf", str(file), "--set", "ground.slope=3 deg", "--set", "drop.mode=space"
    )
    assert done.code == 0, done.err
    assert mujoco.MjModel.from_xml_path(str(file)).nbody == 6
    again = command("export", "--mjcf", str(file))
    assert (again.code, "--force" in again.err) == (2, True)


def _file(text: str):
    import io

    return io.BytesIO(text.encode())


def _pose(landing: Landing) -> tuple[Rotation, np.ndarray]:
    """Attitude and place of the CG, z up."""
    now = landing.outputs()
    if "body.q_w" not in now:
        return Rotation.from_euler("y", now["body.pitch"]), np.array(
            [now["body.x"], 0.0, now["body.y"]]
        )
    q = [now[f"body.q_{part}"] for part in "xyzw"]
    return (
        Rotation.from_quat([q[0], -q[2], q[1], q[3]]),
        np.array([now["body.x"], -now["body.z"], now["body.y"]]),
    )


def _whole_mass(parameters: Parameters) -> float:
    legs = range(1, int(parameters.vehicle.legs) + 1)
    return parameters.vehicle.mass + sum(
        parameters.of_leg(leg).vehicle.footpad_mass for leg in legs
    )
