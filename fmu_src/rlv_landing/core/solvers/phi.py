"""The phi functions of exponential integrators, and Krogstad's weights made of them."""

from __future__ import annotations

from math import expm1

from ..records import PhiWeights

# below it, the differences that phi2 and phi3 are made of would cancel
SMALL = 0.1


def phi1(z: float) -> float:
    """(1 - exp(-z))/z."""
    return -expm1(-z) / z if z > 0.0 else 1.0


def phi2(z: float, f1: float) -> float:
    """(1 - phi1)/z, from `f1` = phi1(z); Taylor's series where that would cancel."""
    if z > SMALL:
        return (1.0 - f1) / z
    tail = 1.0 / 720.0 - z * (
        1.0 / 5040.0 - z * (1.0 / 40320.0 - z * (1.0 / 362880.0 - z / 3628800.0))
    )
    return 0.5 - z * (1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * tail)))


def phi3(z: float, f2: float) -> float:
    """(1/2 - phi2)/z, from `f2` = phi2(z); Taylor's series where that would cancel."""
    if z > SMALL:
        return (0.5 - f2) / z
    tail = 1.0 / 5040.0 - z * (
        1.0 / 40320.0 - z * (1.0 / 362880.0 - z * (1.0 / 3628800.0 - z / 39916800.0))
    )
    return 1.0 / 6.0 - z * (1.0 / 24.0 - z * (1.0 / 120.0 - z * (1.0 / 720.0 - z * tail)))


def phi_weights(z: float) -> PhiWeights:
    """Krogstad's weights for a difference that decays by exp(-z) within the step."""
    half1 = phi1(0.5 * z)
    half2 = phi2(0.5 * z, half1)
    f1 = phi1(z)
    f2 = phi2(z, f1)
    f3 = phi3(z, f2)
    return PhiWeights(
        a21=0.5 * half1,
        a31=0.5 * half1 - half2,
        a32=half2,
        a41=f1 - 2.0 * f2,
        a43=2.0 * f2,
        b1=f1 - 3.0 * f2 + 4.0 * f3,
        b23=2.0 * f2 - 4.0 * f3,
        b4=4.0 * f3 - f2,
    )
