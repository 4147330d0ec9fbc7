"""The audit of a level landing, in which some momenta do not change at all."""

from __future__ import annotations

import pytest

from rlv_landing.audit.momentum import contact
from rlv_landing.sizing import needs_like, size_vehicle


@pytest.mark.parametrize("like", ["hopper", "stage"])
def test_momenta_that_do_not_change_are_no_miss(like):
    vehicle = size_vehicle(needs_like(like, {}))
    assert [c.id for c in contact(vehicle, vehicle.drop.contact_time + 0.1) if not c.passed] == []
