"""The files of an identification: a search resumes from them; files that do not fit are refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rlv_landing import LandingError, load_preset
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.global_search import GlobalSearch
from rlv_landing.identification.objective import Objective
from rlv_landing.identification.search_folder import Best, SearchFolder
from rlv_landing.identification.targets import Wanted, paper_targets

FREE = ["ground.friction", "main_strut.stop_damping"]
BASE = load_preset("yue2022-figures")
START = [0.3, 0.6]


def generations(search: GlobalSearch, count: int) -> np.ndarray:
    """The points that the next generations ask for, in a bowl whose bottom is at 0.7."""
    asked = []
    for _ in range(count):
        points = np.array(search.ask())
        search.tell(((points - 0.7) ** 2).sum(axis=1).tolist())
        asked.append(points)
    return np.array(asked)


def objective(
    names: list[str] = FREE,
    bounds: dict[str, tuple[float, float]] | None = None,
    targets: list[Wanted] | None = None,
    *,
    sensors: bool = False,
) -> Objective:
    numbers = FreeNumbers(BASE, names, bounds)
    return Objective(numbers, paper_targets() if targets is None else targets, sensors=sensors)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder of a search that was interrupted after three generations."""
    files = SearchFolder(tmp_path / "work", objective())
    files.create()
    files.save_best(Best([0.4, 0.5], 12.0, 25, "global search", 3, start_loss=20.0))
    search = GlobalSearch(START, 0.1, 8, 3)
    generations(search, 3)
    files.save_state(search)
    return tmp_path / "work"


@given(st.integers(1, 2**31 - 1), st.integers(4, 12), st.integers(0, 6))
def test_a_restored_search_asks_for_the_points_that_the_first_asks_for(seed, population, count):
    first = GlobalSearch(START, 0.1, population, seed)
    generations(first, count)
    again = GlobalSearch.restored(json.loads(json.dumps(first.state())))
    # deviates drawn by others are no concern of the search
    np.random.standard_normal(7)
    assert np.array_equal(generations(first, 3), generations(again, 3))


def test_a_generation_that_was_asked_for_and_not_judged_is_asked_for_again():
    search = GlobalSearch(START, 0.1, 8, 3)
    generations(search, 2)
    state = search.state()
    points = search.ask()
    assert GlobalSearch.restored(state).ask() == points


def test_best_point_and_search_come_back(folder):
    best, search = SearchFolder(folder, objective()).load()
    assert best == Best(
        [0.4, 0.5], 12.0, 25, "global search", 3, None, 0, 0, 20.0, best.start_missed
    )
    expected = GlobalSearch(START, 0.1, 8, 3)
    generations(expected, 3)
    assert search is not None
    assert search.state() == expected.state()


@pytest.mark.parametrize(
    ("other", "what"),
    [
        (lambda: objective(FREE[:1]), "other free numbers"),
        (lambda: objective(bounds={"ground.friction": (0.1, 0.2)}), "other free numbers"),
        (lambda: objective(targets=paper_targets()[:5]), "other targets"),
        (lambda: objective(sensors=True), "other sensors"),
    ],
)
def test_files_of_another_search_are_refused(folder, other, what):
    with pytest.raises(LandingError, match=rf"best\.json is of another search, with {what}; "):
        SearchFolder(folder, other()).load()
    (folder / "best.json").unlink()
    files = SearchFolder(folder, other())
    files.save_best(Best([0.5] * len(other().free), 1.0, 1, "start", 1))
    with pytest.raises(LandingError, match=rf"search\.json is of another search, with {what}; "):
        files.load()


@pytest.mark.parametrize("name", ["best.json", "search.json"])
def test_torn_files_are_refused_wherever_they_are_torn(folder, name):
    whole = (folder / name).read_bytes()
    for length in range(0, len(whole), 97):
        (folder / name).write_bytes(whole[:length])
        with pytest.raises(LandingError, match=rf"{name} cannot be (read|resumed) \("):
            SearchFolder(folder, objective()).load()


def _drop(key: str) -> Callable[[dict], None]:
    return lambda state: state.pop(key)


def _alter_loss(state: dict) -> None:
    worst = int(np.argmax(state["losses"][1]))
    state["losses"][1][worst] = 0.0


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("search.json", _alter_loss, "its losses do not lead to its mean"),
        ("search.json", lambda s: s["losses"].pop(), "its losses do not lead to its mean"),
        ("search.json", lambda s: s["losses"][0].pop(), "inhomogeneous|reshape"),
        ("search.json", lambda s: s.update(losses=[[1.0] * 8, [float("nan")] * 8]), "not finite"),
        ("search.json", _drop("mean"), "it is incomplete: KeyError\\('mean'\\)"),
        ("search.json", _drop("search"), "it does not say of which search it is"),
        ("best.json", _drop("search"), "it does not say of which search it is"),
        ("best.json", _drop("loss"), "missing 1 required positional argument: 'loss'"),
        ("best.json", lambda b: b["z"].pop(), "its point is incomplete"),
        ("best.json", lambda b: b.update(loss=float("nan")), "its loss nan is none"),
        ("best.json", lambda b: b.update(z="ab"), "its point is incomplete"),
        ("best.json", lambda b: b.update(z=["a", "b"]), "its point is incomplete"),
        ("best.json", lambda b: b.update(loss="a"), "its loss a is none"),
        ("best.json", lambda b: b.update(evaluations="many"), "its evaluations = 'many' is no"),
        ("best.json", lambda b: b.update(evaluations=-5), "its evaluations = -5 is no whole"),
        ("best.json", lambda b: b.update(counted=1.5), "its counted = 1.5 is no whole"),
        ("best.json", lambda b: b.update(missed="x"), "its missed = 'x' is no number"),
        ("best.json", lambda b: b.update(start_loss=None), "its loss at the start is none"),
        ("best.json", lambda b: b.update(stage=5), "its stage = 5 is no text"),
        ("best.json", lambda b: b.update(more=1), "unexpected keyword argument 'more'"),
        ("search.json", lambda s: s.update(population=-3), "its population = -3 is not from 4"),
        ("search.json", lambda s: s.update(population=10**9), "its population = 1000000000 is not"),
        ("search.json", lambda s: s.update(population=8.0), "its population = 8.0 is not"),
        ("search.json", lambda s: s.update(sigma=-1.0), "its sigma = -1.0 is not from 0.0001 to 1"),
        ("search.json", lambda s: s.update(sigma="a"), "its sigma = 'a' is not"),
        ("search.json", lambda s: s.update(seed="a"), "its seed = 'a' is not"),
        ("search.json", lambda s: s.update(start=[0.5]), "its start is incomplete"),
        ("search.json", lambda s: s.update(start=["a", "b"]), "its start is no point"),
    ],
)
def test_files_that_contradict_themselves_are_refused(folder, name, change, message):
    content = json.loads((folder / name).read_text())
    change(content)
    (folder / name).write_text(json.dumps(content))
    with pytest.raises(LandingError, match=message):
        SearchFolder(folder, objective()).load()


@pytest.mark.parametrize("name", ["best.json", "search.json"])
def test_a_changed_digit_that_is_still_a_number_or_a_lost_check_sum_is_refused(folder, name):
    whole = (folder / name).read_text()
    digits = [i for i, c in enumerate(whole) if c in "12345678"]
    for i in digits[:: max(1, len(digits) // 100)]:
        (folder / name).write_text(whole[:i] + str(int(whole[i]) + 1) + whole[i + 1 :])
        with pytest.raises(
            LandingError, match=rf"{name} (cannot be (read|resumed) \(|is of another)"
        ):
            SearchFolder(folder, objective()).load()
    content = json.loads(whole)
    del content["check"]
    (folder / name).write_text(json.dumps(content))
    with pytest.raises(LandingError, match="its check sum is another: it was changed"):
        SearchFolder(folder, objective()).load()


def test_without_a_state_the_search_begins_anew_from_the_best(folder):
    (folder / "search.json").unlink()
    best, search = SearchFolder(folder, objective()).load()
    assert best.z == [0.4, 0.5]
    assert search is None


@pytest.mark.parametrize("name", ["best.json", "search.json"])
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "Expecting value"),
        (bytes(4096), "Expecting value"),
        (b"{}", "it does not say of which search it is"),
        (b"[]", "it is no table"),
        (b"\xff", "can't decode byte 0xff"),
        (b"[" * 10**5, "it is nested too deep"),
    ],
)
def test_foreign_files_are_refused_and_left_as_they_are(folder, name, content, message):
    (folder / name).write_bytes(content)
    with pytest.raises(LandingError, match=rf"{name} cannot be (read|resumed) \(.*{message}"):
        SearchFolder(folder, objective()).load()
    assert (folder / name).read_bytes() == content


def test_a_folder_in_use_a_link_for_a_lock_and_foreign_results_are_refused(folder, tmp_path):
    files = SearchFolder(folder, objective())
    files.load()
    with pytest.raises(LandingError, match="is in use by another sweep or search"):
        SearchFolder(folder, objective()).load()
    files.release()
    (tmp_path / "precious").write_text("precious")
    (folder / ".lock").unlink()
    (folder / ".lock").symlink_to(tmp_path / "precious")
    with pytest.raises(LandingError, match=r"\.lock is a link or no file; remove it, or name an"):
        SearchFolder(folder, objective()).load()
    with pytest.raises(LandingError, match="precious cannot be written: File exists; name another"):
        SearchFolder(tmp_path / "precious", objective()).create()
    assert (tmp_path / "precious").read_text() == "precious"
    for name in ("report.md", "identified.toml", "search.json"):
        (tmp_path / name).mkdir()
        (tmp_path / name / name).write_text("mine")
        with pytest.raises(
            LandingError, match=rf"{name} is there without best\.json; name another"
        ):
            SearchFolder(tmp_path / name, objective()).create()


def test_nothing_to_resume_makes_no_folder(tmp_path):
    with pytest.raises(LandingError, match="nothing to resume: leave --resume out"):
        SearchFolder(tmp_path / "none", objective()).load()
    assert list(tmp_path.iterdir()) == []
