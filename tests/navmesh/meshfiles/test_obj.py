"""OBJ files: every spelling of the same polygons gives the same surface; what is wrong is named by line."""

import re

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, Terrain
from tests.navmesh.meshfiles.mesh_measures import area, upward_area, volume

SQUARE = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n"


def load(tmp_path, text):
    file = tmp_path / "level.obj"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return Terrain.load(file)


@pytest.mark.parametrize(
    ("text", "square_metres"),
    [
        (SQUARE + "f 1 2 3 4\n", 16),
        (SQUARE + "f -4 -3 -2 -1", 16),
        (SQUARE + "f 1/1 2/2 3/3 4/4\n", 16),
        (SQUARE + "f 1//1 2//1 3//1 4//1\n", 16),
        (SQUARE + "f 1/1/1 2/2/1 3/3/1 4/4/1\n", 16),
        (SQUARE + "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1\n", 16),
        (SQUARE + "f\t1  2 3\t4 \n", 16),
        ("   " + SQUARE.replace("\n", "\n\t") + "f 1 2 3 4", 16),
        (SQUARE + "fo 1 2 3 4\n", 16),
        (SQUARE + "f 1 2 3 \\\n4\n", 16),
        (SQUARE + "f 1 2\\\r\n3\\\r\n4\r\n", 16),
        ("v 0 \\\n0 0\n" + SQUARE[8:] + "f 1 2 3 4\n", 16),
        ("# a folder C:\\levels\\\n" + SQUARE + "f 1 2 3 4\n", 16),
        (SQUARE + "bmat u 1 -3 3 \\\n 0 3 -6 \\\n 0 0 3\nf 1 2 3 4\n\0", 16),
        ("o room\\\n" + SQUARE + "usemtl floor\\\nf 1 2 3 4\n", 16),
        (SQUARE.replace("\n", "\r\n") + "f 1 2 3 4\r\n", 16),
        (SQUARE.replace("\n", "\r") + "f 1 2 3 4\r", 16),
        (("\ufeff" + SQUARE + "f 1 2 3 4\n").encode(), 16),
        (("\ufeff" + SQUARE + "f 1 2 3 4\n").encode("utf-16-le"), 16),
        ("o Fußboden\n".encode("latin-1") + (SQUARE + "f 1 2 3 4\n").encode(), 16),
        (SQUARE.replace("0\n", "0 0.5 0.5 0.5\n") + "f 1 2 3 4\n", 16),
        (SQUARE.replace("4 0 0\n", "4 0 0 1 0 0\n") + "f 1 2 3 4\n", 16),
        (SQUARE.replace("0\n", "0 1.0\n") + "f 1 2 3 4\n", 16),
        (SQUARE.replace("0\n", "0 # corner\n") + "f 1 2 3 4 # floor\n", 16),
        (SQUARE.replace("4", "4e+0") + "f 1 2 3 4\n", 16),
        ("f 1 2 3 4\n" + SQUARE, 16),
        (SQUARE + "vt 0 0\nvn 0 0 1\nvp 0.5\ng a b\ns off\nusemtl x\nf 1 2 3 4\nl 1 2 3\np 1\n", 16),
        (SQUARE + "f 1 2\nf 1\nf 1 2 3 4\n", 16),
        (SQUARE + "f 1 2 2 3 4\n", 16),
        (SQUARE + "f -4 -3 -2 -1\nv 4 0 0\nv 8 0 0\nv 8 4 0\nv 4 4 0\nf -4 -3 -2 -1\nf 1 -1 -2\n", 32 + 8),
    ],
)  # fmt: skip
def test_spellings(tmp_path, text, square_metres):
    terrain = load(tmp_path, text)
    assert area(terrain) == pytest.approx(square_metres)
    assert terrain.bounds[0].tolist() == [0, 0, 0]


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        (SQUARE + "f 0 1 2\n", 5, "vertex 0"),
        (SQUARE + "f 1 2 5\n", 5, "has 4 vertices"),
        (SQUARE + "f -1 -2 -5\n" + SQUARE, 5, "4 vertices before"),
        (SQUARE + "f 99999999999999999999 1 2\n", 5, "has 4 vertices"),
        (SQUARE + "g x\nf 1 2 three\n", 6, "numbers of vertices"),
        (SQUARE + "f 1 2 -\n", 5, "numbers of vertices"),
        (SQUARE + "f 1 2 3 - 4\n", 5, "numbers of vertices"),
        (SQUARE + "f 1.0 2 3\n", 5, "numbers of vertices"),
        (SQUARE + "f 1,2,3\n", 5, "numbers of vertices"),
        (SQUARE + "f 1 / 1 2 / 1 3 / 1\n", 5, "a blank before a slash"),
        ("v 0 0 0\nv 4 0\n" + SQUARE + "f 1 2 3\n", 2, "three numbers"),
        ("v 0 0 0\nv 4,5 0 1,5\n" + SQUARE + "f 1 2 3\n", 2, "three numbers"),
        ("v 0 0 0\nv 4 0 nan\n" + SQUARE + "f 3 4 5\n", 2, "not finite"),
        (SQUARE + "\nf 1 3 2 4\n", 6, "crosses itself"),
        (SQUARE + "cstype bspline\nsurf 0 1 0 1 1 2 3 4\n", 6, "free-form surface"),
        (SQUARE + "bzp 1 2 3 4\n", 5, "Bézier patch"),
        (SQUARE + "call other.obj\nf 1 2 3\n", 5, "another file"),
        (SQUARE + "f 1 2 3\n4\n", 6, "no statement"),
        (SQUARE + "f 1 2 \\\n 3 \\\n x\n", 5, "numbers of vertices"),
        (b"\x7fELF\x02\x01\x01\n" + SQUARE.encode(), 1, "no statement"),
    ],
)
def test_what_is_wrong_is_named_by_line(tmp_path, text, line, says):
    with pytest.raises(NavmeshError, match=rf"level\.obj: .*line {line}: .*{re.escape(says)}"):
        load(tmp_path, text)


def test_no_way_leads_over_a_yard_without_floor(tmp_path):
    corners = "v 0 0 0\nv 6 0 0\nv 6 6 0\nv 5 6 0\nv 5 1 0\nv 1 1 0\nv 1 6 0\nv 0 6 0\n"
    graph = NodeGraph.build(load(tmp_path, corners + "f 1 2 3 4 5 6 7 8\n"))
    route = graph.find_path((0.5, 5.5, 0), (5.5, 5.5, 0), radius=0.2)
    assert route.length > 12.0


def prisms(rng):
    """Random prisms of star-shaped, mostly concave plans: corners and outlines, with area and volume."""
    points, outlines = [], []
    surface = inside = 0.0
    for k in range(int(rng.integers(1, 6))):
        count = int(rng.integers(3, 12))
        angle = (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count * 2.0 * np.pi
        ring = rng.uniform(0.3, 2.0, (count, 1)) * np.c_[np.cos(angle), np.sin(angle)]
        x, y = ring.T
        base = float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2.0)
        height = float(rng.uniform(0.2, 3.0))
        if base <= 0.0:
            continue
        first = len(points)
        for z in (0.0, height):
            points += [(px + 5.0 * k, py, z) for px, py in ring]
        low, high = np.arange(count) + first, np.arange(count) + first + count
        outlines += [low[::-1].tolist(), high.tolist()]
        outlines += [[low[i], low[(i + 1) % count], high[(i + 1) % count], high[i]] for i in range(count)]
        girth = np.linalg.norm(ring - np.roll(ring, -1, axis=0), axis=1).sum()
        surface += 2.0 * base + girth * height
        inside += base * height
    return np.array(points), outlines, surface, inside


def spelled(rng, points, outlines):
    """An OBJ file of polygons, in a spelling drawn at random: blocks, relative and absolute numbers, more."""
    end = rng.choice(["\n", "\r\n"])
    lines = ["# level", "mtllib none.mtl"]
    number: dict[int, int] = {}
    colours, behind = rng.random() < 0.3, rng.choice(["", "/1", "//1", "/1/1"])
    for outline in outlines:
        if rng.random() < 0.2:
            lines.append(
                str(rng.choice(["g part", "usemtl stone", "s 1", "o thing", "vt 0 0", "vn 0 0 1", ""]))
            )
        for corner in outline:
            if corner not in number or rng.random() < 0.1:  # some corners are written again
                number[corner] = count_of(lines) + 1
                x, y, z = points[corner]
                lines.append(f"v {x:.12g} {y:.12g} {z:.12g}" + (" 0.1 0.2 0.3" if colours else ""))
        turned = np.roll(outline, int(rng.integers(len(outline)))).tolist()
        relative, total = rng.random() < 0.5, count_of(lines)
        names = [f"{number[c] - total - 1 if relative else number[c]}{behind}" for c in turned]
        cut = " \\" + end if rng.random() < 0.2 else " "
        lines.append("f " + " ".join(names[:2]) + cut + " ".join(names[2:]))
    return end.join(lines) + end


def count_of(lines):
    return sum(line.startswith("v ") for line in lines)


@pytest.mark.parametrize("seed", range(40))
def test_random_polygons_in_random_spellings(tmp_path, seed):
    rng = np.random.default_rng(seed)
    points, outlines, surface, inside = prisms(rng)
    if not len(points):
        return
    terrain = load(tmp_path, spelled(rng, points, outlines))
    assert area(terrain) == pytest.approx(surface, rel=1e-9)
    assert volume(terrain) == pytest.approx(inside, rel=1e-9)
    assert upward_area(terrain) == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(terrain.bounds, [points.min(axis=0), points.max(axis=0)], atol=1e-9)


def test_triangles_come_in_the_file_s_order(tmp_path):
    text = SQUARE + "v 9 9 9\nf 2 3 4\nf 1 2 3 4\ng last\nf 1 2 4\n"
    terrain = load(tmp_path, text)
    assert terrain.faces.tolist() == [[1, 2, 3], [0, 1, 2], [0, 2, 3], [0, 1, 3]]
    assert len(terrain.vertices) == 4  # the fifth is no triangle's
