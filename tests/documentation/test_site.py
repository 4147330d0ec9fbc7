"""What the site is made of: each page has its place, and the reference pages are complete.

`make site` and `make torture` build it (tests/viewer/test_site_in_browser.py).
"""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs" / "site"))

import staging  # noqa: E402

import rlv_landing  # noqa: E402
from rlv_landing.parameters import PARAMETER_QUANTITIES  # noqa: E402
from rlv_landing.quantities import SPACE, interface_of  # noqa: E402
from rlv_ros_bridge.messages.topics import RECORDED  # noqa: E402


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    staging.stage(folder)
    return folder


def text(site: Path, name: str) -> str:
    return (site / "docs" / "reference" / f"{name}.md").read_text(encoding="utf-8")


def test_each_page_is_in_the_navigation_once_and_is_there(site):
    entries = [entry for each in staging.navigation().values() for entry in each]
    pages = {p for kind in ("*.md", "*.ipynb") for p in site.rglob(kind)}
    staged = {page.relative_to(site).with_suffix("").as_posix() for page in pages}
    assert sorted(entries) == sorted(staged - {"index"})
    assert list(staging.navigation()) == ["Tutorials", "How-to guides", "Explanations", "Reference"]


def test_what_a_page_links_to_comes_along(site):
    assert (site / "docs" / "landing-space.gif").is_file()
    assert "(../index.md)" in (site / "docs" / "README.md").read_text(encoding="utf-8")


def test_reference_pages_have_all_parameters_inputs_outputs_and_variables(site):
    parameters, both = text(site, "parameters"), text(site, "inputs_outputs")
    variables = text(site, "fmu_variables")
    for name in PARAMETER_QUANTITIES:
        assert f"| `{name}` |" in parameters
    for interface in (interface_of("2-2"), interface_of(SPACE, 3)):
        for name in (*interface.input_names, *interface.output_names):
            if "leg[" not in name or "leg[1]" in name:
                assert f"| `{name}` |" in both
                assert interface.in_space or f"| `{name}` |" in variables
    assert "| `peak.leg[1].contact.force.max` |" in variables


def test_reference_pages_have_all_topics_commands_and_python_names(site):
    topics, commands, python = (text(site, n) for n in ("topics", "command_line", "python"))
    for topic in RECORDED:
        assert f"| `{topic.name}` | {topic.type_name} |" in topics
    for name in ("simulate", "node", "log verify", "fmu build", "examples copy"):
        assert f"\n## {name}\n" in commands
        assert f"\nUsage: rlv-landing {name} " in commands
    for name in rlv_landing.__all__:
        assert name == "__version__" or f"rlv_landing.{name}\n" in python
