"""The pictures of studies: nothing is cut off, and what has no bar is named."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.text import Text

from rlv_landing import load_preset
from rlv_landing.figures.envelope.figure import save_envelope
from rlv_landing.figures.envelope.sides import _mesh
from rlv_landing.figures.sensitivity_figure import save_bars
from rlv_landing.studies.envelope.search import envelope
from rlv_landing.studies.envelope.study import Axis, EnvelopeStudy
from rlv_landing.studies.sweep.sensitivity import Indices
from rlv_landing.tables.sweep_tables import indices_table

FACTORS = ("drop.vertical_velocity", "drop.tilt", "main_strut.orifice_area_compression")
SURE = [[0.3, 0.25, 0.35], [0.5, 0.4, 0.6], [0.0, -0.02, 0.02]]
WIDE = [[0.3, -0.5, 0.95], [2.7, 0.99, 40.9], [0.0, -0.02, 0.02]]
NONE = [[np.nan] * 3] * 3


def indices(response: str, values: list[list[float]], used: int = 64) -> Indices:
    return Indices(response, "2-2", FACTORS, np.array(values), np.array(values), used, 64)


@pytest.fixture
def saved(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Every figure that is saved."""
    figures: list[Figure] = []
    save = Figure.savefig

    def keep(figure: Figure, *args: object, **options: object) -> None:
        figures.append(figure)
        save(figure, *args, **options)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


def texts(figure: Figure) -> list[str]:
    return [t.get_text() for t in figure.findobj(Text)]


def nothing_is_cut_off(path: Path) -> bool:
    """Whether the picture has a white margin all round: what is cut off has ink at the edge."""
    pixels = imread(path)[..., :3]
    edges = (pixels[:4], pixels[-4:], pixels[:, :4], pixels[:, -4:])
    return all((edge == 1.0).all() for edge in edges)


def test_panels_above_an_empty_place_have_numbers_and_covered_boundaries_show(saved, tmp_path):
    """Four panels are in two rows of three; families of one panel may have the same boundary."""
    parameters = load_preset("yue2022-figures", "2-2").with_values({"drop.contact_time": 0.0})
    study = EnvelopeStudy(
        parameters,
        Axis("drop.horizontal_velocity", -6.0, 6.0, 6.0),
        Axis("drop.tilt", -0.3, 0.3, 0.3),
        families=tuple(
            {"main_strut.orifice_area_compression": area, "ground.friction": friction}
            for area in (6e-6, 7e-6)
            for friction in (0.3, 0.4, 0.5, 0.6)
        ),
        cells=2,
        levels=0,
        until=0.3,
    )
    save_envelope(envelope(study, 2), tmp_path / "e.png")
    (figure,) = saved
    panels = [ax for ax in figure.axes if ax.get_visible()]
    assert len(panels) == 4
    for ax in panels:
        assert bool(ax.get_xlabel()) == any(t.get_visible() for t in ax.get_xticklabels())
    widths = [line.get_linewidth() for line in figure.legends[0].get_lines()[:2]]
    assert widths[0] > widths[1] + 1.0


@pytest.mark.parametrize("families", [1, 2])
def test_the_legend_of_an_envelope_is_whole_with_one_family_too(saved, tmp_path, families):
    parameters = load_preset("yue2022-figures", "2-2").with_values({"drop.contact_time": 0.0})
    study = EnvelopeStudy(
        parameters,
        Axis("drop.horizontal_velocity", -6.0, 6.0, 0.5),
        Axis("drop.tilt", -0.3, 0.3, 0.05),
        families=tuple({"main_strut.orifice_area_compression": 6e-6 + k * 1e-6}
                       for k in range(families)),
        criterion="limit",
        limits={"auxiliary_strut.force": 6000.0, "body.top_axial_acceleration": 40.0},
        cells=2,
        levels=0,
        until=0.5,
    )  # fmt: skip
    save_envelope(envelope(study, 2), tmp_path / "e.png")
    ((legend,),) = (figure.legends for figure in saved)
    shown = [text.get_text() for text in legend.get_texts()]
    assert any("passes body.top_axial_acceleration first" in text for text in shown)
    assert "shaded: not lost" in shown
    assert "not lost" in texts(saved[0])
    assert nothing_is_cut_off(tmp_path / "e.png")
    (figure,) = saved
    limits = "(auxiliary_strut.force 6 kN, body.top_axial_acceleration 40 m/s2)"
    assert limits in figure.get_suptitle()


def test_one_wide_interval_leaves_all_axes_from_0_to_1(saved, tmp_path):
    save_bars([indices("a", SURE), indices("b", WIDE)], tmp_path / "b.png", "study")
    (figure,) = saved
    panels: list[Axes] = [a for a in figure.axes if a.axison]
    assert len(panels) == 2
    for panel in panels:
        low, high = panel.get_xlim()
        assert -0.5 < low < 0.0
        assert 1.0 < high < 1.5
    assert texts(figure).count("too few samples") == 2
    assert any("40.9" in text for text in texts(figure))
    assert nothing_is_cut_off(tmp_path / "b.png")


@pytest.mark.parametrize("with_others", [True, False])
def test_constant_and_missing_responses_are_named_in_picture_and_table(
    saved, tmp_path, with_others
):
    found = [indices("margin.slid", NONE), indices("outcome.first_limit_time", NONE, used=3)]
    if with_others:
        found.append(indices("a", SURE))
    path: Path = tmp_path / "b.png"
    save_bars(found, path, "study")
    below = "\n".join(texts(saved[0]))
    table = indices_table(found, 0.95)
    for line in (
        "margin.slid, 2-2: no indices: it does not vary",
        "outcome.first_limit_time, 2-2: no indices: 3 of 64 samples have it",
    ):
        assert line in below
        assert line in table
    assert nothing_is_cut_off(path)


def test_indices_from_too_few_samples_say_so():
    assert [indices("b", WIDE).enough(k) for k in range(3)] == [False, False, True]
    table = indices_table([indices("b", WIDE)], 0.95)
    rows = [row for row in table.splitlines() if "│ b" in row]
    assert ["too few samples" in row for row in rows] == [True, True, False]
    assert "take more than 64, for example 256" in table
    assert "too few samples" not in indices_table([indices("a", SURE)], 0.95)
    (record,) = [indices("b", WIDE).record()]
    assert [entry["enough_samples"] for entry in record["indices"]] == [False, False, True]
    outside = indices("c", [[2.7, 2.6, 2.8], *SURE[1:]])
    assert not outside.enough(0)


@pytest.mark.parametrize("tolerance", [0.001, 1.0])
def test_the_side_that_is_not_lost_is_shaded_up_to_the_boundary(tolerance):
    """A boundary along the middle: what lies on the lost side is 0 or above, whatever is near."""
    from matplotlib.tri import LinearTriInterpolator

    study = EnvelopeStudy(
        load_preset("yue2022-figures"),
        x=Axis("drop.horizontal_velocity", -6.0, 6.0, 12.0 * tolerance),
        y=Axis("drop.tilt", -0.3, 0.3, 0.6 * tolerance),
        criterion="toppled",
    )
    landings = [
        (x, y, SimpleNamespace(lost=lambda _, x=x: x > 0.0))
        for x in (-6.0, -3.0, -0.005, 0.005, 3.0, 6.0)
        for y in (-0.3, 0.0, 0.3)
    ]
    line = [SimpleNamespace(x=0.0, y=y) for y in (-0.3, -0.1, 0.1, 0.3)]
    mesh, values = _mesh(
        SimpleNamespace(study=study), SimpleNamespace(landings=landings, lines=[line])
    )
    x, y = np.meshgrid(np.linspace(-5.9, 5.9, 60), np.linspace(-0.29, 0.29, 30))
    found = LinearTriInterpolator(mesh, values)(x, np.degrees(y))
    assert (np.ma.filled(found, 1.0) < 0.0).tolist() == (x < 0.0).tolist()
