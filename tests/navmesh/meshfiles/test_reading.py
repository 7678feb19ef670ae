"""Which reader a file is read with."""

import re

import numpy as np
import pytest
import trimesh

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.mesh_measures import area, volume
from tests.navmesh.meshfiles.small_files import load


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
