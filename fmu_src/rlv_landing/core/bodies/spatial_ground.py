"""The ground below the spatial body: deck, height field, and points of the body that meet it."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from math import inf

from ..access import (
    ACROSS,
    BALANCE,
    CONTACT_ACCOUNT,
    DECK_INPUTS,
    DECK_TURN,
    ENERGY_OUTPUTS,
    FOOT_LOADS,
    FOOT_MOTION,
    FRICTION,
    GROUND_ACCOUNT,
    GROUND_FORCE,
    LEG_LOAD_OUTPUTS,
    LEG_OUTPUTS,
    POINT_STATE,
    ROTATION,
    SECOND_STRUT_OUTPUTS,
    SPATIAL_ACCELERATIONS,
    SPATIAL_INPUTS,
    SPATIAL_OUTPUTS,
    STATUS_OUTPUTS,
    body_point_of,
    deck_turn_of,
    foot_loads_of,
    foot_motion_of,
    ground_force_of,
    height_field_of,
    keep,
    leg_model,
    point_state,
    put,
    rotation_of,
    spatial_model,
    spatial_state,
)
from ..ground.kinds import friction_bound, friction_energy, friction_only_takes, ground_force_on
from ..ground.normal import normal_energy
from ..ground.terrain import terrain_place
from ..memory import Buffer, Doubles, Records, data, room, stored
from ..records import (
    BodyPoint,
    DeckTurn,
    FootLoads,
    FootMotion,
    GroundForce,
    HeightField,
    LegModel,
    LegPlace,
    PointState,
    Rotation,
    SpatialInputs,
    SpatialModel,
    TerrainPlace,
    Vector,
)
from ..vectors import added, cross, dot, less, to_body, to_inertial
from .deck import (
    deck_turn,
    deck_velocity,
    from_origin,
    ground_axes,
    is_turn_at,
    local_axes,
    motion_on_ground,
    motion_on_terrain,
    steepness,
)
from .legged import Legged
from .sea import FREEDOMS, Sea
from .spatial_legs import cg_of


class SpatialGround(Legged):
    """A body in space above its ground, without its motion.

    It is made with its numbers, those of its legs, and `met`: the points of the body that meet the
    ground, their contact law, the height field, its heights [m], and the sea that moves the deck.

    Attributes:
        points: How many points of the body meet the ground by themselves. Their contact law is
            that of the legs; each has a `PointState`, behind the legs' states.
    """

    points: int
    _body: Records[SpatialModel]
    _turn: Records[Rotation]
    _deck: Records[DeckTurn]
    _ground: Records[Rotation]
    # the ground's axes at the contact that is looked at, in a height field
    _local: Records[Rotation]
    _field: Records[HeightField]
    _heights: Buffer
    _has_field: bool
    # length of a row, which has a node more on each side
    _width: int
    # how many contacts are beyond the height field where `rhs` was called last, and `read`
    _outside: int
    _off_ground: bool
    _points: Records[BodyPoint]
    _law: Records[LegModel]
    _point_motions: Records[FootMotion]
    _point_forces: Records[GroundForce]
    _point_loads: Records[FootLoads]
    _first_point: int
    # place in the state of what legs on three struts have across their planes
    _first_across: int
    # how many outputs a leg has
    _leg_row: int
    _sea: Sea
    # of surge, heave, sway, roll, yaw, tilt
    _deck_accelerations: Buffer

    def __init__(
        self,
        body: SpatialModel,
        legs: Sequence[LegModel],
        places: Sequence[LegPlace],
        scale: Buffer,
        relative: Buffer,
        met: tuple[Sequence[BodyPoint], LegModel, HeightField, Buffer, Sea],
    ) -> None:
        points, law, field, heights, sea = met
        more = SECOND_STRUT_OUTPUTS if body.tripod > 0.0 else LEG_LOAD_OUTPUTS
        across = ACROSS * len(legs) if body.tripod > 0.0 else 0
        leg_row = LEG_OUTPUTS + more
        row = SPATIAL_OUTPUTS + ENERGY_OUTPUTS + STATUS_OUTPUTS + leg_row * len(legs)
        behind = across + POINT_STATE * len(points)
        super().__init__(legs, places, (scale, relative), SPATIAL_INPUTS, row, behind)
        self.mass += body.m_u
        self._energies = SPATIAL_OUTPUTS
        self.unsought = self._energies + BALANCE
        self._accelerations = SPATIAL_ACCELERATIONS
        self._axes = 6
        self.points = len(points)
        self._first_across = self.controlled - behind
        self._first_point = self._first_across + across
        self._leg_row = leg_row
        self.counted = self._first_point
        self._body = stored([body])
        self._turn = room(1, ROTATION)
        self._deck = room(1, DECK_TURN)
        # of no angles yet
        keep(DeckTurn(inf, inf, inf, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0), self._deck, 0)
        self._ground = room(1, ROTATION)
        self._local = room(1, ROTATION)
        self._field = stored([field])
        self._heights = array("d", heights)
        self._has_field = field.columns > 0.0
        self._width = int(field.columns) + 2
        self._outside = 0
        self._off_ground = False
        self._points = stored(points)
        self._law = stored([law])
        self._point_motions = room(len(points), FOOT_MOTION)
        self._point_forces = room(len(points), GROUND_FORCE)
        self._point_loads = room(len(points), FOOT_LOADS)
        self._sea = sea
        self._deck_accelerations = array("d", bytes(8 * FREEDOMS))
        self.at_sea = sea.count > 0
        if points and not friction_only_takes(leg_model(self._law, 0)):
            self.rising = FRICTION

    def is_off_ground(self, outputs: Doubles) -> bool:
        """Whether a contact was beyond the height field where `outputs` were read last."""
        return self._off_ground

    def add_sea(self, t: float, now: Doubles) -> None:
        """Add the deck's motion in the sea at time `t` [s] to its motion by the inputs `now`."""
        self._sea.add_to(t, now, DECK_INPUTS)

    def _turn_ground(self, now: SpatialInputs) -> None:
        """Keep the deck's angles and the ground's axes, which most decks seldom change."""
        if not is_turn_at(deck_turn_of(self._deck, 0), now):
            keep(deck_turn(now), self._deck, 0)
            turn = deck_turn_of(self._deck, 0)
            keep(ground_axes(turn, spatial_model(self._body, 0)), self._ground, 0)

    def _meet_field(
        self, above: Vector, velocity: Vector, step: float, kept: Records[FootMotion], i: int
    ) -> float:
        """Keep the motion of the `i`-th contact against the height field, and its axes there.

        Args:
            above: The contact from the deck's origin, inertial [m].
            velocity: Its velocity against the ground there, inertial [m/s].
            step: Height of the ground there above its field [m].
            kept: Where to keep the motion.
            i: The contact's number.

        Returns:
            The field's steepness there.
        """
        axes = rotation_of(self._ground, 0)
        place = self._terrain(to_body(axes, above))
        if place.outside > 0.0:
            self._outside += 1
        keep(local_axes(axes, place), self._local, 0)
        keep(motion_on_terrain(rotation_of(self._local, 0), place, velocity, step), kept, i)
        return steepness(place)

    def _terrain(self, place: Vector) -> TerrainPlace:
        """The height field below a place from the deck's origin, in the ground's axes [m]."""
        return terrain_place(
            height_field_of(self._field, 0), data(self._heights), self._width, place
        )

    def _load_points(self, y: Doubles, now: SpatialInputs, rolling: Vector) -> None:
        """Keep the ground's forces on the body's points; `rolling` is the deck's spin [rad/s]."""
        s = spatial_state(y, 0)
        turn = rotation_of(self._turn, 0)
        spin = Vector(s.spin_x, s.spin_y, s.spin_z)
        law = leg_model(self._law, 0)
        for i in range(self.points):
            q = point_state(y, self._first_point + POINT_STATE * i)
            from_cg = self._point(i)
            point = added(Vector(s.x, s.y, s.z), to_inertial(turn, from_cg))
            above = from_origin(now, point)
            ground = deck_velocity(now, rolling, above)
            moved = to_inertial(turn, cross(spin, from_cg))
            velocity = less(added(Vector(s.vx, s.vy, s.vz), moved), ground)
            axes = rotation_of(self._ground, 0)
            steep = 1.0
            if self._has_field:
                steep = self._meet_field(above, velocity, 0.0, self._point_motions, i)
                axes = rotation_of(self._local, 0)
            else:
                keep(motion_on_ground(axes, above, velocity, 0.0), self._point_motions, i)
            motion = foot_motion_of(self._point_motions, i)
            keep(ground_force_on(motion, steep, q.q1, q.q2, law), self._point_forces, i)
            f = ground_force_of(self._point_forces, i)
            contact = to_inertial(axes, Vector(f.f1, f.normal, f.f2))
            keep(
                FootLoads(
                    x=point.x,
                    y=point.y,
                    z=point.z,
                    depth=motion.depth,
                    contact_x=contact.x,
                    contact_y=contact.y,
                    contact_z=contact.z,
                    ground=dot(contact, ground),
                ),
                self._point_loads,
                i,
            )

    def _point(self, i: int) -> Vector:
        """The `i`-th point of the body from the CG, body axes [m]."""
        p = body_point_of(self._points, i)
        return less(Vector(p.x, p.y, p.z), cg_of(spatial_model(self._body, 0)))

    def _strike_force(self) -> Vector:
        """The ground's force on the body's points, inertial [N]."""
        total = Vector(0.0, 0.0, 0.0)
        for i in range(self.points):
            f = foot_loads_of(self._point_loads, i)
            total = added(total, Vector(f.contact_x, f.contact_y, f.contact_z))
        return total

    def _strike_moment(self) -> Vector:
        """Its moment about the CG, inertial axes [N m]."""
        turn = rotation_of(self._turn, 0)
        total = Vector(0.0, 0.0, 0.0)
        for i in range(self.points):
            f = foot_loads_of(self._point_loads, i)
            arm = to_inertial(turn, self._point(i))
            total = added(total, cross(arm, Vector(f.contact_x, f.contact_y, f.contact_z)))
        return total

    def _put_point_rates(self, dy: Doubles) -> None:
        """Write the rates of the points' states, and add their powers to the accounts' [W]."""
        for i in range(self.points):
            f = ground_force_of(self._point_forces, i)
            put(PointState(f.dq1, f.dq2), dy, self._first_point + POINT_STATE * i)
            dy[self.controlled + CONTACT_ACCOUNT] += f.dissipated
            dy[self.controlled + FRICTION] += f.friction
            dy[self.controlled + GROUND_ACCOUNT] += foot_loads_of(self._point_loads, i).ground

    def _keep_point_energies(self, y: Doubles) -> None:
        """Keep the energies that the points' contacts hold [J]."""
        law = leg_model(self._law, 0)
        self.more_contact = 0.0
        self.more_friction = 0.0
        for i in range(self.points):
            q = point_state(y, self._first_point + POINT_STATE * i)
            self.more_contact += normal_energy(ground_force_of(self._point_forces, i).work, law)
            self.more_friction += friction_energy(q.q1, q.q2, law)

    def _project_points(self, y: Doubles) -> None:
        law = leg_model(self._law, 0)
        for i in range(self.points):
            at = self._first_point + POINT_STATE * i
            q = point_state(y, at)
            bound = friction_bound(q.q1, q.q2, law)
            put(PointState(bound.q1, bound.q2), y, at)

    def _clearance(self) -> float:
        """Least distance [m] of the body's points from the ground; 0 where there are none.

        In a height field it is measured along the normal of the ground's plane.
        """
        if self.points == 0:
            return 0.0
        least = inf
        for i in range(self.points):
            least = min(least, -foot_loads_of(self._point_loads, i).depth)
        return least
