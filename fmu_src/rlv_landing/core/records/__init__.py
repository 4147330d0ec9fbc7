"""The layout of all data of the core: a record for each set of numbers that functions share.

In the compiled core a record is a C struct made from the text here; nothing else fixes an order.

Frames. Inertial: x forward, y up, z to the right; the origin is that of the ground. Body: the same
axes turned by the pitch, which is clockwise positive; the origin is the body's centre of gravity
(CG). Leg: r radially out and h up from the CG in a plane fixed in the body, t across it. Ground: n
out of the ground, 1 and 2 along it, 1 down the slope and 2 along inertial z.

The fields of a record that stands in an array are numbers. Compiled, such a record is handed on by
its address, one that was just made by value.
"""

from .laws import (
    AuxiliaryForce,
    AxialForce,
    Bearing,
    Chamber,
    FluidState,
    FootMotion,
    Friction,
    FrictionBound,
    FrictionForce,
    GroundForce,
    NormalForce,
    SpaceStrut,
    StrutForce,
    StrutMotion,
    StrutStatus,
)
from .legs import AcrossForces, FootLoads, LegForces, LegStatus
from .models import BodyModel, LegModel, LegPlace
from .outputs import (
    BodyOutputs,
    EnergyOutputs,
    LegLoadOutputs,
    LegOutputs,
    SecondStrutOutputs,
    SpatialOutputs,
    StatusOutputs,
)
from .planar import (
    Attitude,
    BodyAcceleration,
    FootPoint,
    FrameAcceleration,
    PlanarLoads,
    Turn,
)
from .spatial import (
    BodyPoint,
    Cubic,
    DeckTurn,
    FootPlace,
    HeightField,
    PointState,
    Rotation,
    SpatialAttitude,
    SpatialInputs,
    SpatialLoads,
    SpatialModel,
    SpatialState,
    TerrainHeight,
    TerrainPlace,
    Vector,
)
from .state import Accounts, AcrossState, BodyState, Fault, Inputs, LegState, Phase
from .steps import Bend, Crest, PhiWeights, StiffPair

__all__ = [
    "Accounts",
    "AcrossForces",
    "AcrossState",
    "Attitude",
    "AuxiliaryForce",
    "AxialForce",
    "Bearing",
    "Bend",
    "BodyAcceleration",
    "BodyModel",
    "BodyOutputs",
    "BodyPoint",
    "BodyState",
    "Chamber",
    "Crest",
    "Cubic",
    "DeckTurn",
    "EnergyOutputs",
    "Fault",
    "FluidState",
    "FootLoads",
    "FootMotion",
    "FootPlace",
    "FootPoint",
    "FrameAcceleration",
    "Friction",
    "FrictionBound",
    "FrictionForce",
    "GroundForce",
    "HeightField",
    "Inputs",
    "LegForces",
    "LegLoadOutputs",
    "LegModel",
    "LegOutputs",
    "LegPlace",
    "LegState",
    "LegStatus",
    "NormalForce",
    "Phase",
    "PhiWeights",
    "PlanarLoads",
    "PointState",
    "Rotation",
    "SecondStrutOutputs",
    "SpaceStrut",
    "SpatialAttitude",
    "SpatialInputs",
    "SpatialLoads",
    "SpatialModel",
    "SpatialOutputs",
    "SpatialState",
    "StatusOutputs",
    "StiffPair",
    "StrutForce",
    "StrutMotion",
    "StrutStatus",
    "TerrainHeight",
    "TerrainPlace",
    "Turn",
    "Vector",
]
