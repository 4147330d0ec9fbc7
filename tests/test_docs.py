"""The pages (links, index, the map of the code), and what holds for folders and files."""

import re
from collections import Counter
from pathlib import Path

import pytest
from mypy.main import process_options

ROOT = Path(__file__).resolve().parent.parent
INDEX = ROOT / "docs" / "README.md"
PAGES = sorted(
    [
        ROOT / "README.md",
        ROOT / "CHANGELOG.md",
        *(ROOT / "docs").rglob("*.md"),
        *(ROOT / "examples").glob("*/README.md"),
    ]
)
PACKAGES = (
    ROOT / "fmu_src" / "rlv_landing",
    ROOT / "fmu_src" / "fmu_build",
    ROOT / "ros_bridge" / "rlv_ros_bridge",
)
TOPS = ("fmu_src", "ros_bridge", "tests", "docs", "benchmarks", "examples")
MAP = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
# a code span with a slash is a path from the project's folder
PATHS = {span for span in re.findall(r"`([^`\s]+)`", MAP) if "/" in span}


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def anchors(page: Path) -> set[str]:
    """The anchors that a renderer makes from the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_link_leads_to_a_file_and_a_heading_that_exist(page):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if target.startswith("https://"):
            continue
        file, _, anchor = target.partition("#")
        linked = (page.parent / file).resolve() if file else page
        assert linked.is_file(), target
        assert not anchor or anchor in anchors(linked), target


def test_the_index_lists_every_page():
    targets = re.findall(r"\]\(([^)\s]+)\)", INDEX.read_text(encoding="utf-8"))
    listed = {(INDEX.parent / target).resolve() for target in targets}
    notebooks = set((ROOT / "examples" / "notebooks").glob("*.ipynb"))
    assert listed == {page for page in PAGES if page != INDEX} | notebooks


def test_every_path_on_the_map_exists():
    assert PATHS
    assert [path for path in sorted(PATHS) if not (ROOT / path).exists()] == []


def test_every_path_in_a_page_exists():
    """Code spans and lines of commands that begin with one of the project's folders."""
    first = "|".join(TOPS)
    found = {
        (page.name, path.rstrip("."))
        for page in PAGES
        for path in re.findall(
            rf"(?<![\w/.-])((?:{first})/[\w./-]+)", page.read_text(encoding="utf-8")
        )
    }
    assert len(found) > len(PATHS) / 2
    assert [p for p in sorted(found) if not (ROOT / p[1]).exists()] == []


def test_no_folder_has_more_than_16_python_files():
    folders = {ROOT} | {path.parent for top in TOPS for path in (ROOT / top).rglob("*.py")}
    assert {name_of(f).split("/")[0] for f in folders} == {".", *TOPS}
    crowded = {name_of(f): n for f in folders if (n := len(list(f.glob("*.py")))) > 16}
    assert crowded == {}


def test_the_map_names_every_folder_of_the_packages():
    folders = {
        name_of(init.parent) for package in PACKAGES for init in package.rglob("__init__.py")
    }
    assert folders - PATHS == set()


def test_mypy_checks_every_file_of_the_packages(monkeypatch):
    monkeypatch.chdir(ROOT)
    sources, _ = process_options(["--config-file", "pyproject.toml"])
    checked = {Path(source.path).resolve() for source in sources if source.path}
    files = {file for package in PACKAGES for file in package.rglob("*.py")}
    assert {name_of(file) for file in files - checked} == set()


def test_each_test_folder_imports_its_own_modules_and_shared_ones():
    """A test can be run alone then, and one pytest takes any folders together.

    Own are those beside a file, and those of a folder above it that has a `conftest.py`: pytest
    puts both on the path. `conftest` itself is one of many, whichever pytest has loaded last.
    """
    tests = ROOT / "tests"
    files = [file for file in tests.rglob("*.py") if file.parent != tests]
    shared = {p.stem for folder in ("shared", "bridge") for p in (tests / folder).glob("*.py")}
    own = {p.stem for p in files} - shared | {"conftest"}
    imports = re.compile(r"^\s*(?:from|import) (\w+)(?: import .*)?$", re.M)
    for file in files:
        wanted = own.intersection(imports.findall(file.read_text(encoding="utf-8")))
        above = [f for f in file.parents if tests in f.parents and (f / "conftest.py").exists()]
        near = {p.stem for folder in (file.parent, *above) for p in folder.glob("*.py")}
        assert wanted <= near - {"conftest"}, name_of(file)


def test_no_two_files_of_the_tests_have_one_name():
    """Pytest imports them by their bare names."""
    names = Counter(p.name for p in (ROOT / "tests").rglob("*.py") if p.name != "conftest.py")
    assert {name: n for name, n in names.items() if n > 1} == {}
