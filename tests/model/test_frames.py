"""A history as a table of other libraries, and in a notebook."""

from __future__ import annotations

import sys
from xml.etree import ElementTree

import numpy as np
import pytest

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History

FORCE, STROKE = "leg[1].main_strut.force", "leg[1].main_strut.stroke"


@pytest.fixture(scope="module")
def history():
    return Landing().run(0.2, 1e-2)


def test_pandas_has_times_as_index_and_units(history):
    frame = history.to_pandas()
    assert frame.index.name == "time"
    assert np.array_equal(frame.index, history.time)
    assert list(frame.columns) == list(history.names)
    assert np.array_equal(frame.to_numpy(), history.data)
    assert (frame.attrs["units"][FORCE], frame.attrs["units"]["time"]) == ("N", "s")


def test_polars_has_all_columns(history):
    frame = history.to_polars()
    assert frame.columns == list(history)
    assert np.array_equal(frame[FORCE].to_numpy(), history[FORCE])


def test_xarray_has_units_on_each_variable(history):
    dataset = history.to_xarray()
    assert set(dataset.data_vars) == set(history.names)
    assert dataset[STROKE].attrs == {"units": "m"}
    assert dataset["time"].attrs == {"units": "s"}
    assert np.array_equal(dataset[STROKE].sel(time=history.time[7]), history[STROKE][7])


@pytest.mark.parametrize(
    ("library", "method"),
    [("pandas", "to_pandas"), ("polars", "to_polars"), ("xarray", "to_xarray")],
)
def test_a_missing_library_is_named(history, monkeypatch, library, method):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(LandingError, match=f"{library} is not installed.*pip install {library}"):
        getattr(history, method)()


def test_columns_of_one_unit_share_axes(history):
    from matplotlib.figure import Figure

    axes = Figure().subplots()
    assert history.plot(FORCE, "leg[3].main_strut.force", axes=axes) is axes
    assert [line.get_label() for line in axes.lines] == [FORCE, "leg[3].main_strut.force"]
    assert np.array_equal(axes.lines[0].get_ydata(), history[FORCE])
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time [s]", "[N]")


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ((FORCE, STROKE), "columns of the units N, m cannot share an axis"),
        ((), "units none cannot"),
        (("leg[1].main_strut.forse",), "did you mean"),
    ],
)
def test_columns_that_cannot_be_drawn_together_are_refused(history, names, words):
    with pytest.raises(LandingError, match=words):
        history.plot(*names)


def test_a_notebook_shows_each_columns_extremes(history):
    page = ElementTree.fromstring(f"<div>{history._repr_html_()}</div>")
    rows = {row[0].text: [cell.text for cell in row] for row in page.iter("tr")}
    assert list(rows)[1:] == list(history.names)
    assert rows[FORCE][1] == "N"
    assert float(rows[FORCE][2]) == pytest.approx(history.extreme(FORCE).minimum, rel=1e-4)
    empty = History(np.empty(0), ["a"], np.empty((0, 1)))
    assert empty._repr_html_() == "no samples"


@pytest.mark.parametrize("mode", ["2-2", "space"])
def test_landing_and_parameters_show_every_value_in_a_notebook(mode):
    landing = Landing(load_preset("yue2022-figures", mode))
    landing.step(0.1)
    for shown, names in (
        (landing, landing.interface.output_names),
        (landing.parameters, [name for name, _ in landing.parameters.items()]),
    ):
        page = ElementTree.fromstring(f"<div>{shown._repr_html_()}</div>")
        rows = [[cell.text for cell in row] for row in page.iter("tr")][1:]
        assert [row[0] for row in rows] == list(names)
    values = [row[1] for row in rows]
    assert values[0] == f"{landing.parameters.vehicle.mass:.6g}"
