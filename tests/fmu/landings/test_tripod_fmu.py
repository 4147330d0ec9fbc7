"""The FMUs of a vehicle on tripods: variables, digits, what they refuse, and a log of one.

They are built for these tests alone, so `make torture` runs them.
"""

from __future__ import annotations

import os
from pathlib import Path

import bridge_tools
import fmpy
import numpy as np
import pytest
from five_legs import FIVE_LEGS, five_legs
from lxml import etree

from fmu_build.build import build
from fmu_build.fronts.header import MOST_VARIABLES
from fmu_build.terminals import terminals_and_icons
from fmu_build.wanted import Wanted
from rlv_landing import Landing, LandingError, Parameters, load_preset
from rlv_landing.hosted import HostedLanding
from rlv_landing.quantities import interface_of, whole_name
from rlv_ros_bridge.fmu.description import interface_in
from rlv_ros_bridge.logs.reader import LogReader
from rlv_ros_bridge.logs.verification.verify import verify

TRIPOD = {"leg.kind": "tripod"}
OUTPUTS = interface_of("space", 5, "tripod").output_names
LONG = (
    pytest.mark.torture,
    pytest.mark.skipif("RLV_TORTURE" not in os.environ, reason="it is long: make torture"),
)


def on_tripods() -> Parameters:
    return five_legs().with_values(TRIPOD)


def test_an_fmu_has_room_for_the_variables_of_every_vehicle() -> None:
    most = load_preset("yue2022-figures").with_values({"drop.mode": "space", "vehicle.legs": 8.0})
    for own in ({}, TRIPOD):
        assert len(Wanted(most.with_values(own)).quantities) <= MOST_VARIABLES


def test_another_kind_of_legs_is_refused() -> None:
    for kind, other in (("radial", "tripod"), ("tripod", "radial")):
        hosted = HostedLanding({**FIVE_LEGS, "leg.kind": kind})
        hosted.set_parameter("leg.kind", other)
        with pytest.raises(LandingError, match=f"leg.kind = {other} has other outputs") as error:
            hosted.begin()
        assert "\n" not in str(error.value)


def test_terminals_have_both_auxiliary_struts_also_with_flat_names() -> None:
    for convention, names in (
        ("structured", ("leg.auxiliary_strut.force", "leg.auxiliary_strut_2.force")),
        ("flat", ("leg_auxiliary_strut_force", "leg_auxiliary_strut_2_force")),
    ):
        root = etree.Element("fmiModelDescription", variableNamingConvention=convention)
        variables = etree.SubElement(root, "ModelVariables")
        for name in names:
            etree.SubElement(variables, "Float64", name=name, causality="output")
        found = {
            node.attrib["name"]: [v.attrib["variableName"] for v in node]
            for node in terminals_and_icons(root).iter("Terminal")
            if node.attrib["name"].startswith("auxiliary")
        }
        assert found == {"auxiliary_strut": [names[0]], "auxiliary_strut_2": [names[1]]}


@pytest.mark.parametrize("fmi", [pytest.param("2", marks=LONG), pytest.param("3", marks=LONG)])
def test_an_fmu_on_tripods_lands_and_is_recorded_to_the_digits_of_landing(
    fmi: str, tmp_path: Path, command
) -> None:
    path = tmp_path / f"Tripod{fmi}.fmu"
    build(path, Wanted(on_tripods(), "five tripods", "Tripods", fmi=fmi))
    description = fmpy.read_model_description(str(path))
    assert interface_in(description).output_names == OUTPUTS
    wanted = OUTPUTS if fmi == "2" else tuple(dict.fromkeys(map(whole_name, OUTPUTS)))
    found = fmpy.simulate_fmu(str(path), stop_time=0.4, output_interval=2e-3, output=list(wanted))
    history = Landing(on_tripods()).run(0.4, 2e-3)
    assert history["leg[1].auxiliary_strut_2.force"].max() > 500.0
    for name in OUTPUTS:
        column = found[name] if fmi == "2" else found[whole_name(name)]
        if column.ndim == 2:
            column = column[:, int(name[4]) - 1]
        assert np.array_equal(column, history[name]), name
    log = bridge_tools.record(path, tmp_path / "log", "--stop-time", 0.4)
    for other in (None, path):
        same = verify(LogReader(log), other)
        assert (same.same, same.other_bits, same.first) == (True, 0, None)
    done = command("view", str(log), "--save", str(tmp_path / "landing.rrd"))
    assert (done.code, done.err) == (0, "")
