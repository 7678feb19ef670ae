"""Floor inside of closed blocks is nobody's fault, floor inside of a closed room is."""

import numpy as np
import pytest
import trimesh

from runtime.playtest.solids import is_inside_solid
from tests.runtime.playtest.levels import box, site_of, unreached


def test_floor_inside_a_block_is_no_fault_but_floor_inside_a_room_is():
    floor, block = box(0, 20, 0, 12, -1, 0), box(2, 5, 4, 8, 0, 3)
    assert [fault for fault in unreached(trimesh.util.concatenate([floor, block])) if fault.fails] == []
    bottomless = block.copy()
    bottomless.update_faces(bottomless.face_normals[:, 2] > -0.5)
    assert [each for each in unreached(trimesh.util.concatenate([floor, bottomless])) if each.fails] == []
    inside = box(13, 16, 4, 8, 0, 3)  # the block in the room is nobody's either
    walls = [box(10, 10.3, 1, 11, 0, 4), box(18.7, 19, 1, 11, 0, 4)]
    walls += [box(10, 19, 1, 1.3, 0, 4), box(10, 19, 10.7, 11, 0, 4)]
    faults = [fault for fault in unreached(trimesh.util.concatenate([floor, block, inside, *walls]))]
    (fault,) = (each for each in faults if each.fails)
    assert fault.kind == "walled_off" and 9.9 <= fault.position[0] <= 19.1


@pytest.fixture(scope="module")
def site():
    """A block, and a room whose walls are blocks, on one floor."""
    walls = [box(10, 10.3, 1, 7, 0, 4), box(15.7, 16, 1, 7, 0, 4)]
    walls += [box(10, 16, 1, 1.3, 0, 4), box(10, 16, 6.7, 7, 0, 4), box(10, 16, 1, 7, 4, 4.3)]
    return site_of(trimesh.util.concatenate([box(0, 20, 0, 8, -1, 0), box(2, 5, 2, 6, 0, 3), *walls]))


@pytest.mark.parametrize(
    ("x", "inside"), [(1.0, False), (3.5, True), (2.3, True), (13.0, False), (10.15, True), (18.0, False)]
)
def test_in_a_block_every_way_leads_out_of_it(site, x, inside):
    assert is_inside_solid(site, np.array([x, 4.0, 0.0])) == inside
