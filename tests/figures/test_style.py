"""Colours are those of one file, and no label of a film covers another."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from five_legs import five_legs
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from rlv_landing import Landing, load_preset
from rlv_landing.figures.moving_figure import MovingFigure
from rlv_landing.figures.style import page_css

ROOT = Path(__file__).resolve().parents[2]
STYLE = ROOT / "fmu_src" / "rlv_landing" / "figures" / "style.py"
FOLDERS = ("fmu_src", "ros_bridge", "examples", "benchmarks", "docs/site")
# of #rgb and #rrggbb; of grey levels and of matplotlib's own colours
COLOUR = re.compile(r"#[0-9a-fA-F]{6}\b|#[0-9a-fA-F]{3};|\"tab:\w+\"|color=\"(?:0\.\d+|C\d)\"")
KINDS = {".py", ".j2", ".css"}


def test_no_other_file_has_a_colour():
    files = [f for top in FOLDERS for f in (ROOT / top).rglob("*") if f.suffix in KINDS]
    assert len(files) > 200
    found = {
        file.relative_to(ROOT).as_posix(): colours
        for file in files
        if file != STYLE and (colours := COLOUR.findall(file.read_text(encoding="utf-8")))
    }
    assert found == {}


def test_pages_define_every_variable_that_they_use():
    css = page_css()
    used = set(re.findall(r"var\(--(\w+)\)", css))
    assert used
    assert used <= set(re.findall(r"--(\w+):", css))


@pytest.mark.parametrize("view", ["side", "3d"])
@pytest.mark.parametrize("mode", ["2-2", "1-2-1", "space"])
def test_no_label_of_a_film_covers_another(view, mode):
    parameters = five_legs() if mode == "space" else load_preset("yue2022-figures").for_mode(mode)
    history = Landing(parameters).run(0.3, 5e-3)
    rows = np.arange(0, len(history), 20)
    film = MovingFigure(history, history.parameters, rows, f"{mode} landing", view)
    canvas = FigureCanvasAgg(film.figure)
    canvas.draw()
    size, undrawn = film.figure.bbox, _undrawn(film.figure)
    labels = {
        text: text.get_window_extent()
        for text in film.figure.findobj(Text)
        if text.get_text().strip() and text.get_visible() and text not in undrawn
    }
    assert len(labels) > 15
    for (a, first), (b, second) in itertools.combinations(labels.items(), 2):
        assert not _overlap(first, second), (a.get_text(), b.get_text())
    for text, box in labels.items():
        if not size.overlaps(box):  # of a tick in space that is not drawn
            continue
        assert size.x0 <= box.x0 < box.x1 <= size.x1, text.get_text()
        assert size.y0 <= box.y0 < box.y1 <= size.y1, text.get_text()


def _overlap(first, second) -> bool:
    """Whether two boxes share more than a pixel in both directions."""
    across = min(first.x1, second.x1) - max(first.x0, second.x0)
    down = min(first.y1, second.y1) - max(first.y0, second.y0)
    return across > 1.0 and down > 1.0


def _undrawn(figure: Figure) -> set[Text]:
    """The labels of ticks beyond the limits of their axes."""
    found = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis, *((axes.zaxis,) if hasattr(axes, "zaxis") else ())):
            ticks = {*axis.get_major_ticks(), *axis.get_minor_ticks()}
            beyond = ticks.difference(axis._update_ticks())
            found |= {label for tick in beyond for label in (tick.label1, tick.label2)}
    return found
