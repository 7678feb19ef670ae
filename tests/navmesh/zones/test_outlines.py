"""Which cells and links a zone concerns."""

import numpy as np
import pytest

from navmesh import NavmeshError
from navmesh.zones.outlines import checked_outlines, concerned_by
from tests.navmesh.shapes import box, plane
from tests.navmesh.surface.levels import build

TURNED = np.array([(4.1, 2.0, 0.0), (6.3, 3.1, 0.0), (5.7, 4.4, 0.0), (3.5, 3.3, 0.0)])


def far_from(outline: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Slow: distance of ``points`` (k, 2) to the sides of an outline, each of many places on them."""
    places = [
        a + t * (b - a)
        for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True)
        for t in np.linspace(0.0, 1.0, 400)
    ]
    return np.array([np.hypot(*(np.array(places)[:, :2] - point).T).min() for point in points])


def inside_of(outline: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Slow: whether ``points`` (k, 2) are to the left of all sides."""
    side = np.roll(outline, -1, axis=0) - outline
    off = points[:, None] - outline[None, :, :2]
    return (side[:, 0] * off[..., 1] - side[:, 1] * off[..., 0] > 0.0).all(axis=1)


def test_cells_know_a_zone_that_is_nearer_than_where_walking_ends():
    surface = build(plane(0, 10, 0, 8), box(7.0, 7.5, 1.0, 2.0, 0.0, 2.0)).surface
    outline = TURNED - surface.origin
    found = concerned_by(outline, surface, 1.0, np.zeros(len(surface), np.int32), 1)
    centres = surface.centers()[:, :2] - surface.origin[:2]
    inside = inside_of(outline, centres)
    far = np.where(inside, 0.0, far_from(outline, centres))
    must = far < surface.clearance - 1e-3
    assert set(np.flatnonzero(must)) <= set(found.cell.tolist())
    np.testing.assert_allclose(np.hypot(*found.nearest.T), far[found.cell], atol=5e-3)
    assert (np.diff(found.cell) > 0).all()
    assert len(found.cell) < len(surface)


def test_links_over_the_outline_are_cut_both_ways():
    surface = build(plane(0, 10, 0, 8)).surface
    outline = TURNED - surface.origin
    cut = concerned_by(outline, surface, 1.0, np.zeros(len(surface), np.int32), 1).cut
    centres = surface.centers()[:, :2] - surface.origin[:2]
    inside = inside_of(outline, centres)
    cell, way = np.nonzero((surface.link >= 0) & (inside[:, None] != inside[surface.link]))
    assert {*zip(cell.tolist(), way.tolist(), strict=True)} <= {tuple(each) for each in cut.tolist()}
    there = {(int(surface.link[cell, way]), int(way + 2) % 4) for cell, way in cut}
    assert there == {tuple(each) for each in cut.tolist()}


def test_a_line_cuts_what_is_on_its_two_sides():
    surface = build(plane(0, 10, 0, 8)).surface
    line = np.array([(5.0, -1.0, 0.0), (5.0, 9.0, 0.0)]) - surface.origin
    found = concerned_by(line, surface, 1.0, np.zeros(len(surface), np.int32), 1)
    assert len(found.cut) == 2 * 32
    assert (np.hypot(*found.nearest.T) > 0.0).all()


def test_cells_know_the_end_of_a_zone_that_is_over_none():
    """It sticks 4 cm out of a wall, beside cells that begin 10 cm on."""
    surface = build(plane(0, 10, 0, 8), box(4.9, 5.15, 1.0, 7.0, 0.0, 2.5)).surface
    line = np.array([(4.0, 3.6, 0.0), (5.19, 3.6, 0.0)]) - surface.origin
    found = concerned_by(line, surface, 1.0, np.zeros(len(surface), np.int32), 1)
    beyond = surface.centers()[:, 0] > 5.15
    must = np.flatnonzero(
        beyond & (far_from(line, surface.centers()[:, :2] - surface.origin[:2]) < surface.clearance - 1e-3)
    )
    assert len(must) and set(must.tolist()) <= set(found.cell.tolist())
    thick = np.array([(4.0, 3.6, 0.0), (5.14, 3.6, 0.0)]) - surface.origin
    found = concerned_by(thick, surface, 1.0, np.zeros(len(surface), np.int32), 1)
    assert not beyond[found.cell].any()  # a wall is between


def test_a_zone_is_of_one_storey():
    surface = build(plane(0, 10, 0, 8), plane(0, 10, 0, 8, 3.0)).surface
    found = concerned_by(TURNED - surface.origin, surface, 1.0, np.zeros(len(surface), np.int32), 1)
    assert (surface.height[found.cell] < 1.0 - surface.origin[2]).all()


@pytest.mark.parametrize(
    ("outlines", "told"),
    [
        ([TURNED], "corners"),
        ({"": TURNED}, "a name"),
        ({"door": TURNED[:1]}, "two corners or more"),
        ({"door": TURNED[:, :2]}, "two corners or more"),
        ({"door": [(1, 0, 0), (0, 0, np.nan)]}, "'door', corner 1: expected finite"),
        ({"door": [(1, 2, 0), (1, 2, 0)]}, "'door': expected corners at different places"),
        ({"door": TURNED[[0, 2, 1, 3]]}, "'door': the sides from corners 0 and 2 cross"),
        ({"door": "here"}, "two corners or more"),
    ],
)
def test_what_is_no_outline_is_refused(outlines, told):
    with pytest.raises(NavmeshError, match=told):
        checked_outlines(outlines)
