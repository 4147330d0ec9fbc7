"""Where each number stands in the flat arrays that the kernels share.

State `y`: body (6), then one block of `LEG` numbers a leg group, then the energy integrals (`INTEGRALS`).
Inputs `u`: `INPUTS` numbers. Loads `w`: one block of `LOADS` numbers a leg group, then the body's.
The compiled core turns these names into C constants.
"""

# body: position of the centre of gravity (CG) and pitch in the inertial frame, and their rates
X, Y, PITCH, VX, VY, PITCH_RATE = 0, 1, 2, 3, 4, 5
BODY = 6

# one leg group: footpad in the leg's plane, chamber pressures, friction displacements along the ground's x and z
R, H, VR, VH, P1, P2, SX, SZ = 0, 1, 2, 3, 4, 5, 6, 7
LEG = 8

# energy integrals, behind the last leg group
(
    E_ORIFICE,
    E_SEAL,
    E_STOP,
    E_AUXILIARY,
    E_CONTACT,
    E_FRICTION,
    W_EXTERNAL,
    W_GROUND,
    W_TRANSVERSE,
) = 0, 1, 2, 3, 4, 5, 6, 7, 8
INTEGRALS = 9

# inputs: load on the body at the CG, motion of the ground
FORCE_X, FORCE_Y, MOMENT, HEAVE, HEAVE_RATE, TILT, TILT_RATE = 0, 1, 2, 3, 4, 5, 6
INPUTS = 7

# loads of one leg group, written by leg.leg_loads
L_STROKE, L_STROKE_RATE, L_MAIN, L_STROKE_AUX, L_STROKE_RATE_AUX, L_AUX = 0, 1, 2, 3, 4, 5
L_FOOT_X, L_FOOT_Y, L_FOOT_Z, L_PENETRATION = 6, 7, 8, 9
L_CONTACT_X, L_CONTACT_Y, L_CONTACT_Z = 10, 11, 12
L_RADIAL, L_VERTICAL, L_TANGENTIAL = 13, 14, 15
L_BODY_X, L_BODY_Y, L_BODY_MOMENT = 16, 17, 18
L_DP1, L_DP2, L_DSX, L_DSZ = 19, 20, 21, 22
L_ORIFICE, L_SEAL, L_STOP, L_DISSIPATED_AUX, L_DISSIPATED_CONTACT, L_FRICTION, L_GROUND = (
    23,
    24,
    25,
    26,
    27,
    28,
    29,
)
L_DECAY1, L_DECAY2 = 30, 31
LOADS = 32

# behind the last leg group's loads: the body's acceleration along its own axes
B_AX, B_AY, B_PITCH_ACC = 0, 1, 2
BODY_LOADS = 3

# what the exponential method keeps for each leg group: driven rates of its stages, weights
STAGES, WEIGHTS = 5, 9
