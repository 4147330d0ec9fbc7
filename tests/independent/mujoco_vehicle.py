"""The same vehicle in MuJoCo, with linear struts and MuJoCo's own multibody dynamics.

The legs are built like the mechanism, not like the kernels' coordinates. A footpad is a body on a
hinge at the auxiliary strut's joint and on a slide along that strut (spring and damper), so the
transverse force is the hinge's. The main strut is a tendon from its joint to the footpad. The stage
is free in space. Axes are the model's: y up, z = x cross y, pitch clockwise positive.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import mujoco
import numpy as np
from vehicle_3d import Array, pitch_of

from rlv_landing import Parameters
from rlv_landing.touchdown import footpad_at_rest, leg_directions

STIFFNESS, DAMPING = (
    2.3e5,
    3000.0,
)  # main strut, N/m and N s/m: about the identified damper's secant stiffness
RADIUS = 1e-4  # of the footpads' spheres, m; the plane lies as much lower
NAMES = ("x", "y", "z", "pitch", "stroke", "main_force", "aux_force")


def linear_struts(parameters: Parameters) -> Parameters:
    """The parameters with struts that are almost linear springs and dampers.

    The main strut has two large chambers of almost equal area A. A steady stroke only squeezes the
    area difference dA into the liquid: K = dA^2 B/(V1 + V2). A moving one drives A v through an
    orifice in its laminar range: C = A^2 sqrt(dP_lam rho/2)/(Cd Ao). Deviations remain: the liquid
    stiffens by 6e-4 at 30 mm, the damper lags by C V/(2 A^2 B) = 2e-5 s, and the stop at full
    extension cannot be softer than 1 kN/m (4e-3 of the spring, only in tension). The ambient
    pressure is 10 MPa, so that nothing cavitates.
    """
    area, volume, modulus, pressure, density = 0.02, 0.05, 1e10, 1e7, 1000.0
    difference = sqrt(STIFFNESS * 2.0 * volume / modulus)
    orifice = area**2 * sqrt(pressure * density / 2.0) / DAMPING
    main = {
        "area_upper": area - 0.5 * difference, "area_lower": area + 0.5 * difference,
        "volume_upper": volume, "volume_lower": volume,
        "charge_pressure": 1e7, "ambient_pressure": 1e7,
        "fluid_density": density, "air_fraction": 1e-7,
        "bulk_modulus": modulus, "bulk_modulus_slope": 1.5,
        "orifice_area_compression": orifice, "orifice_area_rebound": orifice,
        "laminar_pressure": pressure,
        "seal_coulomb": 0.0, "seal_stribeck": 0.0, "seal_pressure": 0.0,
        "stroke_max": 0.2, "stop_stiffness": 1e3, "stop_damping": 0.0,
    }  # fmt: skip
    return parameters.with_values(
        {
            "auxiliary_strut.exponent": 1.0,
            "auxiliary_strut.play_tension": 0.0,
            "auxiliary_strut.play_compression": 0.0,
            **{f"main_strut.{name}": value for name, value in main.items()},
        }
    )


def _text(*numbers: float) -> str:
    return " ".join(repr(float(n)) for n in numbers)


def build(
    parameters: Parameters, timestep: float, contact: tuple[float, float] | None = None
) -> mujoco.MjModel:
    """MuJoCo's model of the vehicle.

    Args:
        parameters: Vehicle, struts, ground and drop mode.
        timestep: Time step [s].
        contact: Time constant [s] and damping ratio of MuJoCo's own contact with Coulomb friction;
            no contact if None.
    """
    v, m, a, g = (
        parameters.vehicle,
        parameters.main_strut,
        parameters.auxiliary_strut,
        parameters.ground,
    )
    r, h = footpad_at_rest(parameters)
    normal = ground_normal(parameters)
    cg = np.array([v.cg_offset_x, 0.0, v.cg_offset_z])
    legs, tendons = "", ""
    for i, (s, c) in enumerate(leg_directions(parameters).values()):

        def at(radius: float, height: float, c: float = c, s: float = s) -> Array:
            return np.array([radius * c, height, radius * s]) - cg

        foot, joint = at(r, h), at(a.joint_radius, -a.joint_depth)
        legs += f"""
      <site name="top{i}" pos="{_text(*at(m.joint_radius, -m.joint_depth))}"/>
      <body name="foot{i}" pos="{_text(*foot)}">
        <inertial pos="0 0 0" mass="{v.footpad_mass!r}" diaginertia="1e-9 1e-9 1e-9"/>
        <joint name="hinge{i}" type="hinge" axis="{_text(-s, 0.0, c)}"
               pos="{_text(*(joint - foot))}"/>
        <joint name="slide{i}" type="slide" axis="{_text(*((joint - foot) / a.length))}"
               stiffness="{a.stiffness!r}" damping="{a.damping!r}"/>
        <site name="foot{i}"/>
        <geom type="sphere" size="{RADIUS}" contype="{int(contact is not None)}" conaffinity="0"/>
      </body>"""
        tendons += f"""
    <spatial name="main{i}" stiffness="{STIFFNESS!r}" damping="{DAMPING!r}"
             springlength="{m.length!r}">
      <site site="top{i}"/><site site="foot{i}"/>
    </spatial>"""
    inertia = (v.inertia, 40.0, v.inertia, 0.0, 0.0, 0.0)
    if parameters.drop.mode == "space":
        products = (v.inertia_xy, v.inertia_xz, v.inertia_yz)
        inertia = (v.inertia_roll, v.inertia_yaw, v.inertia, *products)
    time_constant, ratio = contact or (1e-3, 1.0)
    method = "implicitfast" if contact else "RK4"
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian"/>
  <option gravity="{_text(0.0, -g.gravity, 0.0)}" timestep="{timestep}" integrator="{method}"
          cone="elliptic" impratio="20" tolerance="1e-12"/>
  <default>
    <geom friction="{g.friction!r} 0 0" solref="{_text(time_constant, ratio)}"
          solimp="0.95 0.95 0.001" condim="3"/>
  </default>
  <worldbody>
    <geom name="ground" type="plane" size="0 0 1" zaxis="{_text(*normal)}"
          pos="{_text(*(-RADIUS * normal))}" contype="0" conaffinity="1"/>
    <body name="stage">
      <freejoint/>
      <inertial pos="0 0 0" mass="{v.mass!r}"
                fullinertia="{_text(*inertia)}"/>{legs}
    </body>
  </worldbody>
  <tendon>{tendons}
  </tendon>
</mujoco>""")


def ground_normal(parameters: Parameters) -> Array:
    """The normal of the ground at rest."""
    slope, direction = parameters.ground.slope, parameters.ground.slope_direction
    down = np.sin(slope)
    return np.array([down * np.cos(direction), np.cos(slope), down * np.sin(direction)])


def ground_law(parameters: Parameters, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Apply the model's ground law, linear and frictionless, as a passive force on the footpads.

    Depth and speed are computed from MuJoCo's own kinematics.
    """
    g, normal = parameters.ground, ground_normal(parameters)
    jacobian = np.zeros((3, model.nv))
    for i in range(int(parameters.vehicle.legs)):
        step = parameters[f"leg[{i + 1}].ground.step"]
        depth = step - float(normal @ data.site(f"foot{i}").xpos)
        if depth <= 0.0:
            continue
        mujoco.mj_jacSite(model, data, jacobian, None, model.site(f"foot{i}").id)
        q = min(depth / g.damping_depth, 1.0)
        sinking = -float(normal @ jacobian @ data.qvel)
        force = max(g.stiffness * depth + g.damping * q * q * (3.0 - 2.0 * q) * sinking, 0.0)
        data.qfrc_passive += force * (normal @ jacobian)


def land_in_space(
    parameters: Parameters, start: Sequence[float], until: float, timestep: float
) -> tuple[Array, Array]:
    """Land in space on `ground_law`, by the fourth-order Runge-Kutta method.

    Args:
        parameters: Vehicle, struts, ground and drop.
        start: Position [m], quaternion (w, x, y, z), velocity [m/s] and spin [rad/s] of the stage
            at time 0, inertial but the spin, which is in body axes.
        until: End [s].
        timestep: Time step [s].

    Returns:
        Position and quaternion of the stage (7, n), and the main struts' strokes [m] (legs, n), at
        every millisecond.
    """
    model = build(parameters, timestep)
    data = mujoco.MjData(model)
    data.qpos[:7], data.qvel[:6] = start[:7], start[7:]
    poses, strokes, every = [], [], round(1e-3 / timestep)
    mujoco.set_mjcb_passive(lambda m, d: ground_law(parameters, m, d))
    try:
        for k in range(round(until / timestep) + 1):
            if k % every == 0:
                mujoco.mj_forward(model, data)
                poses.append(data.qpos[:7].copy())
                strokes.append(parameters.main_strut.length - data.ten_length)
            mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_passive(None)
    return np.array(poses).T, np.array(strokes).T


def land(
    parameters: Parameters,
    body: Sequence[float],
    until: float,
    timestep: float,
    contact: tuple[float, float] | None = None,
    load: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> dict[str, Array]:
    """Land; return motion and loads every millisecond.

    Args:
        parameters: Vehicle, struts, ground and drop mode.
        body: (x, y, pitch, vx, vy, pitch rate) at time 0; the legs are at full length and at rest.
        until: End [s].
        timestep: Time step [s].
        contact: As for `build`; if None, `ground_law` acts on the footpads.
        load: Inertial force x and y [N] at the CG, and clockwise moment [N m].

    Returns:
        Arrays by name, and the time of each footpad's `first_touch` [s], inf if there is none.
    """
    model = build(parameters, timestep, contact)
    data = mujoco.MjData(model)
    x, y, pitch, vx, vy, rate = body
    data.qpos[:7] = [x, y, 0.0, np.cos(-0.5 * pitch), 0.0, 0.0, np.sin(-0.5 * pitch)]
    data.qvel[:6] = [vx, vy, 0.0, 0.0, 0.0, -rate]
    data.xfrc_applied[model.body("stage").id] = [*load[:2], 0.0, 0.0, 0.0, -load[2]]
    slides = [model.joint(f"slide{i}") for i in range(4)]
    legs = [(j.qposadr[0], j.dofadr[0]) for j in slides]
    a = parameters.auxiliary_strut
    feet = [model.site(f"foot{i}").id for i in range(4)]
    normal = ground_normal(parameters)
    first_touch = np.full(4, np.inf)
    rows: list[list[Array]] = []
    every = round(1e-3 / timestep)
    if contact is None:
        mujoco.set_mjcb_passive(lambda m, d: ground_law(parameters, m, d))
    try:
        for k in range(round(until / timestep) + 1):
            if k % every == 0:
                mujoco.mj_forward(model, data)
                stroke = parameters.main_strut.length - data.ten_length
                rows.append(
                    [
                        *data.qpos[:3],
                        float(pitch_of(data.qpos[3:7])),
                        stroke,
                        -(STIFFNESS * stroke - DAMPING * data.ten_velocity),
                        -np.array(
                            [a.stiffness * data.qpos[p] + a.damping * data.qvel[v] for p, v in legs]
                        ),
                    ]
                )
            mujoco.mj_step(model, data)
            touches = data.site_xpos[feet] @ normal < 0.0
            first_touch[touches & np.isinf(first_touch)] = data.time
    finally:
        mujoco.set_mjcb_passive(None)
    return {
        "first_touch": first_touch,
        **{name: np.array([row[i] for row in rows]).T for i, name in enumerate(NAMES)},
    }
