"""Lays out the pages for Sphinx as they are laid out in the project, so that their links hold."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from index import FRONT, LINK, ROOT, pages, sections
from reference import reference

# the section of the index that the pages made of the code's tables belong to
REFERENCE = "Reference"
GENERATED = Path("docs") / "reference"


def stage(folder: Path) -> None:
    """Write all pages, and the files that they link to, to the `folder`, which is made anew."""
    shutil.rmtree(folder, ignore_errors=True)
    for page in pages():
        target = folder / staged(page)
        target.parent.mkdir(parents=True, exist_ok=True)
        if page.suffix != ".md":
            shutil.copyfile(page, target)
            continue
        target.write_text(_relinked(page, folder), encoding="utf-8")
    for name, text in reference().items():
        target = folder / GENERATED / f"{name}.md"
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")
    with (folder / staged(FRONT)).open("a", encoding="utf-8") as file:
        file.write("".join(toctree(title, entries) for title, entries in navigation().items()))


def staged(page: Path) -> Path:
    """Where a page is in the folder; the front page is Sphinx's index."""
    return Path("index.md") if page == FRONT else page.relative_to(ROOT)


def navigation() -> dict[str, list[str]]:
    """The pages of each section as Sphinx names them."""
    found = {
        title: [staged(page).with_suffix("").as_posix() for page in each]
        for title, each in sections().items()
    }
    found[REFERENCE] += [(GENERATED / name).as_posix() for name in reference()]
    found[REFERENCE].append("docs/README")
    return found


def toctree(title: str, entries: list[str]) -> str:
    """A section of the navigation."""
    return f"\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(entries) + "\n```\n"


def _relinked(page: Path, folder: Path) -> str:
    """The page's text with links that hold in the site."""
    text = page.read_text(encoding="utf-8")
    return LINK.sub(lambda found: _link(page, found[1], folder), text)


def _link(page: Path, target: str, folder: Path) -> str:
    """The link as it holds in the site; a file that is no page is copied for it."""
    path, mark, anchor = target.partition("#")
    if not path or re.match(r"[a-z]+:", path):
        return f"]({target})"
    linked = (page.parent / path).resolve()
    if linked == FRONT:
        up = "../" * (len(page.relative_to(ROOT).parts) - 1)
        return f"]({up}index.md{mark}{anchor})"
    if linked not in pages():
        copy = folder / linked.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(linked, copy)
    return f"]({target})"
