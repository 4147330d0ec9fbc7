"""The tracing of a boundary, on shapes whose boundary is known."""

from __future__ import annotations

from math import hypot, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rlv_landing.studies.envelope.boundary import Lattice, Tracer

LATTICE = Lattice(8, 2, (32, 64))


class Shape:
    """A judge of `inside(u, v)`, u and v from 0 to 1, that counts."""

    def __init__(self, inside, lattice=LATTICE):
        self.inside, self.lattice, self.judged = inside, lattice, []

    def at(self, point):
        return bool(self.inside(point[0] / self.lattice.size[0], point[1] / self.lattice.size[1]))

    def __call__(self, points):
        self.judged += points
        return [self.at(p) for p in points]

    def trace(self):
        return Tracer(self.lattice, self).trace()


def disc(x, y, radius):
    return lambda u, v: hypot(u - x, v - y) < radius


def test_every_crossing_lies_between_neighbours_that_differ():
    shape = Shape(disc(0.45, 0.55, 0.3))
    for line in shape.trace():
        for c in line:
            assert sorted((abs(c.stable[0] - c.lost[0]), abs(c.stable[1] - c.lost[1]))) == [0, 1]
            assert shape.at(c.stable)
            assert not shape.at(c.lost)


def test_a_circle_is_one_closed_line_and_a_slant_one_open():
    (circle,) = Shape(disc(0.5, 0.5, 0.3)).trace()
    assert circle[0] == circle[-1]
    (slant,) = Shape(lambda u, v: v < 0.3 + 0.4 * u).trace()
    assert {c.middle[0] for c in (slant[0], slant[-1])} == {0.0, float(LATTICE.size[0])}


def test_no_point_is_judged_twice_and_far_fewer_than_a_uniform_grid_are():
    shape = Shape(disc(0.5, 0.5, 0.3))
    shape.trace()
    assert len(set(shape.judged)) == len(shape.judged)
    assert 100 * len(shape.judged) < LATTICE.uniform == (8 * 32 + 1) * (8 * 64 + 1)


@given(x=st.floats(0.1, 0.9), y=st.floats(0.1, 0.9))
def test_an_island_larger_than_a_coarse_cell_is_found_wherever_it_lies(x, y):
    # a disc of radius cell/sqrt(2) holds a corner of the coarse cells
    assert Shape(disc(x, y, 0.5**0.5 / 8 + 1e-9)).trace()


def test_an_island_within_a_coarse_cell_is_not_seen():
    assert Shape(disc(0.3125, 0.3125, 0.08)).trace() == []


def test_one_verdict_everywhere_has_no_boundary_and_takes_the_coarse_corners_only():
    shape = Shape(lambda u, v: True)
    assert shape.trace() == []
    assert len(shape.judged) == 81


@pytest.mark.parametrize(
    "inside",
    [
        disc(0.5, 0.5, 0.3),
        lambda u, v: v < 0.5 + 0.3 * sin(7.0 * u),
        # a finger that enters two coarse cells between their corners
        lambda u, v: v < 0.3 or (abs(u - 0.44) < 0.05 and v < 0.62),
        lambda u, v: (u < 0.47) != (v < 0.53),
    ],
)
def test_the_boundary_crosses_the_edges_that_all_finest_cells_together_would_find(inside):
    """Once it is seen in one place it is followed, through cells whose own corners agree."""
    lattice = Lattice(8, 3, (8, 8))
    shape = Shape(inside, lattice)
    found = {frozenset((c.stable, c.lost)) for line in shape.trace() for c in line}
    side = range(lattice.size[0] + 1)
    edges = [
        ((i, j), (i + a, j + b))
        for i in side
        for j in side
        for a, b in ((1, 0), (0, 1))
        if i + a in side and j + b in side
    ]
    assert found == {frozenset(e) for e in edges if shape.at(e[0]) != shape.at(e[1])}
