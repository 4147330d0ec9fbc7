"""A landing in Rerun: the vehicle in space beside its curves, over simulation time.

Needs rerun-sdk.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, NamedTuple

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from rlv_landing.core import SpatialInputs
from rlv_landing.figures.ground.drawn import in_view
from rlv_landing.figures.ground.shape import GroundShape
from rlv_landing.figures.ground.turn import deck_matrix, deck_place
from rlv_landing.figures.plots import DRAWN_OF_A_LEG, SECOND_FORCE, legs_together
from rlv_landing.figures.style import COLOURS, FORCE, GRID, INK, PAPER
from rlv_landing.parameters import Parameters
from rlv_landing.quantities import LEGS, RADIAL, SPACE, TRIPOD, interface_of
from rlv_landing.text.durable import whole_file, writing

Array = NDArray[np.float64]
TIMELINE = "sim_time"
BODY, MAIN, AUXILIARY, FOOTPADS, CONTACT, FLOOR = (
    f"vehicle/{part}"
    for part in ("body", "main_struts", "auxiliary_struts", "footpads", "contact_force", "ground")
)
# Radii of lines and footpads [m], and the length of an arrow [m/N].
RADII = {BODY: 0.012, MAIN: 0.03, AUXILIARY: 0.015, FOOTPADS: 0.05, CONTACT: 0.03, FLOOR: 0.004}
ARROW_LENGTH = 3e-4
# How far the ground is drawn at least in each direction [m].
GROUND_REACH = 3.0
# Where the view looks from and to [m].
EYE, TARGET = (-2.0, -7.5, 2.2), (0.2, 0.0, 1.3)


class Curve(NamedTuple):
    """A plot of one or more columns.

    `lines` gives the column of each line by its name. `factor` converts from SI to the unit in the
    title.
    """

    entity: str
    title: str
    lines: Mapping[str, str]
    factor: float
    colours: tuple[str, ...]


def curves(mode: str, legs: Sequence[int] = LEGS, kind: str = RADIAL) -> list[Curve]:
    """The plots of a landing in `mode` on `legs` of a kind."""
    together = legs_together(mode, legs)
    names = {f"leg {'/'.join(map(str, group))}": group[0] for group in together}

    def strut(column: str, factor: float, title: str) -> Curve:
        return Curve(
            column.replace(".", "/"),
            title,
            {name: f"leg[{leg}].{column}" for name, leg in names.items()},
            factor,
            COLOURS[: len(names)],
        )

    return [
        *(strut(*drawn) for drawn in DRAWN_OF_A_LEG),
        *([strut(*SECOND_FORCE)] if kind == TRIPOD else []),
        *(_body_in_space() if mode == SPACE else _body_in_a_plane()),
    ]


def _body_in_a_plane() -> tuple[Curve, Curve]:
    speeds = {"forward": "body.vx", "up": "body.vy"}
    return (
        Curve("body/pitch", "pitch [deg]", {"pitch": "body.pitch"}, float(np.degrees(1.0)), (INK,)),
        Curve("body/speed", "speed [m/s]", speeds, 1.0, (INK, FORCE)),
    )


def _body_in_space() -> tuple[Curve, Curve]:
    angles = {name: f"body.{name}" for name in ("pitch", "roll", "heading")}
    speeds = {"forward": "body.vx", "up": "body.vy", "right": "body.vz"}
    return (
        Curve("body/attitude", "attitude [deg]", angles, float(np.degrees(1.0)), COLOURS[:3]),
        Curve("body/speed", "speed [m/s]", speeds, 1.0, (INK, FORCE, COLOURS[0])),
    )


class Scene:
    """A recording of a landing in `mode` on so many `legs` of a `kind`.

    Lengths are in m, times in s, axes as in REP-103 (x forward, y left, z up).
    """

    def __init__(self, mode: str, legs: int = len(LEGS), kind: str = RADIAL) -> None:
        self.interface = interface_of(mode, legs, kind)
        self.stream = rr.RecordingStream("rlv-landing")
        colours = {
            leg: rgb(colour)
            for group, colour in zip(legs_together(mode, self.interface.legs), COLOURS)
            for leg in group
        }
        shades = [colours[leg] for leg in self.interface.legs]
        self._log("/", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        for part, colour in (
            (BODY, [rgb(INK)]),
            (MAIN, shades),
            (AUXILIARY, shades),
            (FLOOR, [rgb(GRID)]),
        ):
            self._log(part, rr.LineStrips3D.from_fields(radii=RADII[part], colors=colour))
        self._log(FOOTPADS, rr.Points3D.from_fields(radii=RADII[FOOTPADS], colors=[rgb(INK)]))
        self._log(CONTACT, rr.Arrows3D.from_fields(radii=RADII[CONTACT], colors=[rgb(FORCE)]))
        self._curves = curves(mode, self.interface.legs, kind)
        for curve in self._curves:
            self._log(
                curve.entity,
                rr.SeriesLines(
                    colors=[rgb(c) for c in curve.colours], names=list(curve.lines), widths=[1.5]
                ),
            )

    def _log(self, entity: str, what: Any) -> None:
        rr.log(entity, what, static=True, recording=self.stream)

    def _send(self, entity: str, time: Array, columns: Any) -> None:
        rr.send_columns(
            entity, [rr.TimeColumn(TIMELINE, duration=time)], columns, recording=self.stream
        )

    def ground(self, parameters: Parameters, reach: float = 0.0) -> None:
        """Draws the ground of a landing, its deck at rest.

        Args:
            parameters: the landing's.
            reach: how far it goes at least in each direction [m].
        """
        ends = (-max(reach, GROUND_REACH), max(reach, GROUND_REACH))
        strips = [in_view(line) for line in GroundShape(parameters, ends, ends).lines()]
        self._log(FLOOR, rr.LineStrips3D.from_fields(strips=strips))

    def decks(self, time: Array, decks: Sequence[SpatialInputs]) -> None:
        """Moves the ground with its deck.

        Args:
            time: (times,) [s].
            decks: the deck at each time.
        """
        self._send(
            FLOOR,
            time,
            rr.Transform3D.columns(
                translation=np.array([deck_place(deck) for deck in decks]),
                mat3x3=np.array([deck_matrix(deck) for deck in decks]),
            ),
        )

    def curves(self, time: Array, columns: Mapping[str, Array]) -> None:
        """Adds samples to the plots.

        Args:
            time: (times,) [s].
            columns: outputs by name, each (times,), SI.
        """
        for curve in self._curves:
            values = (
                np.stack([columns[name] for name in curve.lines.values()], axis=-1) * curve.factor
            )
            self._send(
                curve.entity,
                time,
                rr.Scalars.columns(scalars=values.ravel()).partition([values.shape[1]] * len(time)),
            )

    def lines(self, entity: str, time: Array, lines: Iterable[Array]) -> None:
        """Adds lines of the part `entity`.

        Args:
            entity: the part of the vehicle.
            time: (times,) [s].
            lines: arrays (times, lines, points, 3) [m].
        """
        each = [list(group) for group in zip(*lines)]
        strips = [strip for group in each for part in group for strip in part]
        counts = [sum(len(part) for part in group) for group in each]
        self._send(entity, time, rr.LineStrips3D.columns(strips=strips).partition(counts))

    def footpads(self, time: Array, feet: Array) -> None:
        """Adds footpads.

        Args:
            time: (times,) [s].
            feet: (times, legs, 3) [m].
        """
        self._send(
            FOOTPADS,
            time,
            rr.Points3D.columns(positions=feet.reshape(-1, 3)).partition(
                [feet.shape[1]] * len(time)
            ),
        )

    def contacts(self, time: Array, feet: Array, forces: Array) -> None:
        """Adds the ground's forces on the footpads.

        Args:
            time: (times,) [s].
            feet: where they act, (times, legs, 3) [m].
            forces: (times, legs, 3) [N].
        """
        arrows = rr.Arrows3D.columns(
            origins=feet.reshape(-1, 3), vectors=ARROW_LENGTH * forces.reshape(-1, 3)
        )
        self._send(CONTACT, time, arrows.partition([feet.shape[1]] * len(time)))

    @staticmethod
    def _has_own_legend(curve: Curve) -> bool:
        return curve.entity.startswith("body/") and len(curve.lines) > 1

    def blueprint(self, *, live: bool) -> Any:
        """The layout: the vehicle on the left, plots on the right.

        Args:
            live: follow the newest sample; otherwise play five times slower, in a loop.
        """
        # The first plot's legend is that of all plots of legs; the body's have their own.
        plots = [
            rrb.TimeSeriesView(
                origin=f"/{c.entity}",
                name=c.title,
                plot_legend=rrb.PlotLegend(
                    "RightBottom", visible=i == 0 or self._has_own_legend(c)
                ),
            )
            for i, c in enumerate(self._curves)
        ]
        vehicle = rrb.Spatial3DView(
            origin="/vehicle",
            name="vehicle",
            background=rgb(PAPER),
            line_grid=False,
            eye_controls=rrb.EyeControls3D(
                position=EYE, look_target=TARGET, eye_up=(0.0, 0.0, 1.0)
            ),
        )
        time = rrb.TimePanel(
            state="collapsed",
            timeline=TIMELINE,
            **(
                {"play_state": "following"}
                if live
                else {"play_state": "playing", "loop_mode": "all", "playback_speed": 0.2}
            ),
        )
        layout = rrb.Horizontal(vehicle, rrb.Vertical(*plots), column_shares=[1.0, 1.0])
        return rrb.Blueprint(
            layout,
            time,
            rrb.BlueprintPanel(state="collapsed"),
            rrb.SelectionPanel(state="collapsed"),
        )


class SavedScene:
    """Writes a scene to `path`, whole or not at all.

    Rerun hands its bytes over in the end, and has them in memory until then: where it writes a file
    itself, a full disk stops it for ever.

    Raises:
        LandingError: it cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._whole = ExitStack()
        self._file: BinaryIO | None = None
        self._stream: Any = None

    def begin(self, scene: Scene) -> None:
        """Takes what `scene` holds, and what is added to it from now on."""
        self._stream = rr.binary_stream(recording=scene.stream)
        scene.stream.send_blueprint(scene.blueprint(live=False))

    def finish(self) -> None:
        """Completes the file, and gives it its name."""
        assert self._file is not None
        with writing(self._path):
            # the parts of several reads are no recording
            self._file.write(self._stream.read() or b"")
            self._whole.close()

    def __enter__(self) -> SavedScene:
        with writing(self._path):
            self._file = self._whole.enter_context(whole_file(self._path))
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        # a file that is not finished is not kept, whatever ends it
        with suppress(_UnfinishedError):
            self._whole.__exit__(_UnfinishedError, _UnfinishedError(), None)


class _UnfinishedError(Exception):
    pass


def rgb(colour: str) -> tuple[int, ...]:
    """The colour `#rrggbb` as three numbers from 0 to 255."""
    return tuple(bytes.fromhex(colour[1:]))
