"""What the pages show works as it stands: Python code, commands, options, targets of make."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import click
import pytest
from page_snippets import PAGES, ROOT, TUTORIALS, blocks, commands, name_of, snippets

from rlv_landing.cli import cli

WITH_CODE = [page for page in PAGES if snippets(page)]
# words of a text after the program's name that are no command
NO_COMMANDS = {"of"}


@pytest.fixture
def folder(fmu, fmu3, one_log, tmp_path, monkeypatch) -> Path:
    """A folder with what the pages speak of: the built FMUs, and a log."""
    (tmp_path / "build").mkdir()
    for file in (fmu, fmu3):
        (tmp_path / "build" / file.name).symlink_to(file)
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "20260131T120000Z-2-2").symlink_to(one_log)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", WITH_CODE, ids=name_of)
def test_python_code_runs(page, folder, command):
    for block in blocks(page):
        if block.file:
            (folder / block.file).write_text(block.text)
    if page.parent.name == "touchdown_study":
        study = (page.parent / "dispersion.toml").read_text()
        few, changes = re.subn(r"^samples = \d+", "samples = 4", study, flags=re.M)
        assert changes == 1
        (folder / "dispersion.toml").write_text(few)
        assert command("sweep", "dispersion.toml").code == 0
    for i, code in enumerate(snippets(page)):
        exec(compile(code, f"{name_of(page)}[{i}]", "exec"), {"__name__": "__main__"})


@cache
def options_of(*path: str) -> frozenset[str] | None:
    """The options of a command; None where there is none, and of a group its commands."""
    found: click.Command | None = cli
    for name in path:
        assert isinstance(found, click.Group), path
        found = found.get_command(click.Context(found), name)
        if found is None:
            return None
    assert found is not None
    own = {o for p in found.params for o in (*p.opts, *p.secondary_opts)} | {"--help"}
    return frozenset({*own, *(found.commands if isinstance(found, click.Group) else ())})


@pytest.mark.parametrize("page", [*PAGES, *TUTORIALS], ids=name_of)
def test_every_command_and_option_that_is_shown_exists(page):
    for words in commands(page):
        if words[0] in NO_COMMANDS:
            continue
        if "--ros-args" in words:  # what follows is for ROS
            words = words[: words.index("--ros-args")]
        known = options_of(words[0])
        assert known is not None, words
        if len(words) > 1 and words[1] in known and not words[1].startswith("-"):
            known = options_of(*words[:2])
        for option in (word.split("=")[0] for word in words if word.startswith("--")):
            assert option in known, (words, option)


@pytest.mark.parametrize("page", [*PAGES, *TUTORIALS], ids=name_of)
def test_every_make_target_that_is_shown_exists(page):
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"(?:`|^    )make (\w+)", page.read_text(encoding="utf-8"), re.M):
        assert re.search(rf"^{target}:", makefile, re.M), target


def test_the_front_page_is_one_page():
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 60


def test_fenced_commands_are_in_tutorials_which_run_them():
    """Elsewhere commands are indented, and their words are checked."""
    assert [name_of(p) for p in PAGES if any(b.language == "sh" for b in blocks(p))] == []
    assert all(any(b.language == "sh" for b in blocks(p)) for p in TUTORIALS)


@pytest.mark.parametrize("page", [*PAGES, *TUTORIALS], ids=name_of)
def test_no_page_claims_that_an_index_has_the_package(page):
    """`pip install "rlv-landing[fmu]"` adds an extra to what is there: docs/install.md."""
    text = page.read_text(encoding="utf-8")
    named = re.findall(r"(?:pip|uv|pipx) install [^\n`]*?\"?\brlv-landing\b(\[?)", text)
    assert set(named) <= {"["}
    assert "pypi.org/project/rlv" not in text.lower()
