"""`fmu simulate` with inputs over time, and `fmu info` of any FMU."""

from __future__ import annotations

import json
import sys
import zipfile
from itertools import pairwise

import pytest

from rlv_landing import Landing, Parameters
from rlv_landing.cli import run
from rlv_landing.errors import LandingError
from rlv_landing.quantities import OUTPUT_NAMES, STATISTIC_QUANTITIES
from rlv_ros_bridge.commands.group import main
from rlv_ros_bridge.fmu.input_table import Setting, in_steps, read_inputs, sloped
from rlv_ros_bridge.fmu.landing import land_fmu
from rlv_ros_bridge.fmu.runner import FmuRunner

TABLE = """\
time [ms],external.force_x [kN],ground.heave [mm],ground.tilt [deg],ground.tilt_rate [deg/s]
50,0,0,0,1
150,0.4,10,0.1,2
150,-0.4,10,0.1,2
210.5,0,0,0.2,0
"""


@pytest.fixture
def command(monkeypatch, capsys):
    """Runs a command of the bridge in this process; exit code, output, errors."""

    def called(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["rlv-landing", *map(str, arguments)])
        code = run(main)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return called


@pytest.fixture
def table(tmp_path):
    """Writes a table of inputs."""

    def written(text: str):
        path = tmp_path / "inputs.csv"
        path.write_text(text)
        return path

    return written


def test_inputs_are_linear_between_rows_in_their_units_and_jump_at_equal_times(table):
    settings = read_inputs(table(TABLE)).settings()
    assert [s.time for s in settings] == [0.0, 0.05, 0.15, 0.15, 0.2105]
    assert settings[0] == Setting(
        0.0,
        {**settings[1].values},
        {"external.force_x": 0.0, "ground.heave": 0.0},
    )
    assert settings[1].rates["external.force_x"] == pytest.approx(4000.0)
    assert settings[1].rates["ground.heave"] == pytest.approx(0.1)
    assert settings[2].rates == {"external.force_x": 0.0, "ground.heave": 0.0}
    assert settings[3].values["external.force_x"] == -400.0
    assert settings[3].rates["external.force_x"] == pytest.approx(400.0 / 0.0605)
    assert settings[4].rates == {"external.force_x": 0.0, "ground.heave": 0.0}


def test_the_fmu_lands_under_a_table_as_landing_does(fmu, table):
    settings = read_inputs(table(TABLE)).settings()
    history = land_fmu(fmu, Parameters(), settings, 0.4, 1e-2)
    landing = Landing()
    now = 0.0
    for setting in [*settings, Setting(0.4, {}, {})]:
        steps = [k * 1e-2 for k in range(41) if now < k * 1e-2 < setting.time]
        for time in [*steps, setting.time]:
            landing.advance_to(time)
        now = setting.time
        if setting.values:
            landing.set_inputs(setting.values, setting.rates)
    assert landing.get("energy.work_external") != 0.0
    assert landing.get("energy.work_ground") != 0.0
    assert [history[name][-1] for name in OUTPUT_NAMES] == landing.values()
    extremes = landing.extremes()
    peak = history.extreme("leg[1].contact.force")
    assert (peak.maximum, peak.maximum_time) == extremes["leg[1].contact.force"][2:]


DECK_AND_LOADS = """\
time,external.force_y,ground.heave [mm],ground.tilt [deg]
0,0,0,0
0.1,0,10,0.1
0.1,-500,10,0.1
0.3,-500,0,0.2
"""


def test_fmi_3_lands_to_the_same_digits_under_steps_of_load_and_a_moving_deck(fmu, fmu3, table):
    settings = read_inputs(table(DECK_AND_LOADS)).settings()
    assert sloped(settings) == []
    parameters = Parameters().with_values({"vehicle.mass": 190.0, "ground.friction": 0.4})
    two, three = (land_fmu(file, parameters, settings, 0.4, 1e-2) for file in (fmu, fmu3))
    assert two["energy.work_ground"][-1] != 0.0
    for name in OUTPUT_NAMES:
        assert list(two[name]) == list(three[name]), name
    assert two.extremes == three.extremes


def test_linear_loads_are_told_in_fmi_3_at_their_means_in_steps_of_1_ms(fmu, fmu3, table):
    settings = read_inputs(table(TABLE)).settings()
    assert sloped(settings) == ["external.force_x"]
    steps = list(in_steps(settings, 1e-3, 0.4))
    assert not sloped(steps)
    assert all(b.time >= a.time for a, b in pairwise(steps))
    impulse = sum(
        a.values["external.force_x"] * (b.time - a.time)
        for a, b in pairwise(steps)
        if b.time < 0.21
    )
    # ramps of 0 to 400 N in 0.1 s, and of -400 N to 0 in 60.5 ms up to the step before its last
    assert impulse == pytest.approx(20.0 - 400.0 * 0.0605 / 2.0, abs=0.01)
    two, three = (land_fmu(file, Parameters(), settings, 0.4, 1e-2) for file in (fmu, fmu3))
    for name in ("body.x", "leg[1].main_strut.force", "leg[3].main_strut.stroke"):
        assert abs(two[name] - three[name]).max() < 1e-4 * abs(two[name]).max(), name


def test_steps_of_a_load_take_no_memory_and_too_many_are_refused(command, fmu3, table):
    far = table("time,external.force_x\n0,0\n1e12,1e6\n")
    steps = in_steps(read_inputs(far).settings(), 1e-3, 1e12)
    assert [next(steps).time for _ in range(3)] == [0.0, 1e-3, 2e-3]
    command_line = ("fmu", "simulate", fmu3, "--input", far, "--until", "1e9", "--every", "1e6")
    code, _, err = command(*command_line)
    assert code == 2
    assert "with loads in steps of 0.001 s would take 174 days" in err


def test_a_rate_that_fmi_3_cannot_tell_is_refused(fmu3):
    with (
        FmuRunner(fmu3, {}) as runner,
        pytest.raises(LandingError, match="cannot carry; set it in steps"),
    ):
        runner.set_inputs({"external.force_x": 1.0}, {"external.force_x": 2.0})


@pytest.mark.parametrize("version", [2, 3])
def test_a_runner_that_was_closed_gives_no_values(fmu, fmu3, version):
    runner = FmuRunner(fmu if version == 2 else fmu3, {})
    assert set(runner.statistics()) == {q.name for q in STATISTIC_QUANTITIES if q.kind == "integer"}
    runner.close()
    for call in (runner.values, runner.peaks, lambda: runner.step(0, 1e-3)):
        with pytest.raises(LandingError, match="has been freed"):
            call()


def test_info_shows_the_size_of_arrays(command, fmu3):
    code, out, _ = command("fmu", "info", fmu3, "--json")
    types = {v["name"]: v["type"] for v in json.loads(out)["variables"]}
    assert code == 0
    assert (types["leg.contact.force"], types["body.y"]) == ("Float64[4]", "Float64")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "has no rows of inputs"),
        ("time,external.force_x\n", "has no rows of inputs"),
        ("time,external.force_q\n0,1\n", "did you mean external.force_"),
        ("time,external.force_x [m]\n0,1\n", "has the wrong unit"),
        ("external.force_x,time\n0,1\n", "a column time [s] first"),
        ("time\n0\n", "a column time [s] first"),
        ("time,external.force_x\n1,2\n0,1\n", "line 3: time = 0 s comes after 1 s"),
        ("time,external.force_x\n0,nan\n", "line 2: external.force_x = nan N is outside"),
        ("time,external.force_x\n0,\n", "line 2: external.force_x = '' is no number"),
        ("time,external.force_x\n0,2 kN\n", "'kN' follows the number"),
        ("time,external.force_x [kN]\n0,1e5\n", "external.force_x = 1e+08 N is outside"),
        ("time;external.force_x\n0;1\n", "is separated by semicolons"),
        ("time,external.force_x\n-1,1\n", "time = -1 s is outside"),
        ("time,external.force_x\n0\n", "1 values under 2 headings"),
        ("time,ground.tilt,ground.tilt\n0,1,1\n", "two columns of ground.tilt"),
    ],
)
def test_a_table_that_is_wrong_is_refused(table, text, reason):
    with pytest.raises(LandingError) as refused:
        read_inputs(table(text))
    assert reason in str(refused.value)
    assert "inputs.csv" in str(refused.value)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--until", "0"], "until = 0 s must be finite, after the present time, 0 s"),
        (["--every", "nan"], "every = nan s must be finite and above 0 s"),
        (["--every", "1e-12"], "samples of 1e-12 s"),
        (["--set", "vehicle.mas=3"], "did you mean vehicle.mass?"),
        (["--input", "nosuch.csv"], "there is no table of inputs nosuch.csv"),
        (["--input", "a.csv", "--input", "b.csv"], "give one table of inputs, not 2"),
        (["--input", "external.force_x=1e9"], "external.force_x = 1e+09 N is outside"),
        (["--output", "x.txt"], "x.txt must end in .csv or .parquet"),
        (["--plot", "x.jpg"], "x.jpg must end in .png"),
        (["--output", "nosuch/x.csv"], "there is no folder nosuch"),
        (["--set", "drop.contact_time=0.9"], "drop.contact_time = 0.9 s"),
    ],
)
def test_what_cannot_be_landed_is_refused_in_one_line(
    command, fmu, arguments, reason, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    code, out, errors = command("fmu", "simulate", fmu, *arguments)
    assert (code, out) == (2, "")
    assert reason in errors
    assert errors.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_info_of_a_foreign_fmu_is_what_fmpy_reads(command, tmp_path):
    foreign = tmp_path / "Other.fmu"
    with zipfile.ZipFile(foreign, "w") as archive:
        archive.writestr(
            "modelDescription.xml",
            '<fmiModelDescription fmiVersion="3.0" modelName="Other" instantiationToken="{1}">'
            '<CoSimulation modelIdentifier="Other"/><ModelVariables>'
            '<Float64 name="t" valueReference="0" causality="independent" '
            'variability="continuous"/>'
            '<Float64 name="a[b]" valueReference="1" causality="parameter" variability="fixed" '
            'initial="exact" start="1 2.5"><Dimension start="2"/></Float64>'
            '<String name="s" valueReference="2" causality="parameter" variability="fixed" '
            'initial="exact"><Start value="x"/></String>'
            "</ModelVariables><ModelStructure/></fmiModelDescription>",
        )
        archive.writestr("binaries/x86_64-linux/Other.so", "")
    code, out, _ = command("fmu", "info", foreign, "--json")
    assert code == 0
    found = json.loads(out)
    assert not found["ours"]
    assert found["platforms"] == ["x86_64-linux"]
    assert [v["name"] for v in found["variables"]] == ["t", "a[b]", "s"]
    code, out, _ = command("fmu", "info", foreign)
    assert code == 0
    assert "a[b]" in out
    code, _, errors = command("fmu", "simulate", foreign)
    assert code == 2
    assert "holds the model 'Other', which is not of rlv-landing" in errors
