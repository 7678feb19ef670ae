"""What keeps two places apart is measured on the mesh: its kind, its size, and where it is."""

import numpy as np
import pytest

from runtime.playtest.barriers import opening_at
from runtime.playtest.openings import Barrier
from runtime.playtest.sides import Side
from tests.runtime.playtest.levels import FLOOR, HOLED, D, W, box, door, played, ramp, room, site_of


@pytest.mark.parametrize(
    ("mesh", "kind", "size", "x", "says"),
    [
        (room(*HOLED), "hole", 2.0, 8.0, "a hole of 2.00 by 2.00 m"),
        (room(*door(0.5)), "narrow", 0.5, 8.15, "0.50 m wide; a person needs 0.60 m"),
        (room(*door(0.35)), "narrow", 0.35, 8.15, "0.35 m wide; a person needs 0.60 m"),
        (room(*door(1.2, 1.7)), "low", 1.7, 8.15, "1.70 m high; a person needs 1.90 m"),
        (room(*door(4.0, 1.7)), "low", 1.7, 8.15, "1.70 m high; a person needs 1.90 m"),
        (room(*ramp(50), high=5.0), "steep", 50.0, 9.4, "50° steep; a person walks up to 20°"),
        (
            room(box(0, 8, 0, D, -0.2, 0), box(8.31, W, 0, D, -0.2, 0)),
            "gap",
            0.31,
            8.15,
            "0.31 m wide; a person leaps 0.40 to 2.50 m",
        ),
        (room(FLOOR, box(8, W, 0, D, 0, 0.94)), "ledge", 0.94, 8.0, "0.94 m above the floor beside it"),
    ],
)
def test_a_fault_is_named_and_measured_where_it_is(tmp_path, mesh, kind, size, x, says):
    (fault,) = played(tmp_path, mesh).report.failures
    assert fault.kind == kind and says in fault.text
    assert fault.size == pytest.approx(size, abs=0.5 if kind == "steep" else 0.02)
    assert fault.position[0] == pytest.approx(x, abs=0.2)
    if kind in ("hole", "narrow", "low"):
        assert fault.position[1] == pytest.approx(5.0, abs=0.1)
    if kind != "steep":
        assert np.linalg.norm(np.diff(fault.span, axis=0)) == pytest.approx(size, abs=0.03)


def opening(*parts, at=8.15):
    """Between places 1 m on both sides of x = ``at``, in the middle of the room."""
    site = site_of(room(*parts))
    ends = np.array([[at - 1.0, 5.0, 0.0], [at + 1.0, 5.0, 0.0]])
    sides = (Side(site.graph.surface, site.graph.project(end[None])[0]) for end in ends)
    return opening_at(site, ends, *sides)


def test_a_door_as_wide_as_the_body_passes_and_is_told_to_be_tight():
    wide, tight, narrow = (opening(*door(width)) for width in (2.0, 0.66, 0.5))
    assert wide.passes and tight.passes and not narrow.passes
    found = tight.tight()
    assert found.kind == "passes" and found.size == pytest.approx(0.66, abs=0.005)
    assert narrow.narrow(0.3).size == pytest.approx(0.5, abs=0.005)
    assert narrow.narrow(0.55) is None  # wider than this it is not


def test_a_lintel_is_measured_from_the_floor():
    low = opening(*door(1.2, 1.5))
    assert not low.passes and low.narrow(0.1) is None
    found = low.low(1.0)
    assert isinstance(found, Barrier) and found.size == pytest.approx(1.5, abs=0.005)
    assert found.span[1] - found.span[0] == pytest.approx([0.0, 0.0, found.size])
    assert low.low(1.6) is None


@pytest.mark.parametrize(
    ("parts", "joins"),
    [
        ((box(8, W, 0, D, 0, 3.0),), False),  # a floor 3 m up
        ((box(8, W, 0, D, 0, 3.0), box(7.9, 8, 3, 7, 0, 1.5)), True),  # with a block before it
        ((box(8, W, 0, D, 0, 3.0), box(7.9, 8, 3, 7, 0, 0.3)), False),  # that is too low
        ((box(8, W, 0, D, 0, 1.8),), True),
    ],
)
def test_sides_far_apart_in_height_are_not_looked_at(parts, joins):
    site = site_of(room(FLOOR, *parts, high=6.0))
    ends = np.array([[7.0, 5.0, 0.0], [9.0, 5.0, 1.8 if len(parts) == 1 and joins else 3.0]])
    sides = (Side(site.graph.surface, site.graph.project(end[None])[0]) for end in ends)
    place = opening_at(site, ends, *sides)
    assert place.may_join(1.9) == joins
    if not joins:  # as it is found by looking
        assert not place.passes_with(step=1.9) and not place.passes_with(headroom=0.9)
        assert place.gap(site.mesh_grid, site.graph.surface.origin) is None
        assert place.wall(site.mesh_grid, site.graph.surface.origin) is None
