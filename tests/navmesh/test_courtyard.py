"""The level of our own: made by its script, one conforming skin, and as its description says."""

import runpy
from pathlib import Path

import numpy as np
import trimesh

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_the_committed_level_is_what_the_script_makes(tmp_path: Path) -> None:
    runpy.run_path(str(EXAMPLES / "make_levels.py"))["main"](tmp_path)
    made = (tmp_path / "courtyard.obj").read_bytes()
    assert made == (EXAMPLES / "levels" / "courtyard.obj").read_bytes()
    assert len(made) < 300_000


def test_the_skin_is_closed_but_for_its_foot_and_faces_outward() -> None:
    mesh = trimesh.load_mesh(EXAMPLES / "levels" / "courtyard.obj", process=False)
    edges, uses = np.unique(np.sort(mesh.edges, axis=1), axis=0, return_counts=True)
    assert uses.max() == 2
    assert np.all(np.abs(mesh.vertices[edges[uses == 1]][:, :, 2]) < 1e-9)
    assert mesh.is_winding_consistent
    assert mesh.area_faces.min() > 1e-6
    up = mesh.face_normals[:, 2] > 0.5
    flat = np.abs(mesh.triangles_cross[up, 2]).sum() / 2
    hung = np.abs(mesh.triangles_cross[mesh.face_normals[:, 2] < -0.5, 2]).sum() / 2
    assert abs(flat - hung - 60 * 40) < 1e-6
