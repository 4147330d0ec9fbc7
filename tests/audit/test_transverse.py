"""The warning of what the transverse load at the joint creates, and who gives it."""

from contextlib import nullcontext
from pathlib import Path
from warnings import catch_warnings as recorded
from warnings import simplefilter

import pytest

from rlv_landing import Landing, land_many, load_preset
from rlv_landing.audit.transverse import joint_warning, warning_of
from rlv_landing.presets import preset_names

JOINT = {"vehicle.transverse_load_at": "joint"}
SET = ("--set", "vehicle.transverse_load_at=joint")
REMEDY = "set vehicle.transverse_load_at = footpad"
SWEEP = """
[study]
method = "grid"
responses = ["outcome"]
until = 0.1
[set]
{set}
[[factor]]
name = "{name}"
values = {values}
"""
ENVELOPE = """
[envelope]
cells = 2
levels = 0
until = 0.1
[x]
name = "drop.horizontal_velocity"
low = -1.0
high = 1.0
tolerance = 1.0
[y]
name = "drop.tilt"
low = -0.1
high = 0.1
tolerance = 0.1
[families]
vehicle.transverse_load_at = {values}
"""


def warnings(err: str) -> list[str]:
    return [line for line in err.splitlines() if line.startswith("warning: ")]


def test_it_names_what_the_landing_itself_creates_and_the_remedy(mode):
    parameters = load_preset("yue2022-figures", mode).with_values(JOINT)
    history = Landing(parameters.with_values({"drop.contact_time": 0.0})).run(1.0)
    created = history["energy.work_transverse"][-1]
    text = joint_warning([load_preset("yue2022-figures", mode), parameters])
    assert created > 1.0
    # without it the balance would be open by just this
    assert abs(history["energy.balance"][-1]) < 1e-2 * created
    assert f"creates {created:.3g} J beside {history['energy.dissipated'][-1]:.3g} J" in text
    assert mode in text
    assert text.endswith(REMEDY)
    assert warning_of(history) == text


def test_there_is_none_at_the_footpad_which_is_the_default_of_every_preset(mode):
    vehicles = [load_preset(name, mode) for name in preset_names()]
    assert joint_warning(vehicles) is None
    assert warning_of(Landing(vehicles[0]).run(0.1)) is None


def test_a_vehicle_that_cannot_land_is_warned_of_all_the_same():
    below = JOINT | {"drop.vertical_velocity": 5.0, "drop.contact_time": 3.0}
    inputs = {"external.force_y": 1e9}
    text = joint_warning([load_preset("yue2022-figures").with_values(below)], inputs)
    assert text.endswith(REMEDY)


def test_simulate_and_identify_warn_once(command, tmp_path: Path):
    for arguments in (
        ("simulate", "--until", "0.3"),
        ("identify", "--evaluations", "1", "--polish", "0", "--workers", "1", "--work"),
    ):
        runs = []
        for options in (SET, ()):
            work = (str(tmp_path / str(len(options))),) if arguments[-1] == "--work" else ()
            runs.append(command(*arguments, *work, *options))
        joint, footpad = runs
        assert len(warnings(joint.err)) == 1
        assert REMEDY in joint.err
        assert not warnings(footpad.err)


def test_a_report_warns_and_says_when_it_ends_before_the_contact(command, tmp_path: Path):
    done = command(
        "report", "yue2022-figures", "--until", "0.05", "-o", str(tmp_path / "r.html"), *SET
    )
    assert done.code == 0, done.err
    assert len(warnings(done.err)) == 1
    assert "s before its first contact" in done.err


@pytest.mark.parametrize("base", [JOINT, {}])
@pytest.mark.parametrize(("values", "warned"), [(["footpad", "joint"], True), (["footpad"], False)])
def test_a_batch_of_landings_warns_where_any_has_the_joint(base, values, warned):
    parameters = load_preset("yue2022-figures").with_values({"drop.contact_time": 0.0, **base})
    columns = {"vehicle.transverse_load_at": values}
    with recorded(record=True) as found:
        simplefilter("always")
        land_many(parameters, columns, until=0.01)
        assert [REMEDY in str(one.message) for one in found] == [True] * warned
    with pytest.warns(UserWarning, match=REMEDY) if base else nullcontext():
        land_many(parameters, {"ground.friction": [0.3]}, until=0.01)


@pytest.mark.parametrize(
    ("fixed", "name", "values", "count"),
    [
        ('vehicle.transverse_load_at = "joint"', "ground.friction", "[0.2, 0.3]", 1),
        ("", "vehicle.transverse_load_at", '["footpad", "joint"]', 1),
        ("", "vehicle.transverse_load_at", '["footpad"]', 0),
        ("", "ground.friction", "[0.2, 0.3]", 0),
    ],
)
def test_a_sweep_warns_once_where_any_landing_of_it_has_the_joint(
    command, tmp_path: Path, fixed, name, values, count
):
    study = tmp_path / "study.toml"
    study.write_text(SWEEP.format(set=fixed, name=name, values=values))
    for options in (("--dry-run",), ("--results", str(tmp_path / "results"))):
        done = command("sweep", str(study), *options)
        assert done.code == 0, done.err
        assert len(warnings(done.err)) == count


@pytest.mark.parametrize(("values", "count"), [('["footpad", "joint"]', 1), ('["footpad"]', 0)])
def test_an_envelope_warns_once_where_any_family_of_it_has_the_joint(
    command, tmp_path: Path, values, count
):
    study = tmp_path / "study.toml"
    study.write_text(ENVELOPE.format(values=values))
    done = command("envelope", str(study), "--work", str(tmp_path / "work"))
    assert len(warnings(done.err)) == count
