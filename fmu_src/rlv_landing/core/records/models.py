"""Parameters of the body and of each leg, constant during a landing.

They have the paper's symbols, whose meanings are in `rlv_landing.parameters`.
"""

from typing import NamedTuple


class BodyModel(NamedTuple):
    """The body and the ground it comes down on."""

    m_u: float
    I_u: float
    H: float
    # the body feels the legs' transverse forces at the auxiliary struts' joints (1) or footpads (0)
    at_joint: float
    alpha: float
    g: float


class LegModel(NamedTuple):
    """One leg: all that its struts, its footpad and the ground below it need.

    `Lb`, `Ld` are heights, negative below the CG.
    """

    main_kind: float  # number of the law in `struts.laws.MAIN_STRUTS`
    auxiliary_kind: float  # number of the law in `struts.laws.AUXILIARY_STRUTS`
    friction_kind: float  # number of the law in `ground.laws.FRICTION_LAWS`
    m_d: float
    # main strut: joint and length, liquid spring, seal, end stops
    La: float
    Lb: float
    Lm0: float
    A1: float
    A2: float
    V10: float
    V20: float
    fill: float  # the liquid's mass [kg]
    Pa: float
    rho0: float
    x_air: float
    n_air: float
    B0: float
    kB: float
    CdAo_c: float
    CdAo_r: float
    dP_lam: float
    Fc: float
    kp: float
    Fs: float
    v_str: float
    v_sm: float
    s_max: float
    K_stop: float
    c_stop: float
    Km: float  # of a spring-damper
    Cm: float
    # auxiliary strut
    Lc: float
    Ld: float
    Ls0: float
    Lt: float  # joints of a tripod's auxiliary struts: distance from the leg's plane [m]
    Ka: float
    ek: float
    Ca: float
    g_t: float
    g_c: float
    k_play: float
    c_play: float
    F_0: float  # force of the joints' faces at stroke 0, which the law leaves out [N]
    U_0: float  # energy of the joints' faces at stroke 0, which the law leaves out [J]
    # ground
    Kg: float
    en: float
    Cgmax: float
    d_ramp: float
    mu: float
    s_r0: float
    ar: float
    b_strib: float
    Cr: float
    v_dir: float
    tau_sr: float
    K_t: float
    zone: float  # [m]
    step: float  # height of the ground below the footpad above its plane [m]
    # part of mu^2 along 1 at rest: 1/2; 1 for a leg that lies in the symmetric plane
    share_1: float


class LegPlace(NamedTuple):
    """Place of a leg group on the body, and its number of legs, which are mirror images."""

    sin_g: float  # sine of the azimuth
    cos_g: float  # cosine of the azimuth
    legs: float
