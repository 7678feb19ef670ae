"""Affordances from geometry alone: found where they are, with an exact frame, and nowhere else."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import navmesh
from benchmarks.affordances import compare
from benchmarks.obstacle_scenes import Mesh, box, merged, plate, random_scene, turned
from navmesh.obstacles.detection import detect_obstacles
from navmesh.obstacles.obstacles import Obstacles
from navmesh.surface.build import build_surface

COURTYARD = Path(__file__).resolve().parents[3] / "examples" / "levels" / "courtyard.obj"
RULES = navmesh.WalkRules()


def find(mesh: Mesh | navmesh.Terrain, rules: navmesh.WalkRules = RULES, **obstacle_rules) -> Obstacles:
    terrain = mesh if isinstance(mesh, navmesh.Terrain) else navmesh.Terrain.from_arrays(*mesh)
    return detect_obstacles(
        terrain, build_surface(terrain, rules), rules, navmesh.ObstacleRules(**obstacle_rules)
    )


@pytest.mark.parametrize("kind", ["jump", "vault", "drop", "gap", "none"])
@settings(max_examples=25, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1))
def test_finds_what_is_there_and_nothing_else(kind: str, seed: int) -> None:
    scene = random_scene(kind, np.random.default_rng(seed))
    errors = compare(scene, find(scene.terrain))
    assert errors["missed"] == [0] and errors["false"] == [0], scene.what
    assert max(errors["edge"], default=0.0) <= 0.02, scene.what
    assert max(errors["middle"], default=0.0) <= 0.15, scene.what
    assert max(errors["normal"], default=0.0) <= 0.5, scene.what
    assert max(errors["height"], default=0.0) <= 0.01, scene.what
    assert max(errors["depth"], default=0.0) <= 0.01, scene.what


@settings(max_examples=10, deadline=None, derandomize=True)
@given(seed=st.integers(0, 2**32 - 1))
def test_the_order_of_triangles_and_vertices_does_not_show(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = random_scene(("jump", "vault", "drop", "gap")[seed % 4], rng)
    terrain = scene.terrain
    renamed = rng.permutation(len(terrain.vertices))
    vertices = np.empty_like(terrain.vertices)
    vertices[renamed] = terrain.vertices
    faces = renamed[terrain.faces][rng.permutation(len(terrain.faces))]
    faces = np.array([np.roll(face, rng.integers(3)) for face in faces])
    one, other = find(terrain), find((vertices, faces))
    for name, array in one.arrays().items():
        if array.dtype.kind in "Ub":
            assert np.array_equal(array, getattr(other, name)), name
        else:
            assert np.allclose(array, getattr(other, name), atol=1e-9, rtol=0), name


def test_turning_the_level_turns_the_frames() -> None:
    mesh = merged(plate(26, 26), box(4, 3, -0.2, 0.5))
    still = find(mesh)
    yaw, by = 0.7, np.array([12.0, -7.0, 3.0])
    moved = find((turned(mesh[0], yaw, by), mesh[1]))
    assert len(still) == len(moved) == 4
    for k in range(4):
        there, distance = moved.near(turned(still.position[k], yaw, by))
        assert distance < 0.11
        assert np.allclose(moved.normal[there], turned(still.normal[k], yaw, np.zeros(3)), atol=1e-9)
        assert moved.height[there] == still.height[k]


def test_what_a_step_clears_is_no_obstacle() -> None:
    mesh = merged(plate(26, 26), box(4, 3, -0.2, 0.5))
    assert len(find(mesh)) == 4
    assert len(find(mesh, navmesh.WalkRules(max_step=0.55))) == 0


def test_nothing_is_tagged_without_landing_room() -> None:
    shelf = merged(plate(26, 26), box(0.6, 6, -0.2, 0.5))
    found = find(shelf)
    assert not np.any((found.affordance == "jump") & (np.abs(found.normal[:, 0]) > 0.9))
    blocked = merged(plate(26, 26), box(0.3, 5, -0.2, 0.8), box(0.3, 5, -0.2, 3.0, (0.8, 0.0)))
    assert len(find(blocked)) == 0
    pit = merged(plate(26, 26), box(6, 6, -0.2, 1.5), box(0.3, 20, -0.2, 4, (3.6, 0)))
    found = find(pit)
    assert not np.any(found.normal[:, 0] < -0.9) and len(found) == 3


def test_nothing_is_tagged_through_a_parapet() -> None:
    terrace = merged(plate(26, 26), box(6, 6, -0.2, 1.2), box(0.1, 6, 1.2, 2.0, (2.95, 0.0)))
    found = find(terrace)
    assert set(found.affordance) == {"drop"} and len(found) == 3


def test_nothing_is_tagged_under_a_beam_across_the_way() -> None:
    mesh = merged(plate(26, 26), box(6, 6, -0.2, 0.5), box(0.1, 20, 1.2, 1.6, (3.15, 0.0)))
    assert not np.any(find(mesh).normal[:, 0] > 0.9)


def test_a_ditch_that_one_can_walk_through_is_no_gap() -> None:
    banks = [box(6, 6, -1, 0.0, (side * 4.0, 0.0)) for side in (-1, 1)]
    assert len(find(merged(*banks, box(2, 6, -1, -0.15)))) == 0
    deep = find(merged(*banks, box(2, 6, -3, -2.5)))
    assert sorted(deep.affordance) == ["gap", "gap"]


def test_a_wide_edge_is_one_obstacle_even_when_its_mesh_is_cut_to_pieces() -> None:
    steps = np.linspace(-3, 3, 14)
    top = np.array([(x, y, 0.5) for x in (0.0, 4.0) for y in steps])
    foot = np.array([(0.0, y, 0.0) for y in steps[::3]])
    faces = []
    for i in range(13):
        faces += [(i, 14 + i, 15 + i), (i, 15 + i, i + 1)]
    for i in range(len(foot) - 1):  # the wall's triangles meet the rim at other points than the floor's
        a, b = 3 * i, min(3 * i + 3, 13)
        faces += [(28 + i, a, b), (28 + i, b, 29 + i)]
    mesh = merged(plate(26, 26), (np.concatenate((top, foot)), np.array(faces)))
    found = find(mesh)
    front = found.select(found.normal[:, 0] < -0.9)
    assert len(front) == 1
    assert front.width[0] == pytest.approx(6.0, abs=0.5)
    assert np.allclose(front.position[0, [0, 2]], (0.0, 0.5), atol=1e-9)


def test_a_round_platform_is_cut_into_straight_pieces_on_its_rim() -> None:
    angles = np.linspace(0, 2 * np.pi, 49)[:-1]
    ring = np.column_stack((3 * np.cos(angles), 3 * np.sin(angles)))
    rows = [np.column_stack((ring, np.full(48, z))) for z in (0.0, 0.4)]
    vertices = np.concatenate((*rows, [(0.0, 0.0, 0.4)]))
    faces = []
    for i in range(48):
        j = (i + 1) % 48
        faces += [(i, j, 48 + j), (i, 48 + j, 48 + i), (48 + i, 48 + j, 96)]
    found = find(merged(plate(26, 26), (vertices, np.array(faces))))
    assert len(found) >= 12 and set(found.affordance) == {"jump"}
    radius = np.hypot(found.position[:, 0], found.position[:, 1])
    assert np.all((radius <= 3.0 + 1e-9) & (radius >= 3.0 * np.cos(np.pi / 48) - 1e-9))
    cosine = (found.position[:, :2] * found.normal[:, :2]).sum(axis=1) / radius
    assert np.all(cosine > np.cos(np.radians(4)))


def test_the_floor_before_may_slope_and_height_is_measured_at_the_edge() -> None:
    slope = np.array([(-10.0, -8, -1.0), (10, -8, 1.0), (10, 8, 1.0), (-10, 8, -1.0)])
    mesh = merged((slope, np.array([(0, 1, 2), (0, 2, 3)])), box(3, 4, -1.0, 0.6))
    found = find(mesh)
    for k in range(len(found)):
        x, _, z = found.position[k]
        assert found.height[k] == pytest.approx(z - 0.1 * x, abs=0.01)
    uphill = found.normal[:, 0] > 0.9
    assert uphill.sum() == 1 and found.height[uphill][0] == pytest.approx(0.45, abs=0.01)


def test_the_courtyard_has_its_platforms_vaults_drop_and_gaps() -> None:
    found = find(navmesh.Terrain.load(COURTYARD))
    for at, height, towards in (
        ((25, 3.4, 0.3), 0.3, 1.0),
        ((34, 9.6, 0.7), 0.4, -1.0),
        ((30, 15.8, 1.2), 0.5, 1.0),
    ):
        k, distance = found.near(np.array(at), "jump")
        assert distance < 0.02
        assert found.height[k] == pytest.approx(height, abs=1e-3)
        assert np.allclose(found.normal[k], (-towards, 0, 0), atol=1e-9)
        assert found.run_up[k] >= 20 and found.landing[k] >= 12 and found.width[k] >= 5.5
    for at, affordance in (
        ((36, 27, 0.8), "vault"),
        ((48.5, 30, 0.9), "vault"),
        ((52, 19.2, 1.2), "drop"),
        ((42, 27, 0), "gap"),
        ((20, 37.8, 3), "gap"),
    ):
        assert found.near(np.array(at), affordance)[1] < 0.25
