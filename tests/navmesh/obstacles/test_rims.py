"""Rims: the edges of a mesh at which a floor ends with a fall beyond it."""

import math

import numpy as np

from benchmarks.obstacle_scenes import box, merged, plate, turned
from navmesh.obstacles.rims import Rims, find_rims

SLOPE = math.radians(45)


def _slow_rims(vertices: np.ndarray, faces: np.ndarray, max_slope: float) -> set[tuple]:
    """Rims of a mesh whose vertices are welded already, by looking at every pair of edge and face."""
    found = set()
    normals = {}
    for f in faces.tolist():
        a, b, c = vertices[f]
        normal = np.cross(b - a, c - a)
        normals[tuple(f)] = normal / np.linalg.norm(normal)
    for i, j in {(p, q) for f in faces.tolist() for p, q in zip(f, f[1:] + f[:1], strict=True)}:
        start, end = vertices[i], vertices[j]
        along = end - start
        length = math.hypot(along[0], along[1])
        if length < 0.02 or abs(along[2]) > math.tan(math.radians(20)) * length:
            continue
        left = right = rises = hangs = 0
        for f, normal in normals.items():
            if i not in f or j not in f:
                continue
            third = vertices[next(k for k in f if k not in (i, j))] - start
            side = along[0] * third[1] - along[1] * third[0]
            if normal[2] >= math.cos(max_slope) - 1e-9:
                left, right = left + (side > 0), right + (side <= 0)
            elif normal[2] > -math.cos(max_slope):
                part = np.clip((third[:2] @ along[:2]) / length**2, 0, 1)
                rise = third[2] - part * along[2]
                rises, hangs = rises + (rise > 1e-4), hangs + (rise < -1e-4)
        if not rises and ((left and not right) or (not left and not right and hangs)):
            found.add((*start.round(6), *end.round(6)))
        if not rises and ((right and not left) or (not left and not right and hangs)):
            found.add((*end.round(6), *start.round(6)))
    return found


def _as_set(rims: Rims) -> set[tuple]:
    return {(*a.round(6), *b.round(6)) for a, b in zip(rims.start, rims.end, strict=True)}


def test_rims_agree_with_the_slow_reference_on_a_heap_of_triangles() -> None:
    for seed in range(6):
        rng = np.random.default_rng(seed)
        vertices = rng.uniform(0, 3, (25, 3)) * (1, 1, 0.3)
        faces = np.array([rng.choice(25, 3, replace=False) for _ in range(40)], np.int32)
        assert _as_set(find_rims(vertices, faces, SLOPE)) == _slow_rims(vertices, faces, SLOPE)


def test_a_box_on_a_floor_has_four_rims_on_top_that_look_outward() -> None:
    vertices, faces = merged(plate(20, 20), box(3, 2, -0.2, 0.5))
    rims = find_rims(turned(vertices, 0.4, np.zeros(3)), faces, SLOPE)
    top = np.isclose(rims.start[:, 2], 0.5)
    assert top.sum() == 4
    middle = (rims.start + rims.end)[top, :2] / 2
    assert np.all((middle * rims.outward[top]).sum(axis=1) > 0.9)
    along = (rims.end - rims.start)[top]
    assert np.all(along[:, 0] * rims.outward[top, 1] - along[:, 1] * rims.outward[top, 0] < 0)


def test_split_edges_and_double_faces_are_one_rim_each() -> None:
    vertices, faces = plate(4, 4, 1.0)
    doubled = find_rims(*merged((vertices, faces), (vertices, faces)), SLOPE)
    assert len(doubled) == 4


def test_a_fence_without_thickness_is_a_ridge_seen_from_both_sides() -> None:
    vertices = np.array([(0.0, 0, 0), (4, 0, 0), (4, 0, 0.8), (0, 0, 0.8)])
    rims = find_rims(vertices, np.array([(0, 1, 2), (0, 2, 3)]), SLOPE)
    assert sorted(rims.outward[:, 1].round(6).tolist()) == [-1.0, 1.0]


def test_the_foot_of_a_wall_and_a_crease_between_floors_are_no_rims() -> None:
    wall = np.array([(0.0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (0, 3, 2.0), (4, 3, 2.0)])
    rims = find_rims(wall, np.array([(0, 1, 2), (0, 2, 3), (3, 2, 5), (3, 5, 4)]), SLOPE)
    ends = np.stack((rims.start, rims.end))
    assert not np.any(np.all(np.isclose(ends[:, :, 1], 3) & np.isclose(ends[:, :, 2], 0), axis=0))
    roof = np.array([(0.0, 0, 0), (4, 0, 0), (4, 2, 0.5), (0, 2, 0.5), (4, 4, 0), (0, 4, 0)])
    rims = find_rims(roof, np.array([(0, 1, 2), (0, 2, 3), (3, 2, 4), (3, 4, 5)]), SLOPE)
    assert not np.any(np.isclose(rims.start[:, 2], 0.5) & np.isclose(rims.end[:, 2], 0.5))


def test_an_empty_result_has_the_shapes_of_a_full_one() -> None:
    rims = find_rims(np.zeros((3, 3)), np.array([(0, 1, 2)]), SLOPE)
    assert rims.start.shape == (0, 3) and rims.outward.shape == (0, 2) and len(rims) == 0
