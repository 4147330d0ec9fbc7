"""The landing in hand-written C (`c_landing.c`), compiled here by gcc.

It shows how fast the machine can do what the compiled core does.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from array import array
from collections.abc import Mapping
from ctypes import CDLL, POINTER, c_double, c_int, c_void_p
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from rlv_landing import Parameters
from rlv_landing.assembly import (
    begin,
    body_model,
    landing_system,
    leg_model,
    leg_models,
    leg_places,
)
from rlv_landing.assembly.spatial import spatial_model, spatial_places
from rlv_landing.core import Exponential, Solver
from rlv_landing.quantities import SPACE, interface_of

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "fmu_src"))
from fmu_build.core_source import COMPILE_ARGS, GCC_ARGS  # noqa: E402

# of the core's `BodyModel` and `LegModel`, which are the same for all legs here, in the order of
# the C struct that is made from them
PARAMETERS = (
    "m_u", "I_u", "m_d", "at_joint", "La", "Lb", "Lm0", "A1", "A2", "V10", "V20", "fill", "Pa",
    "rho0", "x_air", "n_air", "B0", "kB", "CdAo_c", "CdAo_r", "dP_lam", "Fc", "kp", "Fs", "v_str",
    "v_sm", "s_max", "K_stop", "c_stop", "Lc", "Ld", "Ls0", "Ka", "ek", "Ca", "g_t", "g_c",
    "k_play", "c_play", "F_0", "U_0", "alpha", "Kg", "en", "Cgmax", "d_ramp", "mu", "ar", "b_strib",
    "Cr", "tau_sr", "K_t", "zone", "g",
)  # fmt: skip
# of a landing in space, the body's and the ground's: those of `SpatialModel`
OF_BODY = ("m_u", "I_u", "at_joint", "alpha", "g")
IN_SPACE = (
    "m_u", "I_x", "I_y", "I_z", "I_xy", "I_xz", "I_yz", "cg_x", "cg_z", "at_joint", "g", "down_x",
    "down_y", "down_z", "along_x", "along_z", "normal_x", "normal_y", "normal_z",
    *(name for name in PARAMETERS if name not in OF_BODY),
)  # fmt: skip
# the core's own options, and options that may change the digits
EXACT: tuple[str, ...] = (*COMPILE_ARGS, *GCC_ARGS)
FAST: tuple[str, ...] = ("-O3", "-march=native", "-ffast-math")


@cache
def library(options: tuple[str, ...], *, space: bool = False) -> CDLL:
    """`c_landing.c` compiled with `options`, for symmetric landings or for those in space."""
    with tempfile.TemporaryDirectory(prefix="rlv_landing_") as folder:
        target = Path(folder) / "c_landing.so"
        names = [f"-DPARAMETERS={','.join(IN_SPACE if space else PARAMETERS)}"]
        names += ["-DSPACE"] * space
        command = [
            "gcc",
            "-std=gnu11",
            "-Wall",
            "-Wextra",
            "-Werror",
            *options,
            *names,
            "-shared",
            "-fPIC",
            "-o",
            str(target),
        ]
        subprocess.run([*command, str(HERE / "c_landing.c"), "-lm"], check=True)
        loaded = CDLL(str(target))
    doubles = POINTER(c_double)
    for name, result, arguments in (
        ("landing", c_void_p, (doubles, c_int, *(doubles,) * 4, c_double, doubles, doubles)),
        ("advance", c_int, (c_void_p, c_double)),
        ("interpolate", None, (c_void_p, c_double, doubles)),
        ("counts", None, (c_void_p, doubles)),
        ("release", None, (c_void_p,)),
    ):
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded


def doubles(values: Any) -> Any:
    """A C array of doubles."""
    return (c_double * len(values))(*values)


def core_solver(parameters: Parameters, rtol: float) -> Solver:
    """The core at the start of a landing, symmetric or in space."""
    solver = Exponential(landing_system(parameters), rtol)
    none = (0.0,) * len(interface_of(parameters.drop.mode).inputs)
    begin(solver, parameters, none, none)
    return solver


class CLanding:
    """One landing in C, from the start of a landing with the same parameters.

    Args:
        parameters: The vehicle, its ground and its drop.
        rtol: Relative tolerance.
        options: Options of gcc.
        inputs: Inputs at time 0, by name [SI].
        rates: Rates at which the inputs change, by name [SI/s].

    Raises:
        MemoryError: No memory for the landing.
        ArithmeticError: The step size has collapsed.
    """

    def __init__(
        self,
        parameters: Parameters,
        rtol: float,
        options: tuple[str, ...] = EXACT,
        inputs: Mapping[str, float] | None = None,
        rates: Mapping[str, float] | None = None,
    ) -> None:
        space = parameters.drop.mode == SPACE
        solver = core_solver(parameters, rtol)
        if space:
            body, places = spatial_model(parameters), spatial_places(parameters)
            legs = [leg_model(parameters)] * len(places)
        else:
            body, legs, places = (
                body_model(parameters),
                leg_models(parameters),
                leg_places(parameters),
            )
        names = IN_SPACE if space else PARAMETERS
        input_names = interface_of(parameters.drop.mode).input_names
        groups = [x for place in places for x in place]
        numbers = {**legs[0]._asdict(), **body._asdict()}
        self.n, self.controlled = solver.n, solver.system.controlled
        self._library = library(options, space=space)
        self._landing = self._library.landing(
            doubles([numbers[name] for name in names]),
            len(legs),
            *(
                doubles(a)
                for a in (
                    groups,
                    list(solver.y),
                    list(solver.system.scale),
                    list(solver.system.relative),
                )
            ),
            rtol,
            *(
                doubles([(values or {}).get(name, 0.0) for name in input_names])
                for values in (inputs, rates)
            ),
        )
        if not self._landing:
            raise MemoryError("no memory for a landing in C")

    def __del__(self) -> None:
        if getattr(self, "_landing", None):
            self._library.release(self._landing)

    def advance(self, t_end: float) -> None:
        """Step until `t_end` [s] is reached."""
        if not self._library.advance(self._landing, t_end):
            raise ArithmeticError("the step size of the landing in C has collapsed")

    def states(self, times: Any) -> np.ndarray:
        """The states at `times` [s], one row each."""
        rows, one = np.empty((len(times), self.n)), (c_double * self.n)()
        for row, t in zip(rows, times):
            self.advance(t)
            self._library.interpolate(self._landing, t, one)
            row[:] = one
        return rows

    def statistics(self) -> dict[str, int]:
        """Counts as in `Landing.statistics`."""
        three = (c_double * 3)()
        self._library.counts(self._landing, three)
        return dict(zip(("steps", "rejected", "rhs_calls"), map(int, three)))


def core_states(solver: Solver, times: Any) -> np.ndarray:
    """The states of the core at `times` [s], one a row.

    Raises:
        ArithmeticError: The step size has collapsed.
    """
    rows, one = np.empty((len(times), solver.n)), array("d", bytes(8 * solver.n))
    for row, t in zip(rows, times):
        if not solver.advance(t):
            raise ArithmeticError("the step size of the core has collapsed")
        solver.interpolate(t, one)
        row[:] = one
    return rows


def disagreement(solver: Solver, c_landing: CLanding, until: float) -> float:
    """Largest relative difference of any state between core and C, without the energy integrals.

    Args:
        solver: The core's landing.
        c_landing: The landing in C from the same start.
        until: End [s]; states are compared every millisecond.

    Returns:
        The difference in parts of the state's largest value. Infinite if the numbers of steps,
        rejected steps or right-hand sides differ.
    """
    times = 1e-3 * np.arange(round(until / 1e-3) + 1)
    n = c_landing.controlled
    core, c = (states[:, :n] for states in (core_states(solver, times), c_landing.states(times)))
    if (solver.steps, solver.rejected, solver.rhs_calls) != tuple(c_landing.statistics().values()):
        return np.inf
    largest = np.abs(core).max(axis=0)
    return float((np.abs(core - c).max(axis=0) / np.where(largest > 0.0, largest, 1.0)).max())
