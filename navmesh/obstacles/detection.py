"""Affordances: the obstacles of a level that a skill can clear, found from its mesh alone.

Three stages: the mesh's edges at which there is a fall (`navmesh.obstacles.rims`), measuring at points along
them (`navmesh.obstacles.rim_measuring`), and joining like points to obstacles with a frame
(`navmesh.obstacles.edge_segments`).
"""

from collections.abc import Callable

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.level.mesh_queries import MeshGrid
from navmesh.level.terrain import Terrain
from navmesh.obstacles.edge_segments import EdgeSegment, Samples, join_samples
from navmesh.obstacles.free_length import REACH, cells_of
from navmesh.obstacles.kinds import ObstacleKind, kind_of, obstacle_kinds
from navmesh.obstacles.obstacles import Obstacles, tag_names
from navmesh.obstacles.rim_measuring import FOUND, Limits, measure
from navmesh.obstacles.rim_samples import RimSamples, take_rim_samples
from navmesh.obstacles.rims import Rims
from navmesh.obstacles.rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.surface.surface import Surface

__all__ = ["detect_obstacles", "obstacles_at", "with_own_kinds"]


def detect_obstacles(
    terrain: Terrain, surface: Surface, walking: WalkRules, rules: ObstacleRules | None = None
) -> Obstacles:
    """The obstacles of ``terrain``, whose walkable ``surface`` was built under ``walking``.

    ``rules`` (default `ObstacleRules()`) say what counts as clearable. What ``walking.max_step`` lets a body
    walk over is no obstacle.
    """
    rules = rules or ObstacleRules()
    grid = MeshGrid(terrain.vertices, terrain.faces, surface.origin, walking.max_slope)
    rim_samples = take_rim_samples(terrain, surface, walking, rules, grid)
    found = obstacles_at(rim_samples, surface, walking, rules, grid)
    return with_own_kinds(found, terrain, surface, walking)


def with_own_kinds(found: Obstacles, terrain: Terrain, surface: Surface, walking: WalkRules) -> Obstacles:
    """``found`` and what the kinds find that look for their obstacles themselves (`ObstacleKind.find`)."""
    own = []
    for kind in obstacle_kinds():
        if kind.find is not None:
            its = kind.find(terrain, surface, walking)
            if not isinstance(its, Obstacles):
                raise NavmeshError(f"{kind.affordance}: find gave {type(its).__name__}; expected Obstacles")
            own.append(its)
    return Obstacles.joined([found, *own]).sorted() if own else found


def obstacles_at(
    rim_samples: RimSamples, surface: Surface, walking: WalkRules, rules: ObstacleRules, grid: MeshGrid
) -> Obstacles:
    """The obstacles that ``rim_samples`` show."""
    rims, first = rim_samples.rims, rim_samples.first
    along = rims.end - rims.start
    length = np.linalg.norm(along, axis=1)
    parts = np.diff(first)
    limits = Limits.of(rules, walking)
    cells = cells_of(surface)

    def again(points: np.ndarray, outward: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        every = np.arange(len(points) + 1)
        return measure(grid.arrays, cells, points, points, outward, every, limits, REACH)

    found = []
    for name, code, slot in FOUND:
        kind = kind_of(name)
        there = rim_samples.kind[:, slot] == code
        if not there.any():
            continue
        hits, size = rim_samples.sample[there], rim_samples.size[there, slot]
        samples = _samples(rims, along / length[:, None], length / parts, first, hits, size, kind)
        segments = join_samples(samples, 2.0 * rules.body_radius)
        if segments:
            here = _frames(kind, code, slot, segments, samples, rules.body_radius, again)
            found.append(here)
    if not found:
        return Obstacles.empty()
    world = Obstacles.joined(found).arrays()
    world["position"] = world["position"] + surface.origin
    world["rim"] = world["rim"] + surface.origin
    world["tag"] = tag_names(world["affordance"], world["position"], world["normal"])
    return Obstacles(**world).sorted()


def _samples(
    rims: Rims,
    along: np.ndarray,
    spacing: np.ndarray,
    first: np.ndarray,
    hits: np.ndarray,
    size: np.ndarray,
    kind: ObstacleKind,
) -> Samples:
    rim = np.searchsorted(first, hits, side="right") - 1
    part = (hits - first[rim] + 0.5) / (first[rim + 1] - first[rim])
    return Samples(
        point=rims.start[rim] + part[:, None] * (rims.end[rim] - rims.start[rim]),
        along=along[rim],
        outward=rims.outward[rim],
        half=0.5 * spacing[rim],
        height=size[:, 0],
        depth=size[:, 1] if kind.has_depth else np.zeros(len(hits)),
    )


def _frames(
    what: ObstacleKind,
    code: int,
    slot: int,
    segments: list[EdgeSegment],
    samples: Samples,
    body_radius: float,
    again: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
) -> Obstacles:
    """Obstacles (relative to the surface's origin) of segments. ``again`` measures at points (p, 3) with
    the fall towards (p, 2): at the middle of each segment and, for free lengths, a radius beside it."""
    count = len(segments)
    middle = np.array([segment.middle for segment in segments])
    outward = np.array([segment.outward for segment in segments])
    beside = np.array([_beside(samples, segment, body_radius) for segment in segments])
    points = np.stack((middle, *(samples.point[beside[:, k]] for k in range(3))), axis=1)
    facing = np.stack((outward, *(samples.outward[beside[:, k]] for k in range(3))), axis=1)
    kind, size = again(points.reshape(-1, 3), facing.reshape(-1, 2))
    values = size[:, slot].reshape(count, 4, 5)
    there = kind[:, slot].reshape(count, 4) == code
    # where nothing fits half-way (a seam of the mesh), the sample nearest to it stands in
    seam = ~there[:, 0]
    values[seam, 0] = values[seam, 2]
    middle[seam], outward[seam] = points[seam, 2], facing[seam, 2]
    there[seam, 0] = True
    free = np.where(there[:, :, None], values[:, :, 2:4], np.inf).min(axis=1)
    values = values[:, 0]
    values[:, 2:4] = free
    from_above = not what.from_below
    rim = np.array([(segment.start, segment.end) for segment in segments])
    rim_height = samples.height[[(segment.members[0], segment.members[-1]) for segment in segments]]
    # the fall is to the right of start → end: start is on the left for who comes from below
    if from_above:
        rim, rim_height = rim[:, ::-1], rim_height[:, ::-1]
    normal = np.column_stack((-outward if from_above else outward, np.zeros(count)))
    return Obstacles(
        affordance=np.full(count, what.affordance, "<U5"),
        position=middle,
        normal=normal + 0.0,
        height=values[:, 0].round(4),
        depth=values[:, 3] if what.crossing == "onto" else values[:, 1],
        width=np.array([segment.width for segment in segments]),
        rim=rim,
        rim_height=rim_height.round(4),
        run_up=values[:, 2],
        landing=values[:, 3],
        rise=values[:, 4].round(4),
        tag=np.full(count, "", "<U64"),
        authored=np.zeros(count, np.bool_),
    )


def _beside(samples: Samples, segment: EdgeSegment, radius: float) -> tuple[int, int, int]:
    """The members of a segment nearest to its middle and to the points ``radius`` [m] to its sides."""
    away = (samples.point[segment.members] - segment.middle) @ (segment.end - segment.start) / segment.width
    before, at, behind = (segment.members[int(np.argmin(np.abs(away - s)))] for s in (-radius, 0.0, radius))
    return int(before), int(at), int(behind)
