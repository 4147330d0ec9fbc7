"""Records from and to arrays of numbers: nothing else knows where a field stands.

A state is the body's, then each leg's, then of legs on three struts what each has across its
plane, then each body point's, then the accounts, then each main strut's work. What is kept between
two kernels is an array of records of one kind. Compiled, each of these functions is an access
through an address (see `core_declarations`): a record that was read is that in the array, so a
kernel must not go on reading it after it has written there.
"""

from __future__ import annotations

from typing import Any

from .memory import Doubles, Records
from .records import (
    Accounts,
    AcrossForces,
    AcrossState,
    Attitude,
    BodyAcceleration,
    BodyModel,
    BodyOutputs,
    BodyPoint,
    BodyState,
    DeckTurn,
    EnergyOutputs,
    FootLoads,
    FootMotion,
    GroundForce,
    HeightField,
    Inputs,
    LegForces,
    LegLoadOutputs,
    LegModel,
    LegOutputs,
    LegPlace,
    LegState,
    LegStatus,
    PhiWeights,
    PlanarLoads,
    PointState,
    Rotation,
    SecondStrutOutputs,
    SpatialAttitude,
    SpatialInputs,
    SpatialLoads,
    SpatialModel,
    SpatialOutputs,
    SpatialState,
    StatusOutputs,
    StiffPair,
    Turn,
)

# how many numbers a record takes
BODY = len(BodyState._fields)
LEG = len(LegState._fields)
ACROSS = len(AcrossState._fields)
ACCOUNTS = len(Accounts._fields)
INPUTS = len(Inputs._fields)
FOOT_LOADS = len(FootLoads._fields)
FOOT_MOTION = len(FootMotion._fields)
GROUND_FORCE = len(GroundForce._fields)
POINT_STATE = len(PointState._fields)
LEG_FORCES = len(LegForces._fields)
ACROSS_FORCES = len(AcrossForces._fields)
LEG_STATUS = len(LegStatus._fields)
PLANAR_LOADS = len(PlanarLoads._fields)
ATTITUDE = len(Attitude._fields)
TURN = len(Turn._fields)
BODY_ACCELERATION = len(BodyAcceleration._fields)
SPATIAL_STATE = len(SpatialState._fields)
SPATIAL_INPUTS = len(SpatialInputs._fields)
SPATIAL_LOADS = len(SpatialLoads._fields)
SPATIAL_ATTITUDE = len(SpatialAttitude._fields)
ROTATION = len(Rotation._fields)
DECK_TURN = len(DeckTurn._fields)
STIFF_PAIR = len(StiffPair._fields)
PHI_WEIGHTS = len(PhiWeights._fields)
BODY_OUTPUTS = len(BodyOutputs._fields)
SPATIAL_OUTPUTS = len(SpatialOutputs._fields)
LEG_LOAD_OUTPUTS = len(LegLoadOutputs._fields)
SECOND_STRUT_OUTPUTS = len(SecondStrutOutputs._fields)
ENERGY_OUTPUTS = len(EnergyOutputs._fields)
STATUS_OUTPUTS = len(StatusOutputs._fields)
LEG_OUTPUTS = len(LegOutputs._fields)

# where the energies that a user sees have what was dissipated, and their balance
KINETIC = EnergyOutputs._fields.index("kinetic")
DISSIPATED = EnergyOutputs._fields.index("dissipated")
BALANCE = EnergyOutputs._fields.index("balance")

# where the body's outputs have its accelerations
ACCELERATIONS = BodyOutputs._fields.index("ax")
SPATIAL_ACCELERATIONS = SpatialOutputs._fields.index("ax")

# where the accounts have what friction has dissipated, the last of what is dissipated
FRICTION = Accounts._fields.index("friction")
# what the auxiliary struts have, the ground's normal damping, and the work of the ground
AUXILIARY_ACCOUNT = Accounts._fields.index("auxiliary")
CONTACT_ACCOUNT = Accounts._fields.index("contact")
GROUND_ACCOUNT = Accounts._fields.index("ground")

# where the inputs have the deck's places and rates
DECK_INPUTS = SpatialInputs._fields.index("surge")

# where a leg's state has what may be stiff in it
Z1 = LegState._fields.index("z1")
Z2 = LegState._fields.index("z2")


def body_state(y: Doubles, at: int) -> BodyState:
    """The body's state that stands at `y[at:]`."""
    return BodyState(*y[at : at + BODY])


def spatial_state(y: Doubles, at: int) -> SpatialState:
    """The spatial body's state that stands at `y[at:]`."""
    return SpatialState(*y[at : at + SPATIAL_STATE])


def leg_state(y: Doubles, at: int) -> LegState:
    """The leg's state that stands at `y[at:]`."""
    return LegState(*y[at : at + LEG])


def across_state(y: Doubles, at: int) -> AcrossState:
    """The state of a footpad across its leg's plane that stands at `y[at:]`."""
    return AcrossState(*y[at : at + ACROSS])


def point_state(y: Doubles, at: int) -> PointState:
    """The state of a point of the body that stands at `y[at:]`."""
    return PointState(*y[at : at + POINT_STATE])


def accounts(y: Doubles, at: int) -> Accounts:
    """The accounts that stand at `y[at:]`."""
    return Accounts(*y[at : at + ACCOUNTS])


def inputs(u: Doubles, at: int) -> Inputs:
    """The inputs that stand at `u[at:]`."""
    return Inputs(*u[at : at + INPUTS])


def spatial_inputs(u: Doubles, at: int) -> SpatialInputs:
    """The inputs of a landing in space that stand at `u[at:]`."""
    return SpatialInputs(*u[at : at + SPATIAL_INPUTS])


def status_outputs(y: Doubles, at: int) -> StatusOutputs:
    """The outputs `status.*` that stand at `y[at:]`."""
    return StatusOutputs(*y[at : at + STATUS_OUTPUTS])


def put(record: tuple[float, ...], y: Doubles, at: int) -> None:
    """Write a record to `y[at:]`."""
    for i, value in enumerate(record):
        y[at + i] = value


def body_model(kept: Records[BodyModel], i: int) -> BodyModel:
    """The `i`-th record of those kept."""
    return kept[i]


def leg_model(kept: Records[LegModel], i: int) -> LegModel:
    """The `i`-th record of those kept."""
    return kept[i]


def leg_place(kept: Records[LegPlace], i: int) -> LegPlace:
    """The `i`-th record of those kept."""
    return kept[i]


def leg_forces_of(kept: Records[LegForces], i: int) -> LegForces:
    """The `i`-th record of those kept."""
    return kept[i]


def across_forces_of(kept: Records[AcrossForces], i: int) -> AcrossForces:
    """The `i`-th record of those kept."""
    return kept[i]


def leg_status_of(kept: Records[LegStatus], i: int) -> LegStatus:
    """The `i`-th record of those kept."""
    return kept[i]


def foot_loads_of(kept: Records[FootLoads], i: int) -> FootLoads:
    """The `i`-th record of those kept."""
    return kept[i]


def foot_motion_of(kept: Records[FootMotion], i: int) -> FootMotion:
    """The `i`-th record of those kept."""
    return kept[i]


def ground_force_of(kept: Records[GroundForce], i: int) -> GroundForce:
    """The `i`-th record of those kept."""
    return kept[i]


def body_point_of(kept: Records[BodyPoint], i: int) -> BodyPoint:
    """The `i`-th record of those kept."""
    return kept[i]


def height_field_of(kept: Records[HeightField], i: int) -> HeightField:
    """The `i`-th record of those kept."""
    return kept[i]


def planar_loads_of(kept: Records[PlanarLoads], i: int) -> PlanarLoads:
    """The `i`-th record of those kept."""
    return kept[i]


def attitude_of(kept: Records[Attitude], i: int) -> Attitude:
    """The `i`-th record of those kept."""
    return kept[i]


def turn_of(kept: Records[Turn], i: int) -> Turn:
    """The `i`-th record of those kept."""
    return kept[i]


def body_acceleration_of(kept: Records[BodyAcceleration], i: int) -> BodyAcceleration:
    """The `i`-th record of those kept."""
    return kept[i]


def spatial_model(kept: Records[SpatialModel], i: int) -> SpatialModel:
    """The `i`-th record of those kept."""
    return kept[i]


def spatial_loads_of(kept: Records[SpatialLoads], i: int) -> SpatialLoads:
    """The `i`-th record of those kept."""
    return kept[i]


def spatial_attitude_of(kept: Records[SpatialAttitude], i: int) -> SpatialAttitude:
    """The `i`-th record of those kept."""
    return kept[i]


def rotation_of(kept: Records[Rotation], i: int) -> Rotation:
    """The `i`-th record of those kept."""
    return kept[i]


def deck_turn_of(kept: Records[DeckTurn], i: int) -> DeckTurn:
    """The `i`-th record of those kept."""
    return kept[i]


def stiff_pair_of(kept: Records[StiffPair], i: int) -> StiffPair:
    """The `i`-th record of those kept."""
    return kept[i]


def phi_weights_of(kept: Records[PhiWeights], i: int) -> PhiWeights:
    """The `i`-th record of those kept."""
    return kept[i]


def keep(record: tuple[Any, ...], kept: Records[Any], i: int) -> None:
    """Keep a record as the `i`-th."""
    kept[i] = record
