"""examples/notebooks: each runs from an empty folder, and what is stored is what a run gives."""

from __future__ import annotations

import re
import sys
from itertools import zip_longest
from pathlib import Path
from typing import Any

import nbformat
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import notebooks  # noqa: E402

NOTEBOOKS = sorted(notebooks.FOLDER.glob("*.ipynb"))
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def shown(cell: Any) -> list[tuple[str, list[str], list[str], list[float]]]:
    """Of each output of a cell: kind, formats, words of its text, and the numbers in it."""
    found = []
    for output in cell.get("outputs", ()):
        data = output.get("data", {"text/plain": output.get("text", "")})
        text = data["text/plain"] if "image/png" not in data else ""
        words = NUMBER.sub(" ", text).split()
        numbers = [float(n) for n in NUMBER.findall(text)]
        found.append((output.output_type, sorted(data), words, numbers))
    return found


def test_there_are_two():
    assert [path.stem for path in NOTEBOOKS] == ["guidance_loop", "own_vehicle"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_run_gives_what_is_stored(path, fmu, tmp_path, monkeypatch):
    """Texts and numbers; of pictures, that there is one: their bytes are matplotlib's affair."""
    monkeypatch.setenv("RLV_FMU", str(fmu))
    stored = nbformat.read(path, as_version=4)
    nbformat.validate(stored)
    ran = notebooks.run(path, tmp_path)
    pictures = 0
    for before, after in zip_longest(stored.cells, ran.cells):
        for old, new in zip_longest(shown(before), shown(after)):
            assert new is not None, before.source
            assert old is not None, after.source
            assert new[:3] == old[:3]
            assert new[3] == pytest.approx(old[3], rel=1e-2)
            pictures += "image/png" in new[1]
    assert pictures > 0
    assert all(output.get("name") != "stderr" for c in ran.cells for output in c.get("outputs", ()))
