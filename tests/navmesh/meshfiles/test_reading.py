"""PLY, STL and OFF: polygons, both byte orders, everything that exporters add; what is wrong is named."""

import re
import struct

import numpy as np
import pytest
import trimesh

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.mesh_measures import area, upward_area, volume
from tests.navmesh.meshfiles.test_obj import prisms

SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)]
L_SHAPE = [(14, 0, 0), (14, 1, 0), (11, 1, 0), (11, 4, 0), (10, 4, 0), (10, 0, 0)]
FORMATS = ["ascii", "binary_little_endian", "binary_big_endian"]


def load(tmp_path, name, content):
    file = tmp_path / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return Terrain.load(file)


def ply(kind, points, faces, corners="property list uchar int vertex_indices", end="\n", name="face"):
    head = [
        "ply",
        f"format {kind} 1.0",
        "comment made by hand, see end_header",
        f"element vertex {len(points)}",
    ]
    head += [f"property {'float' if kind == 'ascii' else 'double'} {axis}" for axis in "xyz"]
    head += [f"element {name} {len(faces)}", corners, "end_header", ""]
    text = end.join(head)
    if kind == "ascii":
        rows = [*points, *([len(face), *face] for face in faces)]
        return (text + end.join(" ".join(str(value) for value in row) for row in rows) + end).encode()
    order = "<" if "little" in kind else ">"
    body = b"".join(struct.pack(f"{order}3d", *point) for point in points)
    return text.encode() + body + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


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
def test_ply_faces(tmp_path, kind, faces, square_metres):
    terrain = load(tmp_path, "level.ply", ply(kind, SQUARE + L_SHAPE, faces))
    assert area(terrain) == pytest.approx(square_metres)
    assert upward_area(terrain) == pytest.approx(square_metres)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("seed", range(5))
def test_ply_random_polygons(tmp_path, kind, seed):
    points, outlines, surface, inside = prisms(np.random.default_rng(seed))
    terrain = load(tmp_path, "level.ply", ply(kind, points.tolist(), outlines))
    assert (area(terrain), volume(terrain)) == pytest.approx((surface, inside))


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_ply_other_spellings(tmp_path, kind, end):
    file = ply(kind, SQUARE, [(0, 1, 2, 3)], "property list uint8 int32 vertex_index", end)
    assert area(load(tmp_path, "level.ply", file)) == pytest.approx(16)


@pytest.mark.parametrize("kind", FORMATS)
def test_ply_strips(tmp_path, kind):
    strip = [(0, 1, 3, 2, -1, 4, 5, 6)]
    file = ply(kind, SQUARE + L_SHAPE, strip, name="tristrips")
    terrain = load(tmp_path, "level.ply", file)
    assert upward_area(terrain) == pytest.approx(16 + 1.5)


def test_ply_other_elements_and_properties(tmp_path):
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
def test_ply_what_is_wrong(tmp_path, kind, change, says):
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
def test_ply_geometry_that_is_wrong(tmp_path, kind, points, faces, says):
    with pytest.raises(NavmeshError, match=re.escape(says)):
        load(tmp_path, "level.ply", ply(kind, points, faces))


def off(head="OFF\n6 1 0", points=L_SHAPE, more="", faces="6 0 1 2 3 4 5"):
    return f"{head}\n" + "".join(f"{x} {y} {z}{more}\n" for x, y, z in points) + f"{faces}\n"


@pytest.mark.parametrize(
    "text",
    [
        off(),
        off("OFF 6 1 0"),
        off("OFF\n6 1"),
        off("6 1 0"),
        off("# made by hand\n\nOFF # a level\n\n6 1 0 # counts"),
        off("COFF\n6 1 0", more=" 255 0 0 255"),
        off("CNOFF\n6 1 0", more=" 0 0 1 0.5 0.5 0.5 1"),
        off("STOFF\n6 1 0", more=" 0.1 0.9"),
        off(faces="6 0 1 2 3 4 5 255 0 0"),
        off(faces="6 0 1 2 3 4 5 # floor"),
        off().replace("\n", "\r\n"),
        off("OFF\n6 3 0", faces="6 0 1 2 3 4 5\n2 0 1\n1 0"),
    ],
)
def test_off(tmp_path, text):
    terrain = load(tmp_path, "level.off", text)
    assert area(terrain) == pytest.approx(7) and upward_area(terrain) == pytest.approx(7)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "expected an OFF file"),
        ("OFF\n", "how many vertices"),
        (off("4OFF\n6 1 0", more=" 1"), "line 1: '4OFF' is not read"),
        (off("nOFF\n3\n6 1 0"), "is not read"),
        ("OFF BINARY\n\0\0\0\4", "is not read"),
        (off("PLY\n6 1 0"), "expected OFF"),
        (off("OFF\n6 2 0"), "7 lines for 6 vertices and 2 faces"),
        (off("OFF\n5 1 0"), "7 lines for 5 vertices"),
        (off(faces="6 0 1 2 3 4"), "line 9: '6 0 1 2 3 4': expected how many corners"),
        (off(faces="3 0 1 6"), "6 vertices"),
        (off(faces="3 0 1 -1"), "6 vertices"),
        (off(faces="3 0 1 x"), "line 9"),
        (off(points=[*L_SHAPE[:5], (10, 0, "nan")]), "line 8: '10 0 nan': a coordinate is not finite"),
        (off(points=[*L_SHAPE[:5], (10, 0, "")]), "line 8: '10 0': expected three numbers"),
        (off(faces="4 0 5 1 4"), "line 9: the outline of the polygon crosses itself"),
    ],
)
def test_off_what_is_wrong(tmp_path, text, says):
    with pytest.raises(NavmeshError, match=rf"level\.off: .*{re.escape(says)}"):
        load(tmp_path, "level.off", text)


def stl(*outlines, name=""):
    lines = [f"solid {name}"]
    for outline in outlines:
        corners = [f"      vertex {x} {y} {z}" for x, y, z in outline]
        lines += ["  facet normal 0 0 1", "    outer loop", *corners, "    endloop", "  endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])


def binary_stl(head=b"level", count=2):
    facets = [SQUARE[:3], [SQUARE[0], SQUARE[2], SQUARE[3]]]
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *sum(corners, ()), 0xFFFF) for corners in facets)
    return head.ljust(80) + struct.pack("<I", count) + body


TWO = (SQUARE[:3], [SQUARE[0], SQUARE[2], SQUARE[3]])


@pytest.mark.parametrize(
    "content",
    [
        stl(*TWO),
        stl(*TWO, name="vertex 1 2 3 facet endsolid"),
        stl(*TWO).upper(),
        stl(*TWO).replace("\n", "\r\n"),
        stl(*TWO).replace("\n", "\r"),
        stl(SQUARE),
        stl(TWO[0], name="a") + stl(TWO[1], name="b"),
        ("\ufeff" + stl(*TWO)).encode("utf-8"),
        ("\ufeff" + stl(*TWO)).encode("utf-16-le"),
        stl(*TWO).replace("4", "4.0E+00"),
        binary_stl(),
        binary_stl(b"solid made by a program that says so"),
        binary_stl(b"solid facet outer loop vertex endsolid"),
        binary_stl() + b"\0" * 17,
    ],
)
def test_stl(tmp_path, content):
    terrain = load(tmp_path, "level.stl", content)
    assert area(terrain) == pytest.approx(16) and upward_area(terrain) == pytest.approx(16)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "expected an STL file"),
        (stl(*TWO).replace("endsolid", ""), "is no line|cut off"),
        (stl(*TWO)[:-60], "line 12: 'verte' is no line"),
        (stl(*TWO).split("endsolid")[0], "cut off"),
        (stl(*TWO).replace("4 4 0", "4,5 4 0"), "line 6: '4,5 4 0': expected three numbers"),
        (stl(*TWO).replace("4 4 0", "inf 4 0"), "line 6: 'inf 4 0': a coordinate is not finite"),
        (stl(*TWO).replace("outer loop", "inner ring"), "line 3: 'inner ring' is no line of an STL file"),
        (stl([SQUARE[k] for k in (0, 2, 1, 3)]), "line 4: the outline of the polygon crosses itself"),
        (binary_stl()[:-20], "cut off: 164 bytes, 2 facets take 184"),
        (binary_stl(count=3), "cut off"),
        (binary_stl(count=0), "expected an STL file with facets"),
        (
            binary_stl()[:96] + struct.pack("<f", np.nan) + binary_stl()[100:],
            "facet 0: a corner is not finite",
        ),
    ],
)
def test_stl_what_is_wrong(tmp_path, content, says):
    with pytest.raises(NavmeshError, match=rf"level\.stl: .*({says})"):
        load(tmp_path, "level.stl", content)


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "off", "glb"])
def test_what_trimesh_writes(tmp_path, suffix):
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=3.0)
    mesh.apply_translation((100.0, -20.0, 4.0))
    mesh.export(tmp_path / f"level.{suffix}")
    terrain = Terrain.load(tmp_path / f"level.{suffix}", up="z")
    assert len(terrain.faces) == len(mesh.faces)
    assert (area(terrain), volume(terrain)) == pytest.approx((mesh.area, mesh.volume), rel=1e-5)
    np.testing.assert_allclose(terrain.bounds, mesh.bounds, atol=1e-4)


@pytest.mark.parametrize("name", ["level.blend", "level.dae", "level.zip", "level", "level.obj.txt"])
def test_other_formats_are_refused_with_what_helps(tmp_path, name):
    with pytest.raises(NavmeshError, match=rf"{re.escape(name)}: .*\.obj, \.ply, .*export it .*\.glb"):
        load(tmp_path, name, b"content")
