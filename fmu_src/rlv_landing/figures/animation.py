"""A landing as a moving picture: the vehicle beside its force and stroke curves.

It is the moving form of the paper's Figs. 12 and 18.
"""

from __future__ import annotations

import logging
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from subprocess import CalledProcessError
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..effort import check_memory
from ..errors import LandingError
from ..history import History
from ..quantities import SPACE
from ..signals.handlers import ENDING
from ..text.durable import PART, temporary_name, unwritable
from .moving_figure import WIDTH, MovingFigure

if TYPE_CHECKING:
    from ..parameters import Parameters

ENDINGS = (".gif", ".mp4")
MOST_FRAMES = 3000
# matplotlib cuts a frame's milliseconds to a whole number, so 30 must not come out as 29.999
BELOW = 1.0 - 1e-12
# a GIF counts a frame's time in hundredths of a second; most viewers show a frame of less than two
# for ten
GIF_TICKS, GIF_LEAST = 100.0, 2


@dataclass(frozen=True)
class Film:
    """The settings of an animation.

    Attributes:
        fps: Frames a second.
        slow_motion: Factor by which the animation is slower than the landing.
        start: First time shown [s]; None for the landing's first.
        end: Last time shown [s]; None for the landing's last.
        view: `side`, along z, or `3d`; None: `3d` in space, else `side`.
        width: Width of the picture [pixels].
    """

    fps: float = 25.0
    slow_motion: float = 5.0
    start: float | None = None
    end: float | None = None
    view: Literal["side", "3d"] | None = None
    width: int = 960


@dataclass(frozen=True)
class Filmed:
    """The number of frames written, and the frames a second.

    A GIF's frame rate is rounded to a value that the format has.
    """

    frames: int
    fps: float


def save_animation(
    history: History,
    parameters: Parameters,
    path: str | Path,
    title: str,
    film: Film = Film(),
    progress: Callable[[int, int], None] | None = None,
) -> Filmed:
    """Write the animation of `history` to `path`, whole or not at all.

    Every frame shows the sample nearest to its time; no sample is interpolated.

    Args:
        history: The landing's columns over time.
        parameters: The vehicle and its ground.
        path: The file; its ending, `.gif` or `.mp4`, is the format.
        title: The figure's title.
        film: The settings.
        progress: Called with the frames done and the number of all frames.

    Raises:
        LandingError: Another ending, a setting out of bounds, no samples between start and end, no
            ffmpeg, or the disk refuses.
    """
    path = Path(path)
    if path.suffix not in ENDINGS:
        raise LandingError(f"{path} must end in {' or '.join(ENDINGS)}")
    fps = _frames_per_second(film, path.suffix)
    rows = frame_rows(history, film, fps)
    if path.suffix == ".gif":
        # its writer keeps every frame until the end; a frame is half as high as wide, or higher
        check_memory(
            f"a GIF of {len(rows)} frames, {film.width} pixels wide,",
            2.0 * len(rows) * film.width**2,
            "take fewer or smaller frames, or write an .mp4",
        )
    view = film.view or ("3d" if parameters.drop.mode == SPACE else "side")
    figure = MovingFigure(history, parameters, rows, title, view)
    unfinished = temporary_name(path, f"{PART}{path.suffix}")
    try:
        # where it cannot be made, ffmpeg says so in lines of its own
        unfinished.touch()
        with _writer_class(path.suffix) as writer_class, _without_ffmpegs_lines():
            _write(writer_class(fps=fps * BELOW), figure, unfinished, film.width / WIDTH, progress)
        unfinished.replace(path)
    except OSError as e:
        raise unwritable(path, e) from None
    except CalledProcessError as e:
        raise LandingError(
            f"{path} cannot be written: ffmpeg ended with {e.returncode}{_last_line(e.stderr)}; "
            "make room, name another, or try a .gif"
        ) from None
    finally:
        with suppress(OSError):
            unfinished.unlink()
    return Filmed(len(rows), fps)


def _last_line(text: bytes | str | None) -> str:
    """The last line that a program wrote, behind a colon; empty where it wrote none."""
    plain = text.decode("utf-8", "replace") if isinstance(text, bytes) else text or ""
    lines = plain.strip().splitlines()
    return f": {lines[-1]}" if lines else ""


@contextmanager
def _without_ffmpegs_lines() -> Iterator[None]:
    """Keep matplotlib from printing what ffmpeg said; the error has it."""
    logger = logging.getLogger("matplotlib.animation")
    before = logger.disabled
    logger.disabled = True
    try:
        yield
    finally:
        logger.disabled = before


def frame_rows(history: History, film: Film, fps: float) -> NDArray[np.intp]:
    """The row of `history` that each frame shows.

    Raises:
        LandingError: No samples are there, or the frames are too many.
    """
    time = history.time
    start = float(time[0]) if film.start is None else film.start
    end = float(time[-1]) if film.end is None else film.end
    if not time[0] <= start < end <= time[-1]:
        raise LandingError(
            f"start = {start:g} s and end = {end:g} s must lie in {time[0]:g} to {time[-1]:g} s, "
            "which the landing has, start before end"
        )
    count = int(np.floor((end - start) * film.slow_motion * fps + 1e-9)) + 1
    if not 2 <= count <= MOST_FRAMES:
        raise LandingError(
            f"that makes {count} frames; 2 to {MOST_FRAMES} can be: "
            "change fps, slow motion, start or end"
        )
    wanted = start + np.arange(count) / (fps * film.slow_motion)
    right = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    return right - (wanted - time[right - 1] < time[right] - wanted)


def _frames_per_second(film: Film, ending: str) -> float:
    for name, value, low, high in (
        ("fps", film.fps, 1.0, 120.0),
        ("slow motion", film.slow_motion, 0.01, 1000.0),
        ("width", film.width, 320, 3840),
    ):
        if not low <= value <= high:
            raise LandingError(
                f"{name} = {value:g} is outside [{low:g}, {high:g}]"
                f"{' pixels' if name == 'width' else ''}"
            )
    if ending != ".gif":
        return film.fps
    return GIF_TICKS / max(GIF_LEAST, round(GIF_TICKS / film.fps))


@contextmanager
def _writer_class(ending: str) -> Iterator[Any]:
    """Matplotlib's writer for the format `ending`.

    For a film it is ffmpeg of the wheel imageio-ffmpeg, else the ffmpeg on the path.
    """
    import matplotlib as mpl
    from matplotlib.animation import FFMpegWriter, PillowWriter

    if ending == ".gif":
        yield PillowWriter
        return
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        program = get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        program = shutil.which("ffmpeg")
    if program is None:
        raise LandingError(
            'mp4 needs ffmpeg; install it with pip install "rlv-landing[video]", or write a .gif'
        )

    with mpl.rc_context({"animation.ffmpeg_path": program, "animation.codec": "h264"}):
        yield FFMpegWriter


@contextmanager
def _signals_blocked() -> Iterator[None]:
    """Block the signals that end the program.

    Programs that are started here never get them: ffmpeg ends with its input.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _write(
    writer: Any,
    figure: MovingFigure,
    path: Path,
    dpi: float,
    progress: Callable[[int, int], None] | None,
) -> None:
    stopped: BaseException | None = None
    try:
        with ExitStack() as saving:
            with _signals_blocked():
                saving.enter_context(writer.saving(figure.figure, str(path), dpi))
            try:
                for i in range(figure.frames):
                    figure.show(i)
                    writer.grab_frame()
                    if progress is not None:
                        progress(i + 1, figure.frames)
            except BaseException as e:
                stopped = e
    except Exception:
        # the writer cannot finish a GIF without a frame
        if stopped is None:
            raise
    if stopped is not None:
        raise stopped
