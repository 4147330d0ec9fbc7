"""CVODE without Python in its loop, on the right-hand side of `c_landing.c`.

It uses the shared libraries in scikit-sundae's wheel. Python makes at most one call per
millisecond of the landing. So this shows what the method costs, while scikit-sundae shows what its
user pays.
"""

from __future__ import annotations

from ctypes import CDLL, POINTER, Structure, byref, c_double, c_int, c_int64, c_long, c_void_p, cast
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import sksundae.cvode
from c_landing import EXACT, CLanding, doubles, library
from problem import Problem

ADAMS, BDF = 1, 2
NORMAL = 1
SIGNATURES: dict[str, tuple[str, Any, tuple[Any, ...]]] = {
    "SUNContext_Create": ("core", c_int, (c_int, POINTER(c_void_p))),
    "SUNContext_Free": ("core", c_int, (POINTER(c_void_p),)),
    "N_VMake_Serial": ("nvecserial", c_void_p, (c_int64, POINTER(c_double), c_void_p)),
    "N_VDestroy": ("core", None, (c_void_p,)),
    "SUNDenseMatrix": ("sunmatrixdense", c_void_p, (c_int64, c_int64, c_void_p)),
    "SUNMatDestroy": ("core", None, (c_void_p,)),
    "SUNLinSol_Dense": ("sunlinsoldense", c_void_p, (c_void_p, c_void_p, c_void_p)),
    "SUNLinSolFree": ("core", c_int, (c_void_p,)),
    "CVodeCreate": ("cvode", c_void_p, (c_int, c_void_p)),
    "CVodeInit": ("cvode", c_int, (c_void_p, c_void_p, c_double, c_void_p)),
    "CVodeSetUserData": ("cvode", c_int, (c_void_p, c_void_p)),
    "CVodeSVtolerances": ("cvode", c_int, (c_void_p, c_double, c_void_p)),
    "CVodeSetLinearSolver": ("cvode", c_int, (c_void_p, c_void_p, c_void_p)),
    "CVodeSetMaxStep": ("cvode", c_int, (c_void_p, c_double)),
    "CVodeSetMaxNumSteps": ("cvode", c_int, (c_void_p, c_long)),
    "CVode": ("cvode", c_int, (c_void_p, c_double, c_void_p, POINTER(c_double), c_int)),
    "CVodeFree": ("cvode", None, (POINTER(c_void_p),)),
}


class Bridge(Structure):
    """User data of `slope_for_cvode`: the landing in C, and the access to a vector's array."""

    _fields_ = (("landing", c_void_p), ("array", c_void_p))


@cache
def sundials_library(part: str) -> CDLL:
    """One of SUNDIALS' libraries in scikit-sundae's wheel."""
    folder = Path(sksundae.cvode.__file__).parents[2] / "scikit_sundae.libs"
    (path,) = folder.glob(f"libsundials_{part}-*.so*")
    return CDLL(str(path))


@cache
def function(name: str) -> Any:
    """A function of SUNDIALS."""
    part, result, arguments = SIGNATURES[name]
    found = getattr(sundials_library(part), name)
    found.restype, found.argtypes = result, arguments
    return found


def call(name: str, *arguments: Any) -> Any:
    """Call a function of SUNDIALS.

    Raises:
        ArithmeticError: It returns an error.
    """
    result = function(name)(*arguments)
    if SIGNATURES[name][1] is c_int and result < 0:
        raise ArithmeticError(f"{name} of SUNDIALS returned {result}")
    return result


class CvodeInC:
    """One landing by CVODE, with dense Newton iterations and a Jacobian by difference quotients.

    Args:
        problem: The landing.
        rtol: Relative tolerance.
        method: ADAMS or BDF.
        longest: Longest step [s].
        most: Largest number of steps between two outputs.

    Raises:
        ArithmeticError: A function of SUNDIALS returns an error.
    """

    def __init__(
        self, problem: Problem, rtol: float, method: int, longest: float, most: int
    ) -> None:
        m = problem.m
        # references, because SUNDIALS works in these arrays
        self._y, self._atol = doubles(problem.state), doubles(rtol * problem.scale)
        self._landing = CLanding(problem.landing().parameters, rtol)
        self._bridge = Bridge(
            self._landing._landing, cast(sundials_library("core").N_VGetArrayPointer, c_void_p)
        )
        self._context = c_void_p()
        call("SUNContext_Create", 0, byref(self._context))
        self._vector = call("N_VMake_Serial", m, self._y, self._context)
        self._tolerances = call("N_VMake_Serial", m, self._atol, self._context)
        self._matrix = call("SUNDenseMatrix", m, m, self._context)
        self._linear = call("SUNLinSol_Dense", self._vector, self._matrix, self._context)
        self._memory = c_void_p(call("CVodeCreate", method, self._context))
        call(
            "CVodeInit",
            self._memory,
            cast(library(EXACT).slope_for_cvode, c_void_p),
            0.0,
            self._vector,
        )
        call("CVodeSetUserData", self._memory, cast(byref(self._bridge), c_void_p))
        call("CVodeSVtolerances", self._memory, rtol, self._tolerances)
        call("CVodeSetLinearSolver", self._memory, self._linear, self._matrix)
        call("CVodeSetMaxStep", self._memory, longest)
        call("CVodeSetMaxNumSteps", self._memory, most)

    def __del__(self) -> None:
        if getattr(self, "_memory", None):
            call("CVodeFree", byref(self._memory))
            call("SUNLinSolFree", self._linear)
            call("SUNMatDestroy", self._matrix)
            call("N_VDestroy", self._tolerances)
            call("N_VDestroy", self._vector)
            call("SUNContext_Free", byref(self._context))

    def advance(self, t_end: float) -> None:
        """Step past `t_end` [s]; the state there is from CVODE's dense output."""
        call("CVode", self._memory, t_end, self._vector, byref(c_double()), NORMAL)

    def states(self, times: Any) -> np.ndarray:
        """The states at `times` [s], one row each; `times` starts with 0."""
        rows = np.empty((len(times), len(self._y)))
        rows[0] = self._y
        for row, t in zip(rows[1:], times[1:]):
            self.advance(t)
            row[:] = self._y
        return rows

    def calls(self) -> int:
        """Right-hand sides so far, including those for the Jacobian."""
        return self._landing.statistics()["rhs_calls"] - 1
