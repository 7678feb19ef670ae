"""PLY: polygons and strips, text and both byte orders, everything that exporters add."""

import re
import struct

import numpy as np
import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.mesh_measures import area, upward_area, volume
from tests.navmesh.meshfiles.small_files import L_SHAPE, SQUARE, load, ply
from tests.navmesh.meshfiles.test_obj import prisms

FORMATS = ["ascii", "binary_little_endian", "binary_big_endian"]


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(
    ("faces", "square_metres"),
    [
        ([(0, 1, 2), (0, 2, 3)], 16),
        ([(0, 1, 2, 3)], 16),
        ([(4, 5, 6, 7, 8, 9)], 7),
        ([(0, 1, 2), (0, 2, 3), (4, 5, 6, 7, 8, 9)], 23),
        ([(4, 5, 6, 7, 8, 9), (0, 1, 2, 3)], 23),
        ([(0, 1), (0,), (), (0, 1, 2, 3)], 16),
    ],
)
def test_faces(tmp_path, kind, faces, square_metres):
    terrain = load(tmp_path, "level.ply", ply(kind, SQUARE + L_SHAPE, faces))
    assert area(terrain) == pytest.approx(square_metres)
    assert upward_area(terrain) == pytest.approx(square_metres)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("seed", range(5))
def test_random_polygons(tmp_path, kind, seed):
    points, outlines, surface, inside = prisms(np.random.default_rng(seed))
    terrain = load(tmp_path, "level.ply", ply(kind, points.tolist(), outlines))
    assert (area(terrain), volume(terrain)) == pytest.approx((surface, inside))


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_other_spellings(tmp_path, kind, end):
    file = ply(kind, SQUARE, [(0, 1, 2, 3)], "property list uint8 int32 vertex_index", end)
    assert area(load(tmp_path, "level.ply", file)) == pytest.approx(16)


@pytest.mark.parametrize("kind", FORMATS)
def test_strips(tmp_path, kind):
    strip = [(0, 1, 3, 2, -1, 4, 5, 6)]
    file = ply(kind, SQUARE + L_SHAPE, strip, name="tristrips")
    terrain = load(tmp_path, "level.ply", file)
    assert upward_area(terrain) == pytest.approx(16 + 1.5)


def test_other_elements_and_properties(tmp_path):
    head = """ply
format binary_little_endian 1.0
obj_info made by a scanner
element camera 2
property list uchar uchar name
property float view
element vertex 4
property uchar quality
property double z
property list uchar short seen_by
property double y
property double x
element face 1
property uchar flags
property list uchar int vertex_indices
property list uchar float texcoord
element edge 1
property int vertex1
property int vertex2
end_header
"""
    body = b"\x05helloABCD" + b"\x02hiABCD"
    for k, (x, y, z) in enumerate(SQUARE):
        body += struct.pack(f"<BdB{k}hdd", 9, z, k, *range(k), y, x)
    body += struct.pack("<BB4iB8fii", 1, 4, 0, 1, 2, 3, 8, *range(8), 0, 1)
    assert area(load(tmp_path, "level.ply", head.encode() + body)) == pytest.approx(16)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda file: file[:-5], "cut off|more than its header|not a number|names vertex"),
        (lambda file: file[: len(file) // 2], "PLY file|cut off|not a number"),
        (lambda file: file + (b"7 7\n" if b"ascii" in file else b"777"), "more than its header says"),
        (lambda file: file.replace(b"vertex 4", b"vertex 4000000000"), "cut off"),
        (lambda file: file.replace(b"face 2", b"face 3000000000"), "cut off"),
        (lambda file: file.replace(b"element vertex", b"elements vertex"), "line 4: 'elements vertex 4'"),
        (lambda file: file.replace(b"list uchar", b"list cucumber"), "no line of a PLY header"),
        (lambda file: file.replace(b"vertex_indices", b"corners"), "no list vertex_indices"),
        (lambda file: file.replace(b"format", b"formed"), "no line of a PLY header"),
        (lambda file: file.replace(b" y\n", b" w\n"), "x, y and z"),
        (lambda file: file[3:], "expected a PLY file"),
    ],
)
def test_what_is_wrong(tmp_path, kind, change, says):
    with pytest.raises(NavmeshError, match=rf"level\.ply: .*({says})"):
        load(tmp_path, "level.ply", change(ply(kind, SQUARE, [(0, 1, 2), (0, 2, 3)])))


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize(
    ("points", "faces", "says"),
    [
        (SQUARE, [(0, 1, 2), (0, 1, 7)], "face 1: names vertex 7; there are 4"),
        (SQUARE, [(0, 1, -1)], "face 0: names vertex -1"),
        ([(float("nan"), 0, 0), *SQUARE[1:]], [(0, 1, 2)], "vertex 0: [nan, 0.0, 0.0] is not finite"),
        (SQUARE, [(0, 1, 2), (0, 2, 1, 3)], "face 1: the outline of the polygon crosses itself"),
    ],
)
def test_geometry_that_is_wrong(tmp_path, kind, points, faces, says):
    with pytest.raises(NavmeshError, match=re.escape(says)):
        load(tmp_path, "level.ply", ply(kind, points, faces))
