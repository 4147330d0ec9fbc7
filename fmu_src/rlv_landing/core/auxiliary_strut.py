"""The auxiliary strut: nonlinear spring and damper along its axis. Eq. (13)."""

from math import fabs, pow

from .model import Model  # noqa: F401  (the compiled core needs the type)


def auxiliary(s, v, p):
    """Return (force, dissipated power) at stroke `s` [m] and stroke rate `v` [m/s], all positive in compression. Eq. (13)."""
    spring = p.Ka * pow(fabs(s), p.ek)
    if s < 0.0:
        spring = -spring
    return spring + p.Ca * v, p.Ca * v * v
