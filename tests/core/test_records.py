"""Records are the only layout: kernels write where the names of the quantities say."""

from array import array

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rlv_landing import Parameters
from rlv_landing.assembly import body_model, leg_models, new_solver
from rlv_landing.core import AUXILIARY_STRUTS, FRICTION_LAWS, MAIN_STRUTS, Phase, access, records
from rlv_landing.landing import DEFAULT_RTOL
from rlv_landing.parameters import PARAMETER_QUANTITIES
from rlv_landing.quantities import (
    BODY_QUANTITIES,
    ENERGY_QUANTITIES,
    INPUT_QUANTITIES,
    LEG_QUANTITIES,
    STATUS_QUANTITIES,
)
from rlv_landing.summary import OUTCOMES


@pytest.mark.parametrize(
    ("record", "quantities"),
    [
        (records.BodyOutputs, BODY_QUANTITIES),
        (records.EnergyOutputs, ENERGY_QUANTITIES),
        (records.StatusOutputs, STATUS_QUANTITIES),
    ],
)
def test_outputs_are_in_the_order_of_their_quantities(record, quantities):
    assert list(record._fields) == [q.name.split(".")[1] for q in quantities]


def test_a_legs_outputs_are_in_the_order_of_their_quantities():
    assert list(records.LegOutputs._fields) == [q.name.replace(".", "_") for q in LEG_QUANTITIES]


def test_inputs_are_in_the_order_of_their_quantities():
    assert list(records.Inputs._fields) == [q.name.split(".")[1] for q in INPUT_QUANTITIES]


def test_accounts_are_what_the_energies_name():
    """Dissipated in the ways that come first, supplied in those that come last."""
    named = [q.name.split(".")[1] for q in ENERGY_QUANTITIES]
    booked = [name.split("_")[1] for name in named if name.startswith(("dissipated_", "work_"))]
    assert list(records.Accounts._fields) == booked


def test_phases_are_described_in_their_order():
    described = next(q for q in STATUS_QUANTITIES if q.name == "status.phase")
    assert (described.lo, described.hi) == (min(Phase), max(Phase))
    for phase in Phase:
        assert f"{phase.value} {phase.name.lower()}" in described.meaning
    assert len(OUTCOMES) == len(Phase)


def test_every_number_of_the_models_comes_from_a_parameter_or_is_worked_out_of_some():
    models = (body_model(Parameters()), *leg_models(Parameters()))
    assert all(isinstance(value, float) for model in models for value in model)


def test_the_numbers_of_laws_are_their_places_in_the_order_of_names():
    leg = leg_models(Parameters())[0]
    assert sorted(MAIN_STRUTS)[int(leg.main_kind)] == "liquid-spring"
    assert sorted(AUXILIARY_STRUTS)[int(leg.auxiliary_kind)] == "elastic-with-play"
    assert sorted(FRICTION_LAWS)[int(leg.friction_kind)] == "passive"
    none = {"auxiliary_strut.play_tension": 0.0, "auxiliary_strut.play_compression": 0.0}
    paper = leg_models(Parameters().with_values({"ground.friction_law": "paper", **none}))[0]
    assert sorted(AUXILIARY_STRUTS)[int(paper.auxiliary_kind)] == "elastic"
    assert sorted(FRICTION_LAWS)[int(paper.friction_kind)] == "paper"
    assert set(FRICTION_LAWS) == set(PARAMETER_QUANTITIES["ground.friction_law"].choices)


numbers = st.lists(st.floats(allow_nan=False), min_size=20, max_size=20)


@given(numbers, st.integers(0, 12))
def test_a_record_that_is_put_back_where_it_was_read_changes_nothing(values, at):
    for read in (access.leg_state, access.body_state, access.inputs):
        y = array("d", values)
        access.put(read(y, at), y, at)
        assert list(y) == values


@given(numbers)
def test_a_record_is_written_in_the_order_of_its_fields(values):
    y = array("d", bytes(8 * 30))
    access.put(records.LegState(*values[:8]), y, 7)
    assert list(y) == [0.0] * 7 + values[:8] + [0.0] * 15
    assert access.leg_state(y, 7) == records.LegState(*values[:8])


def test_the_compiled_outputs_have_the_length_that_the_records_say(mode):
    system = new_solver(Parameters().for_mode(mode), DEFAULT_RTOL).system
    # each group has a leg's state and a main strut's work
    groups = (system.n - access.BODY - access.ACCOUNTS) // (access.LEG + 1)
    assert system.n == access.BODY + (access.LEG + 1) * groups + access.ACCOUNTS
    assert (
        system.row
        == access.BODY_OUTPUTS
        + access.ENERGY_OUTPUTS
        + access.STATUS_OUTPUTS
        + access.LEG_OUTPUTS * groups
    )
