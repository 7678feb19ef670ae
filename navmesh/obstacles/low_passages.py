"""Low passages: where a body that bends down gets under something that it cannot walk under.

Walking ends there for a body that needs all its headroom, and not for a lower one. So the edges of a low
passage are the places where walking ends (`navmesh.surface.blockers`) on the surface of the level, but not on
the surface that the same level has for less headroom.
"""

import math
from dataclasses import replace

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.level.mesh_queries import MeshGrid, crossed, lowest_above, surface_below
from navmesh.level.terrain import Terrain
from navmesh.obstacles.edge_segments import EdgeSegment, Samples, join_samples
from navmesh.obstacles.free_length import REACH, SAME, cells_of, free_length, room
from navmesh.obstacles.kinds import ObstacleKind
from navmesh.obstacles.obstacles import Obstacles, tag_names
from navmesh.rules import WalkRules
from navmesh.surface.build import Grid, find_cells, surface_of
from navmesh.surface.columns import column_of
from navmesh.surface.floor_store import gradient_of, height_of
from navmesh.surface.surface import Surface
from surefoot.kernels import allocating_kernel, kernel
from surefoot.numeric import is_finite

__all__ = ["crouch_kind", "find_low_passages"]

_DEEPEST = 10.0  # [m] longest way bent down that is looked for
_BEHIND = 0.5  # [m] of floor that there has to be before and behind
_NEAR = 0.5  # [m] an edge this close behind another one is the same thing's other side
_PIECE = 0.1  # [m] of an edge that one line across stands for
_STRIDE = 0.02  # [m] between the places at which the free height is measured
_FINE = 0.01  # [m] to which the free height under thin things is found
_SAME_PLACE = 1e-4  # [m] segments whose ends are this close are one


def crouch_kind(
    heights: tuple[float, float] = (1.0, 1.7), width: float = 0.6, effort: tuple[float, float] = (2.0, 0.0)
) -> ObstacleKind:
    """The kind "crouch": straight ways under beams, pipes and tables, and through low openings.

    Not known until it is registered (`navmesh.register_kind`). Its size is the free height, so that a body
    says with ``find_path(skills={"crouch": (1.2, 1.8)})`` how low it goes. ``heights`` [m]: the least and
    greatest free height that is looked for; where the headroom of the graph's rules is less than the
    greatest, one walks upright there. ``width`` [m]: how wide a passage is at least. ``effort``: see
    `ObstacleKind`. Raises `NavmeshError` for other values.
    """
    if not (
        isinstance(heights, tuple)
        and len(heights) == 2
        and all(is_finite(h) for h in heights)
        and 0.1 <= heights[0] < heights[1]
    ):
        raise NavmeshError(f"heights = {heights!r}: expected (least, greatest) [m], the least at least 0.1")
    if not (is_finite(width) and 0.1 <= width <= 100.0):
        raise NavmeshError(f"width = {width!r}: expected 0.1 to 100 [m]")

    def find(terrain: Terrain, surface: Surface, walking: WalkRules) -> Obstacles:
        return find_low_passages(terrain, surface, walking, heights, width)

    return ObstacleKind("crouch", "under", effort, find=find)


def find_low_passages(
    terrain: Terrain, surface: Surface, walking: WalkRules, heights: tuple[float, float], width: float
) -> Obstacles:
    """Low passages of ``terrain``, whose ``surface`` was built under ``walking``; see `crouch_kind`."""
    least, greatest = heights
    if least >= walking.headroom:
        return Obstacles.empty()
    grid = Grid(surface.origin, surface.resolution, surface.shape)
    low = surface_of(find_cells(terrain, replace(walking, headroom=least), grid), grid)
    edge, outward, floor = _in_short_pieces(*_edges_of_low_places(surface, low))
    mesh_grid = MeshGrid(terrain.vertices, terrain.faces, surface.origin, walking.max_slope)
    measured = _measure(
        mesh_grid.arrays, cells_of(surface), cells_of(low), low.blocker_start, low.blocker,
        edge, outward, floor, math.tan(walking.max_slope), walking.max_step, walking.headroom, least,
    )  # fmt: skip
    fits = (measured[:, _HEIGHT] >= least - 1e-9) & (measured[:, _HEIGHT] <= greatest + 1e-9)
    edge, outward, floor, measured = edge[fits], outward[fits], floor[fits], measured[fits]
    samples = Samples(
        point=np.column_stack((0.5 * (edge[:, :2] + edge[:, 2:]), floor)),
        along=np.column_stack((-outward[:, 1], outward[:, 0], np.zeros(len(edge)))),
        outward=outward,
        half=0.5 * np.hypot(edge[:, 2] - edge[:, 0], edge[:, 3] - edge[:, 1]),
        height=measured[:, _HEIGHT],
        depth=measured[:, _DEPTH],
    )
    segments = join_samples(samples, width)
    return _obstacles(segments, samples, measured, surface.origin) if segments else Obstacles.empty()


_HEIGHT, _DEPTH, _RISE, _RUN_UP, _LANDING = range(5)


def _edges_of_low_places(surface: Surface, low: Surface) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where walking ends on ``surface`` and not on ``low``: segments (m, 4) [m] seen from above, the unit
    vector (m, 2) towards whom they stop, and the height (m,) [m] of the floor there."""
    count = np.diff(surface.blocker_start)
    cell = np.repeat(np.arange(len(surface)), count)
    segment = surface.blocker
    new = ~_among(_listed(surface), _listed(low))
    cell, segment = cell[new], segment[new]
    across = segment[:, 2:] - segment[:, :2]
    length = np.hypot(across[:, 0], across[:, 1])
    column = np.stack(np.divmod(surface.columns(cell), surface.shape[1]), axis=1)
    middle = 0.5 * (segment[:, :2] + segment[:, 2:])
    away = (column + 0.5) * surface.resolution - middle
    side = np.sign(across[:, 0] * away[:, 1] - across[:, 1] * away[:, 0])
    real = (length > _SAME_PLACE) & (side != 0.0)
    cell, segment, across, length = cell[real], segment[real], across[real], length[real]
    away, side = away[real], side[real]
    outward = np.column_stack((-across[:, 1], across[:, 0])) * (side / length)[:, None]
    floor = surface.heights(cell) - np.einsum("ij,ij->i", surface.gradients(cell), away)
    # the same piece is in the lists of several cells: the nearest of them says how high the floor is
    order = np.argsort(np.hypot(away[:, 0], away[:, 1]), kind="stable")
    key = np.column_stack((np.rint(segment / _SAME_PLACE), side, np.rint(floor)))[order]
    first = np.sort(order[np.unique(key, axis=0, return_index=True)[1]])
    return segment[first], outward[first], floor[first]


def _in_short_pieces(edge: np.ndarray, outward: np.ndarray, floor: np.ndarray) -> tuple:
    """The same edges, none longer than `_PIECE`."""
    along = edge[:, 2:] - edge[:, :2]
    parts = np.ceil(np.hypot(along[:, 0], along[:, 1]) / _PIECE).astype(np.int64)
    owner = np.repeat(np.arange(len(edge)), parts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(parts) - parts, parts)
    begin, end = (
        edge[owner, :2] + (at / parts[owner])[:, None] * along[owner] for at in (number, number + 1)
    )
    return np.column_stack((begin, end)), outward[owner], floor[owner]


def _listed(surface: Surface) -> np.ndarray:
    """Every blocker with the place of the cell in whose list it is: (k, 6), in units that count as the same
    place. The top of a beam ends where the way under it does, but not at the same height."""
    cell = np.repeat(np.arange(len(surface)), np.diff(surface.blocker_start))
    values = np.column_stack((surface.blocker, surface.heights(cell))) / _SAME_PLACE
    return np.column_stack((np.rint(values).astype(np.int64), surface.columns(cell)))


def _among(rows: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Which of ``rows`` (m, c) are among ``others`` (k, c): (m,) bool."""
    number = np.unique(np.concatenate((rows, others)), axis=0, return_inverse=True)[1].reshape(-1)
    return np.isin(number[: len(rows)], number[len(rows) :])


def _obstacles(
    segments: list[EdgeSegment], samples: Samples, measured: np.ndarray, origin: np.ndarray
) -> Obstacles:
    lowest = np.array([measured[segment.members, _HEIGHT].min() for segment in segments])
    ends = np.array([[segment.members[0], segment.members[-1]] for segment in segments])
    middle = np.array([segment.middle for segment in segments])
    nearest = np.array(
        [segment.members[np.argmin(np.abs(samples.point[segment.members] - segment.middle).sum(axis=1))]
         for segment in segments]
    )  # fmt: skip
    normal = np.column_stack(([segment.outward for segment in segments], np.zeros(len(segments))))
    kind = np.full(len(segments), "crouch")
    position = middle + origin
    return Obstacles(
        affordance=kind,
        position=position,
        normal=normal + 0.0,
        height=lowest.round(4),
        depth=measured[nearest, _DEPTH],
        width=np.array([segment.width for segment in segments]),
        rim=np.array([(segment.start, segment.end) for segment in segments]) + origin,
        rim_height=measured[ends, _HEIGHT].round(4),
        run_up=measured[nearest, _RUN_UP],
        landing=measured[nearest, _LANDING],
        rise=measured[nearest, _RISE].round(4),
        tag=tag_names(kind, position, normal),
        authored=np.zeros(len(segments), np.bool_),
    )


@kernel
def _next_edge(edge, x, y, dx, dy, nearest, farthest, last):
    """How far from (x, y) in direction (dx, dy) the first of the segments is that the line crosses between
    ``nearest`` and ``farthest`` [m], or the ``last``; inf without one."""
    found = np.inf
    for k in range(len(edge)):
        ax, ay = edge[k, 0] - x, edge[k, 1] - y
        bx, by = edge[k, 2] - x, edge[k, 3] - y
        a, b = dx * ay - dy * ax, dx * by - dy * bx  # to the left of the line
        if (a > 1e-9 and b > 1e-9) or (a < -1e-9 and b < -1e-9) or abs(a - b) < 1e-12:
            continue
        t = a / (a - b)
        at = (ax + t * (bx - ax)) * dx + (ay + t * (by - ay)) * dy
        if nearest <= at <= farthest and (found == np.inf or (at > found) == last):
            found = at
    return found


@kernel
def _free_height(grid, x, y, z, dx, dy, depth, rise, step, least, headroom):
    """The least free height [m] over the floor along a line, at most ``headroom``."""
    height = headroom
    at = 0.0
    while at <= depth:
        px, py = x + at * dx, y + at * dy
        floor = z + rise * (at / depth if depth > 0.0 else 0.0)
        found, t = surface_below(grid, px, py, floor - step, floor + step)
        if t >= 0:
            floor = found
        height = min(height, lowest_above(grid, px, py, floor + 0.5 * least, floor + headroom) - floor)
        at += _STRIDE
    # what is upright, and too thin to be met from below
    qx, qy = x + (depth + _STRIDE) * dx, y + (depth + _STRIDE) * dy
    px, py = x - _STRIDE * dx, y - _STRIDE * dy
    level = least
    while level < height:
        if crossed(grid, px, py, z + level, qx, qy, z + rise + level):
            return level - _FINE
        level += _FINE
    return height


@allocating_kernel
def _upright_cells(tall, low):
    """The cell of ``tall`` that each of ``low`` is, or -1 where one has to bend down: (n,) int32."""
    upright = np.full(low.storey.shape[0], -1, np.int32)
    for c in range(upright.size):
        column = column_of(low, c)
        for k in range(tall.column_start[column], tall.column_start[column + 1]):
            if abs(height_of(tall, k) - height_of(low, c)) < _SAME_PLACE:
                upright[c] = k
    return upright


@kernel
def _first_upright(low, blocker_start, blocker, upright, x, y, z, dx, dy, slope):
    """How far under an edge one gets up again, going straight on, and the cell there: (distance [m], cell of
    the level's surface or -1)."""
    at = 0.02
    while at <= _DEEPEST:
        gone, _, first, cell = room(low, x, y, z, dx, dy, slope, at)
        if first >= 0:
            beside = blocker[blocker_start[cell] : blocker_start[cell + 1]]
            if gone < at or _next_edge(beside, x, y, dx, dy, _SAME_PLACE, at, False) < np.inf:
                break
            if upright[cell] >= 0:
                return at, upright[cell]
        at += 0.25 * low.size
    return at, -1


@allocating_kernel
def _measure(grid, tall, low, blocker_start, blocker, edge, outward, floor, slope, step, headroom, least):
    """Free height, depth, rise of the floor behind, run-up and landing [m] (m, 5) of a way straight under
    each ``edge``; the height is -1 where there is none."""
    measured = np.full((len(edge), 5), -1.0)
    upright = _upright_cells(tall, low)
    for k in range(len(edge)):
        x, y = 0.5 * (edge[k, 0] + edge[k, 2]), 0.5 * (edge[k, 1] + edge[k, 3])
        z = floor[k]
        dx, dy = -outward[k, 0], -outward[k, 1]
        if _next_edge(edge, x, y, -dx, -dy, _SAME_PLACE, _NEAR, False) < np.inf:
            continue  # there is another edge before it
        beyond, cell = _first_upright(low, blocker_start, blocker, upright, x, y, z, dx, dy, slope)
        if cell < 0:
            continue
        depth = _next_edge(edge, x, y, dx, dy, _SAME_PLACE, beyond + 1.5 * tall.size, True)
        if depth == np.inf:  # a curtain is one edge from both sides
            depth = beyond if beyond > 1.5 * tall.size else 0.0
        through, _, _, _ = room(low, x, y, z, dx, dy, slope, depth + _BEHIND)
        if through < depth + _BEHIND:
            continue
        column = column_of(tall, cell)
        ix = column // tall.ny
        ux = x + depth * dx - (ix + 0.5) * tall.size
        uy = y + depth * dy - (column - ix * tall.ny + 0.5) * tall.size
        slope_x, slope_y = gradient_of(tall, cell)
        behind = height_of(tall, cell) + slope_x * ux + slope_y * uy
        before, _, _ = free_length(grid, tall, x, y, z, -dx, -dy, slope, step, headroom, REACH)
        after, _, _ = free_length(
            grid, tall, x + depth * dx, y + depth * dy, behind, dx, dy, slope, step, headroom, REACH
        )
        if before < _BEHIND - SAME or after < _BEHIND - SAME:
            continue
        measured[k, _HEIGHT] = _free_height(grid, x, y, z, dx, dy, depth, behind - z, step, least, headroom)
        measured[k, _DEPTH], measured[k, _RISE] = depth, behind - z
        measured[k, _RUN_UP], measured[k, _LANDING] = before, after
    return measured
