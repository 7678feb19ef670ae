"""What was measured along rims, and measured anew only where a level has changed."""

import numpy as np
import pytest

import navmesh
from navmesh.level.mesh_queries import MeshGrid
from navmesh.obstacles.rim_measuring import DROP, GAP, JUMP, VAULT
from navmesh.obstacles.rim_samples import renew_rim_samples, take_rim_samples
from navmesh.surface.build import build_surface
from tests.navmesh.shapes import box, plane, terrain

RULES, OBSTACLES = navmesh.WalkRules(), navmesh.ObstacleRules()


def measured(*meshes):
    """(samples, terrain, surface, grid) of a level."""
    level = terrain(*meshes)
    surface = build_surface(level, RULES)
    grid = MeshGrid(level.vertices, level.faces, surface.origin, RULES.max_slope)
    return take_rim_samples(level, surface, RULES, OBSTACLES, grid), level, surface, grid


FLOOR = plane(0, 12, 0, 8)


@pytest.mark.parametrize(
    ("meshes", "slot", "code", "size", "at"),
    [
        ((FLOOR, box(6, 12, 0, 8, 0, 0.5)), 0, JUMP, 0.5, 0),
        ((FLOOR, box(6, 6.4, 0, 8, 0, 0.8)), 0, VAULT, 0.4, 1),
        ((FLOOR, box(6, 12, 0, 8, 0, 1.5)), 1, DROP, 1.5, 0),
        ((plane(0, 5, 0, 8), plane(6, 12, 0, 8)), 2, GAP, 1.0, 1),
    ],
    ids=["jump", "vault", "drop", "gap"],
)
def test_what_is_there_is_measured_all_along_the_edge(meshes, slot, code, size, at):
    """``at``: whether its height (0) or its depth (1) counts."""
    found = measured(*meshes)[0]
    of_kind = found.kind[:, slot] == code
    assert of_kind.sum() >= 20  # 8 m, every 0.2 m, but for the ends
    assert found.size[of_kind, slot, at] == pytest.approx(size, abs=0.02)
    run_up, landing = found.size[of_kind, slot, 2], found.size[of_kind, slot, 3]
    assert (run_up >= OBSTACLES.run_up - 0.1).all() and (landing >= OBSTACLES.landing - 0.1).all()


def test_samples_belong_to_their_rims_and_are_no_farther_apart_than_said():
    found = measured(FLOOR, box(6, 12, 0, 8, 0, 0.5))[0]
    lengths = np.linalg.norm(found.rims.end - found.rims.start, axis=1)
    counts = np.diff(found.first)
    assert (counts >= 1).all() and (lengths <= 0.2 * counts + 1e-9).all()
    assert (np.diff(found.sample) > 0).all() and found.sample.max() < found.first[-1]
    assert (found.kind != 0).any(axis=1).all()  # nothing is kept of places where nothing is


def test_an_update_gives_what_measuring_all_gives():
    before = measured(FLOOR, box(6, 12, 0, 8, 0, 0.5))[0]
    after, level, surface, grid = measured(FLOOR, box(6, 12, 0, 8, 0, 0.6))
    changed = np.array([[[6.0, 0.0], [12.0, 8.0]]]) - surface.origin[:2]
    renewed = renew_rim_samples(before, changed, level, surface, RULES, OBSTACLES, grid)
    for name in ("first", "sample", "kind", "size"):
        np.testing.assert_array_equal(getattr(renewed, name), getattr(after, name), name)
