"""Heights and slopes of floors come back bit for bit, however often a part of them is put in anew."""

import numpy as np
import pytest

from navmesh.level.raster import Patch
from navmesh.surface import floor_store
from navmesh.surface.floor_store import SIDE, join_floors, pack_floors, renew_floors

NX, NY = 12, 50


def floors(rng, columns):
    """(column_start, height, gradient) of columns with up to three storeys; much of it is level."""
    start = np.concatenate([[0], np.cumsum(rng.integers(0, 4, columns))]).astype(np.int32)
    cells = int(start[-1])
    height = np.where(rng.random(cells) < 0.5, rng.integers(0, 2, cells), rng.random(cells))
    slopes = np.concatenate([[[0.0, 0.0], [-0.0, 0.0]], rng.normal(size=(3000, 2))])
    rows = np.where(rng.random(cells) < 0.5, rng.integers(0, 2, cells), rng.integers(0, 3002, cells))
    return start, height, slopes[rows]


def check(store, start, height, gradient):
    found = store.unpacked(start)
    np.testing.assert_array_equal(found[0], height)
    assert (found[1].view(np.int64) == np.ascontiguousarray(gradient).view(np.int64)).all()  # -0.0, too
    columns = np.repeat(np.arange(len(start) - 1, dtype=np.int32), np.diff(start))
    cells = np.arange(len(height))[::-3]
    np.testing.assert_array_equal(store.height[store.places(start, columns[cells], cells)], height[cells])


def test_all_comes_back():
    start, height, gradient = floors(np.random.default_rng(1), NX * NY)
    check(pack_floors(start, height, gradient), start, height, gradient)


def test_level_ground_is_kept_once():
    start = np.arange(100 * SIDE + 1, dtype=np.int32)
    store = pack_floors(start, np.full(100 * SIDE, 1.5), np.zeros((100 * SIDE, 2)))
    assert len(store.height) == SIDE
    assert len(store.slopes) == 1


def test_parts_that_follow_each_other_are_joined():
    rng = np.random.default_rng(2)
    parts = [floors(rng, columns) for columns in (3 * SIDE, SIDE, 2 * SIDE + 5)]
    whole = join_floors([pack_floors(*part) for part in parts])
    start = np.concatenate([[0], np.cumsum(np.concatenate([np.diff(part[0]) for part in parts]))])
    check(whole, start.astype(np.int32), *(np.concatenate([part[k] for part in parts]) for k in (1, 2)))


@pytest.mark.parametrize("free", [0, 1 << 20])
def test_after_changes_all_versions_are_right(free, monkeypatch):
    """Two versions come from each, so both want to go on in the same pool."""
    monkeypatch.setattr(floor_store, "_FREE", free)
    rng = np.random.default_rng(3)
    first = floors(rng, NX * NY)
    versions = [(pack_floors(*first), first)]
    for _ in range(12):
        for old, before in versions[-2:]:
            left, near = rng.integers(0, NX - 1), rng.integers(0, NY - 1)
            window = left, near, rng.integers(left + 1, NX + 1), rng.integers(near + 1, NY + 1)
            patch = Patch(0.25, left - 1, near - 2, window[2] - left + 2, window[3] - near + 3)
            fresh = floors(rng, patch.nx * patch.ny)
            now = put(before, fresh, window, patch)
            new = pack_floors(*fresh)
            store = renew_floors(old, before[0], new, fresh[0], now[0], window, patch, NY)
            versions.append((store, now))
    for store, there in versions:
        check(store, *there)


def put(before, fresh, window, patch):
    """The slow way."""
    counts, heights, gradients = [], [], []
    for ix in range(NX):
        for iy in range(NY):
            inside = window[0] <= ix < window[2] and window[1] <= iy < window[3]
            column = (ix - patch.left) * patch.ny + iy - patch.near if inside else ix * NY + iy
            start, height, gradient = fresh if inside else before
            counts.append(start[column + 1] - start[column])
            heights.append(height[start[column] : start[column + 1]])
            gradients.append(gradient[start[column] : start[column + 1]])
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    return start, np.concatenate(heights), np.concatenate(gradients)
