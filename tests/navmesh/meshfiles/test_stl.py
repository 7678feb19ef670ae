"""STL: text and binary, and what begins like the other."""

import struct

import numpy as np
import pytest

from navmesh import NavmeshError
from tests.navmesh.meshfiles.mesh_measures import area, upward_area
from tests.navmesh.meshfiles.small_files import SQUARE, TWO, binary_stl, load, stl


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
def test_spellings(tmp_path, content):
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
def test_what_is_wrong(tmp_path, content, says):
    with pytest.raises(NavmeshError, match=rf"level\.stl: .*({says})"):
        load(tmp_path, "level.stl", content)
