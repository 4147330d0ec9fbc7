"""The names of `rlv_landing`: complete, typed, and each says what it is."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from importlib.resources import files

import pytest

import rlv_landing

NAMES = [name for name in rlv_landing.__all__ if name != "__version__"]


def members(name: str) -> dict[str, object]:
    """A public name and its public methods and properties."""
    value = getattr(rlv_landing, name)
    own = vars(value) if inspect.isclass(value) else {}
    return {name: value} | {
        f"{name}.{member}": getattr(value, member)
        for member, v in own.items()
        if not member.startswith("_")
        and (inspect.isfunction(v) or isinstance(v, property | classmethod | staticmethod))
    }


def test_the_package_is_typed_for_others():
    assert files("rlv_landing").joinpath("py.typed").is_file()


@pytest.mark.parametrize("name", NAMES)
def test_each_name_says_what_it_is_and_has_types(name):
    for member, value in members(name).items():
        assert inspect.getdoc(value), member
        if inspect.isfunction(value):
            signature = inspect.signature(value)
            assert signature.return_annotation is not signature.empty, member
            for parameter in signature.parameters.values():
                untyped = parameter.annotation is parameter.empty
                assert parameter.name == "self" or not untyped, f"{member}: {parameter.name}"


def test_a_command_draws_whatever_a_notebook_has_chosen_for_its_own_pictures(tmp_path):
    picture = tmp_path / "vehicle.png"
    command = [sys.executable, "-m", "rlv_landing.cli", "draw", "yue2022-figures", str(picture)]
    done = subprocess.run(
        command,
        env={**os.environ, "MPLBACKEND": "module://missing.backend"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert picture.is_file()
