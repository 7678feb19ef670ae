"""OFF: polygons, with or without colours, normals and comments."""

import re

import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.mesh_measures import area, upward_area
from tests.navmesh.meshfiles.small_files import L_SHAPE, load, off


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
def test_spellings(tmp_path, text):
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
def test_what_is_wrong(tmp_path, text, says):
    with pytest.raises(NavmeshError, match=rf"level\.off: .*{re.escape(says)}"):
        load(tmp_path, "level.off", text)
