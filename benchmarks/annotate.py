"""Cython's annotated HTML of the compiled core: the more yellow a line, the more Python it calls.

`make annotate` writes it to build/.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from html import unescape
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "fmu_src"))
from fmu_build.core_source import DIRECTIVES, MODULE, write_source  # noqa: E402

LINE = re.compile(
    r'<pre class="cython line score-(\d+)"[^>]*>[^<]*<span class="">(\d+)</span>: (.*?)</pre>'
)


@dataclass(frozen=True)
class Line:
    """A line of the joined kernels; `score` is Cython's measure of its Python calls, 0 for none."""

    number: int
    score: int
    text: str


def annotate(folder: Path) -> Path:
    """Write the joined kernels and their annotation below `folder`.

    Returns:
        The HTML file, which lies beside its source.
    """
    source = write_source(folder)
    extension = Extension(f"{source.parent.name}.{MODULE}", [str(source)])
    cythonize([extension], compiler_directives=DIRECTIVES, quiet=True, annotate=True, force=True)
    return source.with_suffix(".html")


def lines(html: Path) -> list[Line]:
    """The annotated lines of `html`."""
    found = LINE.findall(html.read_text(encoding="utf-8"))
    return [
        Line(int(number), int(score), unescape(re.sub("<[^>]+>", "", text)))
        for score, number, text in found
    ]


if __name__ == "__main__":
    print(annotate(ROOT / "build" / "annotate"))
