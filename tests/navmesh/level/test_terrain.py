"""Reading meshes: axes, units, scenes, and every kind of wrong input."""

import math
import tracemalloc

import numpy as np
import pytest
import trimesh
from PIL import Image
from trimesh.visual import TextureVisuals

from navmesh import NavmeshError, NodeGraph, Terrain

FLOOR = (np.array([[0.0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))


@pytest.mark.parametrize("suffix", ["obj", "ply", "stl", "off", "glb"])
def test_reads_mesh_files(tmp_path, suffix):
    file = tmp_path / f"level.{suffix}"
    trimesh.Trimesh(*FLOOR, process=False).export(file)
    terrain = Terrain.load(file, up="z")
    assert len(terrain.faces) == 2
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 0], [4, 4, 0]], atol=1e-6)


def test_scene_is_flattened_with_its_transforms(tmp_path):
    scene = trimesh.Scene()
    mesh = trimesh.Trimesh(*FLOOR, process=False)
    scene.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([0, 0, 0]))
    scene.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([10, 0, 2]))
    scene.export(tmp_path / "scene.glb")
    terrain = Terrain.load(tmp_path / "scene.glb", up="z")
    assert len(terrain.faces) == 4
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 0], [14, 4, 2]], atol=1e-6)


def test_textures_are_left_alone(tmp_path):
    scene = trimesh.Scene()
    for k in range(3):
        mesh = trimesh.Trimesh(*FLOOR, process=False)
        mesh.visual = TextureVisuals(FLOOR[0][:, :2], image=Image.new("RGB", (1024, 1024), (k, 0, 0)))
        scene.add_geometry(mesh, transform=trimesh.transformations.translation_matrix([10 * k, 0, 0]))
    scene.export(tmp_path / "scene.glb")
    tracemalloc.start()
    try:
        assert len(Terrain.load(tmp_path / "scene.glb").faces) == 6
        assert tracemalloc.get_traced_memory()[1] < 4e6  # packed together they are 12 MB and more
    finally:
        tracemalloc.stop()


def test_axes_and_scale():
    point = [[1.0, 2.0, 3.0], [2, 2, 3], [1, 2, 4]]
    faces = [[0, 1, 2]]
    assert Terrain.from_arrays(point, faces).vertices[0].tolist() == [1, 2, 3]
    assert Terrain.from_arrays(point, faces, up="y").vertices[0].tolist() == [1, -3, 2]
    assert Terrain.from_arrays(point, faces, up="x").vertices[0].tolist() == [2, 3, 1]
    assert Terrain.from_arrays(point, faces, scale=0.01).vertices[0].tolist() == [0.01, 0.02, 0.03]


def test_digest_names_the_geometry():
    first = Terrain.from_arrays(*FLOOR)
    assert first.digest == Terrain.from_arrays(*FLOOR, name="other").digest
    assert first.digest != Terrain.from_arrays(FLOOR[0] + 1e-9, FLOOR[1]).digest


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("missing.obj", None, "no such file"),
        ("text.md", b"# not a mesh\n", "cannot be read as a mesh"),
        ("broken.glb", b"glTFxxx", "cannot be read as a mesh"),
        ("empty.obj", b"", "no triangles"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n", "no triangles"),
        ("nan.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("inf.obj", b"v inf 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
    ],
)
def test_bad_file_is_refused_by_name(tmp_path, name, content, says):
    file = tmp_path / name
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(NavmeshError, match=says) as caught:
        Terrain.load(file)
    assert name in str(caught.value)


@pytest.mark.parametrize(
    ("vertices", "faces", "options", "says"),
    [
        (FLOOR[0], np.empty((0, 3), int), {}, "no triangles"),
        (FLOOR[0][:, :2], FLOOR[1], {}, "shape"),
        (FLOOR[0], FLOOR[1][:, :2], {}, "faces"),
        (FLOOR[0], FLOOR[1].astype(float), {}, "integers"),
        (FLOOR[0], [[0, 1, 9]], {}, "names vertices"),
        (FLOOR[0], [[0, 1, -1]], {}, "names vertices"),
        ("nonsense", FLOOR[1], {}, "numbers"),
        (FLOOR[0], FLOOR[1], {"up": "w"}, "up ="),
        (FLOOR[0], FLOOR[1], {"scale": 0}, "scale"),
        (FLOOR[0], FLOOR[1], {"scale": math.nan}, "scale"),
        (FLOOR[0] * 1e12, FLOOR[1], {}, "beyond"),
    ],
)
def test_bad_arrays_are_refused(vertices, faces, options, says):
    with pytest.raises(NavmeshError, match=says):
        Terrain.from_arrays(vertices, faces, **options)


def test_nothing_to_walk_on_is_an_error():
    ceiling = Terrain.from_arrays(FLOOR[0], FLOOR[1][:, ::-1])
    with pytest.raises(NavmeshError, match="nothing to walk on"):
        NodeGraph.build(ceiling)
    wall = Terrain.from_arrays(FLOOR[0][:, [0, 2, 1]], FLOOR[1])
    with pytest.raises(NavmeshError, match="nothing to walk on"):
        NodeGraph.build(wall)


def test_too_many_columns_is_an_error():
    with pytest.raises(NavmeshError, match="columns"):
        NodeGraph.build(Terrain.from_arrays(FLOOR[0] * 1e6, FLOOR[1]))
