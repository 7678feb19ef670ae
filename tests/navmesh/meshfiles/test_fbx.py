"""FBX: units and axes of the file, transforms, what is hidden; and what helps where ufbx is missing."""

import importlib.util
import re

import numpy as np
import pytest

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.fbx_files import fbx, vector
from tests.navmesh.meshfiles.mesh_measures import area, upward_area

FLOOR = [[0, 0, 0], [4, 4, 0]]
READ = importlib.util.find_spec("ufbx") is not None
needs_ufbx = pytest.mark.skipif(not READ, reason="needs the extra meshes")


def load(tmp_path, text, **options):
    file = tmp_path / "level.fbx"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return Terrain.load(file, **options)


@needs_ufbx
@pytest.mark.parametrize(
    ("options", "bounds"),
    [
        ({}, FLOOR),
        ({"unit": 100.0}, [[0, 0, 0], [400, 400, 0]]),
        ({"unit": 2.54}, [[0, 0, 0], [10.16, 10.16, 0]]),
        ({"axes": (2, 1, 1, -1, 0, 1), "points": (0, 0, 0, 400, 0, 0, 400, 400, 0, 0, 400, 0)}, FLOOR),
        ({"axes": (0, 1, 2, -1, 1, 1), "points": (0, 0, 0, 0, 400, 0, 0, 400, 400, 0, 0, 400)}, FLOOR),
        ({"axes": (2, 1, 1, 1, 0, -1), "points": (0, 0, 0, -400, 0, 0, -400, -400, 0, 0, -400, 0)}, FLOOR),
    ],
)
def test_axes_and_units_are_the_file_s(tmp_path, options, bounds):
    terrain = load(tmp_path, fbx(**options))
    np.testing.assert_allclose(terrain.bounds, bounds, atol=1e-9)
    assert upward_area(terrain) == pytest.approx(area(terrain))


@needs_ufbx
def test_the_caller_may_know_better(tmp_path):
    np.testing.assert_allclose(load(tmp_path, fbx(), up="z", scale=0.1).bounds, [[0, 0, -40], [40, 0, 0]])


@needs_ufbx
def test_transforms(tmp_path):
    model = vector("Lcl Scaling", -2, 1, 1) + vector("Lcl Translation", 100, 0, 0)
    model += 'P: "GeometricTranslation", "Vector3D", "Vector", "",0,50,0'
    terrain = load(tmp_path, fbx(model=model))
    np.testing.assert_allclose(terrain.bounds, [[-7, 0, 0.5], [1, 4, 0.5]], atol=1e-9)
    assert upward_area(terrain) == pytest.approx(32)  # mirrored, and still a floor


@needs_ufbx
def test_concave_polygons(tmp_path):
    points = (400, 0, 0, 400, 0, -100, 100, 0, -100, 100, 0, -400, 0, 0, -400, 0, 0, 0)
    assert upward_area(load(tmp_path, fbx(points, (0, 1, 2, 3, 4, -6)))) == pytest.approx(7)


def more_models(*numbers, kind='"Mesh"'):
    """Models with the same mesh, the k-th 10 m farther to the right; without connections."""
    return "\n".join(
        f'Model: {n}, "Model::more{n}", {kind} {{\nVersion: 232\nProperties70: {{\n'
        f"{vector('Lcl Translation', 1000 * (k + 1), 0, 0)}}}\n}}"
        for k, n in enumerate(numbers)
    )


@needs_ufbx
def test_instances_and_what_is_hidden(tmp_path):
    joined = 'C: "OO",2001,0\nC: "OO",1000,2001\nC: "OO",2002,2001\nC: "OO",1000,2002\n'
    terrain = load(tmp_path, fbx(objects=more_models(2001, 2002), connections=joined))
    assert area(terrain) == pytest.approx(48)
    assert terrain.bounds[1, 0] == pytest.approx(34)  # the third stands in the second
    hidden = 'P: "Visibility", "Visibility", "", "A",0'
    joined = 'C: "OO",2001,2000\nC: "OO",1000,2001\n'
    with pytest.raises(NavmeshError, match="no triangles"):
        load(tmp_path, fbx(model=hidden, objects=more_models(2001), connections=joined))


@needs_ufbx
def test_levels_of_detail(tmp_path):
    group = 'NodeAttribute: 3000, "NodeAttribute::group", "LodGroup" {\n}\n'
    group += 'Model: 3001, "Model::group", "LodGroup" {\nVersion: 232\n}\n' + more_models(2001, 2002)
    joined = 'C: "OO",3001,0\nC: "OO",3000,3001\n'
    joined += "".join(f'C: "OO",{n},3001\nC: "OO",1000,{n}\n' for n in (2001, 2002))
    terrain = load(tmp_path, fbx(objects=group, connections=joined))
    assert area(terrain) == pytest.approx(32)  # the floor, and the finest of the group
    assert terrain.bounds[1, 0] == pytest.approx(14)


@needs_ufbx
@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "Empty"),
        ("x" * 300, "FBX"),
        (b"Kaydara FBX Binary  \x00\x1a\x00" + b"\xe8\x1c\0\0" + b"\xff" * 40, "ufbx"),
        (fbx()[: fbx().index("GeometryVersion")], "cut off: 2 blocks are not closed"),
        (fbx(polygons=(0, 1, 9, -4)), "ufbx|names vertex 9"),
        (fbx(polygons=(0, 2, 1, -4)), "mesh 'floor', polygon 0: the outline of the polygon crosses itself"),
        (fbx(unit=0.0), "scale|unit|no triangles|beyond"),
    ],
)
def test_what_is_wrong(tmp_path, text, says):
    with pytest.raises(NavmeshError, match=rf"level\.fbx: .*({says})"):
        load(tmp_path, text)


def test_without_ufbx(tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(
        NavmeshError, match=re.escape("pip install -e '.[meshes]'") + ".*export the level as glTF"
    ):
        load(tmp_path, fbx())
