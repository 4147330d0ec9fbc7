"""Scalars, curves and files of a user's own: read in any unit, weighted, reported, or refused."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from pytest import approx

from rlv_landing import Landing, LandingError, load_preset
from rlv_landing.history import History
from rlv_landing.identification.counting.soft_count import TOLERANCE, SoftCount
from rlv_landing.identification.free_numbers import FreeNumbers
from rlv_landing.identification.measured.series import Series
from rlv_landing.identification.measured.target_file import read_targets
from rlv_landing.identification.objective import Objective
from rlv_landing.identification.search_folder import Best, SearchFolder
from rlv_landing.identification.targets import Landed, Wanted, fit_of
from rlv_landing.presets import read_toml
from rlv_landing.studies.sweep.responses import Measure
from rlv_landing.studies.whole_landing import whole_landing
from rlv_landing.validation.sensors import through_sensors

BASE = load_preset("yue2022-figures")
FORCE, STROKE = "leg[1].main_strut.force.min", "leg[3].main_strut.stroke.max"
QUICK = ("--evaluations", "1", "--polish", "0", "--workers", "1", "--free", "ground.friction")


def targets(folder: Path, text: str) -> Path:
    path = folder / "targets.csv"
    path.write_text(text)
    return path


@pytest.fixture(scope="module")
def whole() -> History:
    """The preset's landing in 2-2 until it is decided, as a sweep has it."""
    own = BASE.for_mode("2-2")
    return whole_landing(Landing(own), every=2e-4)


@pytest.mark.parametrize(
    "text",
    [
        f"id,value,unit,mode\n{FORCE},-4.3,kN,2-2\n{STROKE},24,mm,2-2\n",
        f"id,value,mode\n{FORCE},-4.3 kN,2-2\n{STROKE},24 mm,2-2\n",
        f"mode,unit,value,id\n2-2,kN,-4.3,{FORCE}\n2-2,mm,24,{STROKE}\n",
    ],
)
def test_a_response_may_have_its_unit_in_a_column_or_behind_the_number(tmp_path, text):
    assert read_targets(targets(tmp_path, text)) == [
        Wanted(FORCE, "2-2", -4.3, 4.3, "kN"),
        Wanted(STROKE, "2-2", 24.0, 24.0, "mm"),
    ]


def test_headings_give_units_and_rows_weights_and_scales(tmp_path):
    path = targets(
        tmp_path,
        "id,value [deg],scale [rad],weight,mode\nbody.pitch.final,0,0.1,3,2-2\n"
        "body.pitch.abs_max,8,,,1-2-1\n",
    )
    first, second = read_targets(path)
    scale = approx(np.degrees(0.1))
    assert (first.value, first.unit, first.weight, first.scale) == (0.0, "deg", 3.0, scale)
    assert (second.value, second.unit, second.weight, second.scale) == (8.0, "deg", 1.0, 8.0)


def test_a_response_stands_beside_that_of_a_sweep_in_the_users_unit(whole):
    names = (FORCE, STROKE, "leg[1].main_strut.absorbed", "body.pitch.final", "outcome.time")
    units = ("kN", "mm", "J", "deg", "s")
    sizes = (1e3, 1e-3, 1.0, np.pi / 180.0, 1.0)
    wanted = [Wanted(n, "2-2", 1.0, 1.0, u) for n, u in zip(names, units)]
    ours = [fit.ours for fit in fit_of(BASE, wanted)]
    assert ours == approx([v / size for v, size in zip(Measure(names)(whole, 0), sizes)])


def test_responses_are_read_through_the_sensors_on_request(whole):
    name = "body.top_axial_acceleration.max"
    (sensed,) = Landed(BASE, "2-2", sensors=True).read([Wanted(name, "2-2", 1.0, 1.0, "m/s2")])
    assert sensed == approx(through_sensors(whole)["body.top_axial_acceleration"].max())
    assert sensed < 0.99 * whole["body.top_axial_acceleration"].max()


def test_a_response_that_a_landing_does_not_have_is_as_bad_as_can_be():
    wanted = [Wanted("leg[1].main_strut.efficiency", "2-2", 0.5, 0.5)]
    high = BASE.with_values({"ground.gravity": 0.0, "drop.vertical_velocity": 1.0})
    objective = Objective(FreeNumbers(high, ["ground.friction"]), wanted, conditions=())
    assert objective.misfits(objective.free.start()) == approx([2.0 / TOLERANCE])


def test_a_weight_multiplies_the_misfit_and_the_cost_of_a_miss():
    plain, heavy = SoftCount(1, 0), SoftCount(1, 0, (3.0,))
    for error in (0.01, 0.08, 0.15, 0.4):
        misfit = np.array([error / TOLERANCE])
        assert heavy.missed(3.0 * misfit) == approx(3.0 * plain.missed(misfit))
        higher, lower = (heavy.missed(3.0 * misfit + d, 0.05) for d in (1e-6, -1e-6))
        moved = (higher - lower) / 2e-6
        assert heavy.weights(3.0 * misfit, 0.05)[0] * 3.0 * misfit[0] == approx(
            moved, rel=1e-4, abs=1e-9
        )
    objective = [
        Objective(
            FreeNumbers(BASE, ["ground.friction"]),
            [Wanted(STROKE, "2-2", 20.0, 20.0, "mm", weight)],
            conditions=(),
        )
        for weight in (1.0, 3.0)
    ]
    one, three = (o.misfits(o.free.start()) for o in objective)
    assert three == approx(3.0 * one)


def test_a_scale_has_the_unit_of_its_heading_else_that_of_the_value(tmp_path):
    for heading, unit, scale in (("scale [N]", "kN", 0.5), ("scale", "kN", 500.0)):
        text = f"id,value,unit,mode,{heading}\n{FORCE},-4,{unit},2-2,500\n"
        (wanted,) = read_targets(targets(tmp_path, text))
        assert (wanted.value, wanted.scale, wanted.unit) == (-4.0, approx(scale), "kN")


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("leg[1].main_strut.force,-4,kN,2-2", r"is a curve; name a reading of it, leg\[1\].main"),
        ("leg[1].main_strut.force.mni,-4,kN,2-2", r"did you mean leg\[1\].main_strut.force.min"),
        ("outcome,1,,2-2", "is not a number that varies continuously"),
        ("rhs_calls,1000,,2-2", "is not a number that varies continuously"),
        ("outcome.first_limit_time,1,s,2-2", "is not a number that varies continuously"),
        ("body.pitch.final,0,deg,2-2", "= 0 has no size to judge a difference on"),
        (f"{FORCE},-4,mm,2-2", "has the wrong unit; give it in N"),
        (f"{FORCE},-4 kN,N,2-2", "has the units kN and N; leave one"),
        (f"{FORCE},-4,,2-2", r"no unit of .*write it in a column unit, or in the heading"),
        (f"{FORCE},-4,kN,", "says no landing mode; add a column mode"),
        (f"{FORCE},-4,kN,3-1", "unknown landing mode '3-1'"),
        (f"{FORCE},inf,kN,2-2", "must be finite"),
        ("22-s3-max,24,mm,1-2-1", "22-s3-max is a number of 2-2, and its mode is 1-2-1"),
        (f"{FORCE},-4,kN,2-2,1", "5 cells for 4 columns"),
        (f"{FORCE},-4,kN", "3 cells for 4 columns; give every column a cell"),
        (f"{FORCE},-4,kN,2-2\n{FORCE},-5,kN,2-2", "is there twice; leave one"),
    ],
)
def test_bad_rows_are_refused_with_line_and_remedy(tmp_path, row, message):
    path = targets(tmp_path, f"id,value,unit,mode\n{row}\n")
    with pytest.raises(LandingError, match=message) as refused:
        read_targets(path)
    assert f"{path.name}, line " in str(refused.value)
    assert len(str(refused.value)) <= 300


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("id,value,unti\n", "did you mean unit"),
        ("id,value,id\n", "column id is there 2 times"),
        ("id [m],value\n", "column id takes no unit in its heading"),
        (f"id,value [kN],mode,weight\n{FORCE},-4,2-2,0\n", "weight = 0 is outside"),
        (f"id,value [kN],mode,scale\n{FORCE},-4,2-2,-1 kN\n", "scale of .* must be finite and"),
        (f"id,value [kN],unit,mode\n{FORCE},-4,N,2-2\n", "has the units kN and N; leave one"),
        (f"id,value,unit,mode,scale [N]\n{FORCE},-4,kN,2-2,9 kN\n", "has the units kN and N"),
    ],
)
def test_bad_columns_are_refused(tmp_path, text, message):
    with pytest.raises(LandingError, match=message):
        read_targets(targets(tmp_path, text))


def test_the_mode_of_the_command_is_that_of_responses_and_leaves_the_others_out(tmp_path):
    path = targets(tmp_path, f"id,value [kN],mode\n{FORCE},-4,\n{FORCE},-5,1-2-1\n")
    assert [t.value for t in read_targets(path, "2-2")] == [-4.0]
    only = targets(tmp_path, f"id,value [kN],mode\n{FORCE},-4,1-2-1\n")
    with pytest.raises(LandingError, match="holds no targets of --mode 2-2"):
        read_targets(only, "2-2")


def test_the_papers_scalars_are_no_targets_of_another_vehicle(tmp_path, command):
    path = targets(tmp_path, "id,value,unit\n22-s3-max,24,mm\n")
    heavy = ("--set", "vehicle.mass=400", "--work", str(tmp_path / "work"))
    for data in (("--targets", str(path)), ()):
        done = command("identify", *heavy, *data)
        assert done.code == 2
        assert "vehicle.mass = 400 kg for 178 kg" in done.err
    assert not (tmp_path / "work").exists()


@pytest.mark.parametrize(
    ("shift", "factor", "message"),
    [
        (-0.1, 1.0, "begin at -0.1 s, before the landing at 0 s"),
        (100.0, 1.0, "begin at 100 s, but the first contact is at drop.contact_time = 0.0897 s"),
        (0.0, 60.0, "end at 36 s, more than 30 s after the contact"),
    ],
)
def test_curves_outside_the_landing_are_refused(whole, shift, factor, message):
    base = BASE.with_values({"drop.contact_time": 0.0897})
    time = factor * whole.time[:3001:100] + shift
    curves = History(time, ["body.pitch"], np.ones((len(time), 1)))
    numbers = FreeNumbers(base, ["ground.friction"])
    with pytest.raises(LandingError, match=message):
        Objective(numbers, [], [Series("2-2", curves)])
    with pytest.raises(LandingError, match=r"body\.pitch of 2-2 is 0 throughout"):
        Series("2-2", History(time, ["body.pitch"], np.zeros((len(time), 1))))


def test_the_rms_of_a_curve_is_over_all_samples_in_the_unit_that_people_read(whole):
    names = ["leg[1].main_strut.force", "body.pitch"]
    data = np.column_stack([whole[names[0]] + 250.0, whole[names[1]] + np.radians(2.0)])
    curves = History(whole.time[:3000], names, data[:3000])
    force, pitch = Series("2-2", curves).fits(whole)
    assert (force.unit, force.samples, pitch.unit) == ("kN", 3000, "deg")
    assert force.rms == approx(0.25)
    assert force.largest == approx(0.25)
    assert force.relative == approx(250.0 / np.sqrt(np.mean(data[:3000, 0] ** 2)))
    assert pitch.rms == approx(2.0)


def test_a_search_does_not_go_on_with_other_curves_or_values(tmp_path, whole):
    def folder(base=BASE, offset=0.0):
        data = whole["body.pitch"][:3000, None] + offset
        series = Series("2-2", History(whole.time[:3000], ["body.pitch"], data))
        return SearchFolder(
            tmp_path, Objective(FreeNumbers(base, ["ground.friction"]), [], [series])
        )

    folder().save_best(Best([0.5], 1.0, 1, "start", 1))
    assert folder().load()[0].z == [0.5]
    for other in (folder(offset=1e-6), folder(BASE.with_values({"ground.stick_damping": 9.0}))):
        with pytest.raises(LandingError, match="with other curves or values that are not free"):
            other.load()


def test_values_keep_their_sources_and_the_file_names_its_command(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(
        "[vehicle]\ninertia = 150.0\n"
        '[main_strut]\nvolume_upper = { value = "150 cm3", source = "drawing" }\n'
        "[mode.1-2-1.drop]\ntilt = -0.1\n"
    )
    targets(tmp_path, f"id,value,unit,mode\n{FORCE},-4.3,kN,2-2\n")
    arguments = ("identify", "--parameters", "mine.toml", "--set", "ground.stick_damping=9", *QUICK)
    done = command(*arguments, "--targets", "targets.csv", "--work", "a b")
    assert done.code in (0, 1), done.err
    text = Path("a b/identified.toml").read_text()
    written = shlex.split(text.splitlines()[1].removeprefix("# "))
    assert written == ["rlv-landing", *arguments, "--targets", "targets.csv", "--work", "a b"]
    found = read_toml("a b/identified.toml")
    assert found.source("ground.friction") == "identified"
    assert found.source("ground.stick_damping") == "--set"
    assert found.source("vehicle.inertia") == "mine.toml"
    assert found.source("main_strut.volume_upper") == "drawing, mine.toml"
    assert found.source("vehicle.mass") == "paper, yue2022-figures"
    assert found.source("ground.stiffness") == "identified, yue2022-figures"
    assert found.source("drop.tilt", "1-2-1") == "mine.toml"
    assert found.source("drop.tilt", "2-2") == "identified, yue2022-figures"
    # what was inherited stays told when the result is itself a start
    again = ("identify", "--parameters", "a b/identified.toml", "--targets", "targets.csv")
    done = command(*again, *QUICK[:-1], "ground.stribeck_gain", "--work", "c")
    assert done.code in (0, 1), done.err
    found = read_toml("c/identified.toml")
    assert found.source("ground.friction") == "identified, identified.toml"
    assert found.source("ground.stiffness") == "identified, yue2022-figures"
    assert found.source("vehicle.inertia") == "mine.toml, identified.toml"


def test_a_fit_of_one_modes_drop_leaves_the_others_source(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    targets(tmp_path, f"id,value,unit,mode\n{FORCE},-4.3,kN,2-2\n")
    done = command("identify", *QUICK[:-1], "drop.tilt", "--targets", "targets.csv")
    assert done.code in (0, 1), done.err
    found = read_toml("identification/identified.toml")
    assert found.source("drop.tilt", "2-2") == "identified"
    assert found.source("drop.tilt", "1-2-1") == "identified, yue2022-figures"


def test_a_start_that_is_moved_to_a_bound_is_said(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    targets(tmp_path, f"id,value,unit,mode\n{FORCE},-4.3,kN,2-2\n")
    moved = ("--bound", "ground.friction=0.4..0.5", "--targets", "targets.csv")
    done = command("identify", *QUICK, *moved)
    assert done.code in (0, 1), done.err
    assert "note: ground.friction: the start is outside the bounds" in done.err
    refused = command("identify", *QUICK, "--set", "ground.friction=0.7", "--work", "other")
    assert refused.code == 2
    assert "ground.friction = 0.7 is outside its prior, 0.08 to 0.6; start from" in refused.err


def test_priors_are_those_of_the_vehicle(command):
    own, other = (
        {
            line.split()[1]: line
            for line in command("identify", "--priors", *extra).out.splitlines()
            if line.startswith("│")
        }
        for extra in ((), ("--set", "vehicle.mass=2000", "--set", "vehicle.inertia=5000"))
    )
    assert "178 kg between the auxiliary joints" in own["vehicle.inertia"]
    assert other["vehicle.inertia"].split()[3:6:2] == ["2500", "1e+04"]
    assert "the start, a factor of 2 to either side" in other["vehicle.inertia"]


def test_an_interrupt_while_processes_start_leaves_a_folder_that_goes_on_and_no_process(tmp_path):
    """The signal goes to the whole group, as a terminal's Ctrl-C does, once the folder is there."""
    program = [sys.executable, "-c", "from rlv_landing.cli import main; main()", "identify"]
    program += ["--free", "ground.friction"]
    process = subprocess.Popen(
        [*program, "--evaluations", "100000"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    work = tmp_path / "identification"
    while not work.exists():
        assert process.poll() is None
        os.sched_yield()
    os.killpg(process.pid, signal.SIGINT)
    # a process that is left would hold standard error open
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130
    assert err.splitlines()[-1] == "interrupted; --resume goes on"
    assert "Traceback" not in err
    done = subprocess.run(
        [*program, "--evaluations", "5", "--polish", "0", "--resume"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode in (0, 1), done.stderr
