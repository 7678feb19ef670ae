"""Rim samples: what was measured at points along every rim of a mesh, kept so that after a change only the
rims near it are measured anew."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from navmesh.level.mesh_queries import MeshGrid
from navmesh.level.terrain import Terrain
from navmesh.level.welding import WELD
from navmesh.obstacles.free_length import cells_of
from navmesh.obstacles.rim_measuring import Limits, measure
from navmesh.obstacles.rims import Rims, find_rims, order_of
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.surface.build import reach_of
from navmesh.surface.surface import Surface
from navmesh.threads import in_threads, shares
from surefoot.kernels import allocating_kernel

__all__ = ["RimSamples", "renew_rim_samples", "take_rim_samples"]

_SPACING = 0.2  # [m] distance between samples along a rim


@dataclass(frozen=True, slots=True, eq=False)
class RimSamples:
    """Rims (relative to the surface's origin) and what lies at samples along them."""

    rims: Rims
    first: np.ndarray
    """(n + 1,) int64: the samples of rim i are first[i]:first[i + 1], at the middles of as many equal
    parts."""
    sample: np.ndarray
    """(s,) int64: samples at which there is something, rising."""
    kind: np.ndarray
    """(s, 3) int8: see `navmesh.obstacles.rim_measuring.measure`."""
    size: np.ndarray
    """(s, 3, 5) float64."""


def take_rim_samples(
    terrain: Terrain,
    surface: Surface,
    walking: WalkRules,
    rules: ObstacleRules,
    grid: MeshGrid,
    threads: int = 1,
) -> RimSamples:
    """Find all rims of ``terrain`` and measure at them. ``grid`` are its triangles from the surface's
    origin."""
    rims = find_rims(terrain.vertices - surface.origin, terrain.faces, walking.max_slope)
    first = _first_samples(rims)
    return RimSamples(rims, first, *_measured(rims, first, grid, surface, walking, rules, threads))


def renew_rim_samples(
    old: RimSamples,
    changed: np.ndarray,
    terrain: Terrain,
    surface: Surface,
    walking: WalkRules,
    rules: ObstacleRules,
    grid: MeshGrid,
) -> RimSamples:
    """What `take_rim_samples` gives, after triangles have changed within the rectangles ``changed`` (k, 2, 2)
    [m] (least and greatest x and y, from the surface's origin); ``old`` is from before."""
    vertices = terrain.vertices - surface.origin
    wide = changed + np.array([[-4.0 * WELD], [4.0 * WELD]])
    faces = terrain.faces[_touched(vertices, terrain.faces, wide)]
    used, corners = np.unique(faces, return_inverse=True)
    found = find_rims(vertices[used], corners.reshape(-1, 3).astype(np.int32), walking.max_slope)
    near = changed + np.array([[-2.0 * WELD], [2.0 * WELD]])
    kept, fresh = np.flatnonzero(~_touching(old.rims, near)), np.flatnonzero(_touching(found, near))
    start = np.concatenate([old.rims.start[kept], found.start[fresh]])
    end = np.concatenate([old.rims.end[kept], found.end[fresh]])
    outward = np.concatenate([old.rims.outward[kept], found.outward[fresh]])
    order = order_of(start, end)
    rims = Rims(start[order], end[order], outward[order])
    first = _first_samples(rims)
    beyond = _reach(walking, rules)
    again = (order >= len(kept)) | _touching(rims, changed + np.array([[-beyond], [beyond]]))
    # what was found before keeps its place along its rim
    same = np.flatnonzero(~again)
    to = np.full(len(old.rims), -1)
    to[kept[order[same]]] = first[same]
    rim = np.searchsorted(old.first, old.sample, side="right") - 1
    stay = to[rim] >= 0
    moved = (old.sample - old.first[rim] + to[rim])[stay]
    part = Rims(rims.start[again], rims.end[again], rims.outward[again])
    parts = _first_samples(part)
    sample, kind, size = _measured(part, parts, grid, surface, walking, rules)
    rim = np.searchsorted(parts, sample, side="right") - 1
    sample = sample - parts[rim] + first[np.flatnonzero(again)[rim]]
    sample = np.concatenate([moved, sample])
    by = np.argsort(sample, kind="stable")
    kind, size = np.concatenate([old.kind[stay], kind]), np.concatenate([old.size[stay], size])
    return RimSamples(rims, first, sample[by], kind[by], size[by])


def _first_samples(rims: Rims) -> np.ndarray:
    length = np.linalg.norm(rims.end - rims.start, axis=1)
    parts = np.maximum(1, np.ceil(length / _SPACING - 1e-9)).astype(np.int64)
    return np.concatenate(([0], np.cumsum(parts)))


def _measured(
    rims: Rims,
    first: np.ndarray,
    grid: MeshGrid,
    surface: Surface,
    walking: WalkRules,
    rules: ObstacleRules,
    threads: int = 1,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Samples at which there is something, with kinds and sizes."""
    mesh, cells = grid.arrays, cells_of(surface)
    limits, near = Limits.of(rules, walking), _near(walking, rules)

    def share(begin: int, end: int) -> tuple[np.ndarray, np.ndarray]:
        part = slice(begin, end)
        start, samples = rims.start[part], first[begin : end + 1] - first[begin]
        return measure(mesh, cells, start, rims.end[part], rims.outward[part], samples, limits, near)

    bounds = np.searchsorted(first, shares(int(first[-1]), threads)).tolist()
    found = in_threads(share, list(pairwise(bounds)), threads)
    kind, size = (np.concatenate(each) for each in zip(*found, strict=True))
    sample = np.flatnonzero(kind.any(axis=1))
    return sample, kind[sample], size[sample]


def _near(walking: WalkRules, rules: ObstacleRules) -> float:
    """[m] up to which free lengths are measured to tell whether there is an obstacle."""
    return max(rules.run_up, rules.landing) + walking.resolution


def _reach(walking: WalkRules, rules: ObstacleRules) -> float:
    """[m] from a rim within which a triangle can change what is measured there: across what is cleared, the
    free length behind it, and the cells that the triangle changes."""
    across = max(rules.gap_width[1], rules.vault_depth + 0.3)
    return across + _near(walking, rules) + (reach_of(walking) + 8) * walking.resolution


def _touching(rims: Rims, areas: np.ndarray) -> np.ndarray:
    """(n,) bool: the rims whose rectangle touches one of ``areas`` (k, 2, 2)."""
    low = np.minimum(rims.start, rims.end)[:, None, :2]
    high = np.maximum(rims.start, rims.end)[:, None, :2]
    return np.any(np.all((low <= areas[:, 1]) & (high >= areas[:, 0]), axis=2), axis=1)


@allocating_kernel
def _touched(vertices, faces, areas):
    """(f,) bool: the faces whose rectangle touches one of ``areas`` (k, 2, 2)."""
    touched = np.zeros(len(faces), np.bool_)
    for f in range(len(faces)):
        a, b, c = vertices[faces[f, 0]], vertices[faces[f, 1]], vertices[faces[f, 2]]
        left, right = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
        near, far = min(a[1], b[1], c[1]), max(a[1], b[1], c[1])
        for k in range(len(areas)):
            if (
                left <= areas[k, 1, 0]
                and right >= areas[k, 0, 0]
                and near <= areas[k, 1, 1]
                and far >= areas[k, 0, 1]
            ):
                touched[f] = True
    return touched
