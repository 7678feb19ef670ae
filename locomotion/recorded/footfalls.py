"""Where feet are put down: in a cycle, ahead of a figure that goes straight on, and along a path.

In each cycle of a gait a foot strikes at a phase, bears for a share of the cycle, and stands at a place
that is told from where the figure's even travel has come to in the middle of that. So a footfall along a
path is a function of the path alone, and not of what a figure did before::

    steps = Steps(motions, "walk", path, speeds, ground)      # once for a path
    phase, place = steps.at(distance)                         # x, y, z of the path [m] and heading [rad]
    footfalls = steps.footfalls(phase)                        # (2, 2, 6), for `foot_planting.planted`
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body.anatomy import ANKLE
from locomotion.errors import LocomotionError
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import cycles_around, stride_of
from locomotion.recorded.skeletons import FULL, skeleton
from surefoot.kernels import kernel

__all__ = [
    "AHEAD", "BALL", "BEARS", "FEET", "HALF_SOLE", "HEEL", "LEFT", "STRIKES", "TURNED", "Steps", "footing",
    "footing_at", "footings", "read_footing", "straight_footfalls",
]  # fmt: skip

FEET = ("right_foot", "left_foot")
HEEL, BALL = (-0.032, 0.0, -ANKLE), (0.118, 0.0, -ANKLE)
"""[m] from the ankle, in the foot's frame: the ends of the sole."""
HALF_SOLE = 0.5 * (BALL[0] - HEEL[0])

STRIKES, BEARS, AHEAD, LEFT, TURNED = range(5)
"""Columns of a table of footfalls: phase at which a foot strikes, and share of the cycle for which it bears;
where the middle of its sole is [m], ahead and to the left of the even travel, in the middle of that; and how
far it is turned to the left [rad]."""
_CLEAR = 1e-6  # [m] between two points of a path

Ground = Callable[[NDArray[np.float64]], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""From points (k, 3) to the heights (k,) of the ground there [m] and its unit normals (k, 3)."""


def footing(motions: MotionSet) -> NDArray[np.float64]:
    """Footfalls (k, 2, 5) of the right and the left foot in each of ``motions.clips``. All 0 but in cycles
    that are planted (`Clip.bears`), and in the postures that they come to rest in: there a foot stands where
    it is, for good. Made at the first call for a set."""
    found = _tables.get(id(motions))
    if found is None or found[0] is not motions:
        table = np.zeros((len(motions.clips), 2, 5))
        for clip in motions.cycles.tolist():
            if motions.clips[clip].bears > 0.0:
                table[clip] = _footfalls_of(motions, clip)
        for clip in {int(rest) for rest in motions.rests if rest >= 0}:
            table[clip] = _standing_of(motions, clip)
        found = _tables[id(motions)] = (motions, table)
    return found[1]


_tables: dict[int, tuple[MotionSet, NDArray[np.float64]]] = {}


def _standing_of(motions: MotionSet, clip: int) -> NDArray[np.float64]:
    level, full, out = motions.levels[FULL], skeleton("full"), np.zeros((2, 5))
    row = slice(level.first[clip], level.first[clip] + 1)
    places = posed(full, level.channels[row], level.roots[row])
    for side, foot in enumerate(FEET):
        centres, turned = sole_centres(places[:, full.bodies.index(foot)])
        out[side, AHEAD:] = *centres[0, :2], turned[0]
    return out


def _footfalls_of(motions: MotionSet, clip: int) -> NDArray[np.float64]:
    level, full, out = motions.levels[FULL], skeleton("full"), np.zeros((2, 5))
    bears, stride = motions.clips[clip].bears, motions.travel[clip, 0]
    rows = slice(level.first[clip], level.first[clip] + level.count[clip])
    places = posed(full, level.channels[rows], level.roots[rows])
    for side, foot in enumerate(FEET):
        out[side, STRIKES], out[side, BEARS] = 0.5 * side, bears
        centres, turned = sole_centres(places[:, full.bodies.index(foot)])
        since = (np.arange(len(places)) / len(places) - out[side, STRIKES]) % 1.0
        middle = np.abs(since - 0.5 * bears) < 0.25 * bears
        # where the sole was or will be in the middle of the stance, as seen from the even travel
        ahead = centres[middle, 0] + stride * (since[middle] - 0.5 * bears)
        out[side, AHEAD:] = ahead.mean(), centres[middle, 1].mean(), turned[middle].mean()
    return out


def sole_centres(feet: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where the middle of a sole (n, 3) would be if the foot stood flat on its lower end, heel or ball, and
    how far it is turned to the left (n,) [rad], of places (n, 7) of a foot."""
    w, x, y, z = feet[:, 3:].T
    ahead = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    up = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    turned = np.arctan2(-2 * (x * y - w * z), 1 - 2 * (x * x + z * z))
    flat = np.stack([np.cos(turned), np.sin(turned), np.zeros(len(turned))], axis=1)
    on_heel = (ahead[:, 2] >= 0.0)[:, None]
    end = feet[:, :3] + np.where(on_heel, HEEL[0], BALL[0]) * ahead - ANKLE * up
    return end + np.where(on_heel, HALF_SOLE, -HALF_SOLE) * flat, turned


def footing_at(motions: MotionSet, gait: int, speeds: ArrayLike) -> NDArray[np.float64]:
    """Footfalls (n, 2, 5) of a gait at ``speeds`` (n,): between those of the two cycles around each. Below
    the slowest cycle they go over into those of the posture at rest."""
    fast = np.asarray(speeds, np.float64)
    return footings(motions, np.full(len(fast), gait), fast)


def footings(
    motions: MotionSet, gaits: NDArray[np.int64], speeds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """As `footing_at`, of a gait (n,) each."""
    out = np.empty((len(speeds), 2, 5))
    tables = motions.gait_first, motions.cycles, motions.speeds, motions.rests, footing(motions)
    _read_footings(tables, np.asarray(gaits, np.int64), speeds, out)
    return out


@kernel
def read_footing(tables, gait, speed, out):
    """Kernel of `footing_at`, for one figure; ``out`` (2, 5)."""
    gait_first, cycles, speeds, rests, table = tables
    slower, faster, share = cycles_around(gait_first, cycles, speeds, gait, speed)
    rest = -1
    if slower < 0:
        rest = slower = rests[gait]
    for side in range(2):
        for k in range(5):
            there = table[faster, side, k]
            if slower < 0:
                out[side, k] = share * there if k == AHEAD else there
            elif rest >= 0 and k <= BEARS:
                out[side, k] = there
            else:
                out[side, k] = (1.0 - share) * table[slower, side, k] + share * there


@kernel
def _read_footings(tables, gaits, speeds, out):
    for n in range(len(gaits)):
        read_footing(tables, gaits[n], speeds[n], out[n])


class Steps:
    """How a figure goes along a path: its phase, its place and its footfalls at each distance.

    Built once for a path; nothing changes afterwards. Memory: 7 numbers per point of the path.
    """

    def __init__(
        self,
        motions: MotionSet,
        gait: str,
        path: ArrayLike,
        speeds: ArrayLike,
        ground: Ground | None = None,
        phase: float = 0.0,
    ) -> None:
        """``path`` (m, 3) [m]; ``speeds`` (m,) [m/s] meant at its points: strides are as long as at these,
        also if the figure is slowed down on the way. ``ground`` under the feet; None: the path's own height.
        ``phase`` at the path's begin.

        Raises `LocomotionError` for a path of fewer than two points that are apart.
        """
        points, fast = np.asarray(path, np.float64), np.asarray(speeds, np.float64)
        apart = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
        kept = np.concatenate([[True], apart > _CLEAR]) if len(points) > 1 else np.zeros(0, np.bool_)
        if kept.sum() < 2 or fast.shape != (len(points),):
            raise LocomotionError(f"a path has two points or more, and a speed at each, not {points.shape}")
        points, fast = points[kept], fast[kept]
        lengths = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
        self.motions, self.gait, self.ground = motions, motions.gait(gait), ground
        self._points, self._speeds = points, fast
        self._distances = np.concatenate([[0.0], np.cumsum(lengths)])
        headings = np.unwrap(np.arctan2(*np.diff(points[:, :2], axis=0).T[::-1]))
        middles = 0.5 * (self._distances[1:] + self._distances[:-1])
        self._headings = np.interp(self._distances, middles, headings)
        stride = stride_of(motions, np.full(len(fast), self.gait), np.maximum(fast, 0.05))
        rates = 2.0 / (stride[1:] + stride[:-1])
        self._phases = phase + np.concatenate([[0.0], np.cumsum(rates * lengths)])

    @property
    def length(self) -> float:
        """[m]"""
        return float(self._distances[-1])

    def at(self, distance: float) -> tuple[float, NDArray[np.float64]]:
        """Phase and place (4,) at a ``distance`` [m] along the path: x, y, z [m] and heading [rad]."""
        return float(_beyond(distance, self._distances, self._phases)), self._place(distance)

    def speed_at(self, distance: float) -> float:
        """The speed that is meant there [m/s]."""
        return float(np.interp(distance, self._distances, self._speeds))

    def footfalls(self, phase: float) -> NDArray[np.float64]:
        """(2, 2, 6) float64 of the right and the left foot: where it stands or stood last, and where it is
        put down next: x, y, z [m], heading [rad], and slopes of the ground ahead and to the left [rad]."""
        speed = self.speed_at(float(_beyond(phase, self._phases, self._distances)))
        now = footing_at(self.motions, self.gait, [speed])[0]
        out = np.empty((2, 2, 6))
        for side in range(2):
            for step in range(2):
                number = np.floor(phase - now[side, STRIKES]) + step
                out[side, step] = self._footfall(side, number)
        return out

    def _footfall(self, side: int, number: float) -> NDArray[np.float64]:
        """A foot's footfall of this ``number`` of cycle."""
        found, distance = None, 0.0
        for _ in range(3):  # its phase depends on the speed there, which depends on its phase
            speed = self.speed_at(distance) if found is not None else self._speeds[0]
            found = footing_at(self.motions, self.gait, [speed])[0, side]
            middle = number + found[STRIKES] + 0.5 * found[BEARS]
            distance = float(_beyond(middle, self._phases, self._distances))
        assert found is not None
        x, y, z, heading = self._place(distance)
        c, s = np.cos(heading), np.sin(heading)
        point = np.array([x + c * found[AHEAD] - s * found[LEFT], y + s * found[AHEAD] + c * found[LEFT], z])
        return _on_ground(point, heading + found[TURNED], self.ground)

    def _place(self, distance: float) -> NDArray[np.float64]:
        heading = float(np.interp(distance, self._distances, self._headings))
        over = distance - min(max(distance, 0.0), self.length)
        x, y, z = (float(np.interp(distance, self._distances, column)) for column in self._points.T)
        return np.array([x + over * np.cos(heading), y + over * np.sin(heading), z, heading])


def straight_footfalls(
    motions: MotionSet, gait: int, speed: float, phase: float, place: ArrayLike, ground: Ground | None = None
) -> NDArray[np.float64]:
    """Footfalls (2, 2, 6) as of `Steps` of a figure at ``place`` (4,) that goes, and has gone, straight at
    ``speed``. Whoever has no path keeps the first of each foot for as long as that foot stands."""
    x, y, z, heading = (float(value) for value in np.asarray(place))
    table, out = footing_at(motions, gait, [speed])[0], np.empty((2, 2, 6))
    stride = float(stride_of(motions, [gait], [speed])[0])
    c, s = np.cos(heading), np.sin(heading)
    for side, found in enumerate(table):
        since = (phase - found[STRIKES]) % 1.0
        for step in range(2):
            ahead = found[AHEAD] + stride * (step + 0.5 * found[BEARS] - since)
            point = np.array([x + c * ahead - s * found[LEFT], y + s * ahead + c * found[LEFT], z])
            out[side, step] = _on_ground(point, heading + found[TURNED], ground)
    return out


def _on_ground(point: NDArray[np.float64], heading: float, ground: Ground | None) -> NDArray[np.float64]:
    if ground is None:
        return np.array([*point, heading, 0.0, 0.0])
    heights, normals = ground(point[None])
    nx, ny, nz = normals[0]
    c, s = np.cos(heading), np.sin(heading)
    ahead, left = -(c * nx + s * ny) / nz, -(c * ny - s * nx) / nz
    return np.array([point[0], point[1], heights[0], heading, np.arctan(ahead), np.arctan(left)])


def _beyond(value: float, known: NDArray[np.float64], wanted: NDArray[np.float64]) -> float:
    """Linear between the knots, and on beyond the first and the last."""
    k = min(max(int(np.searchsorted(known, value)) - 1, 0), len(known) - 2)
    return wanted[k] + (value - known[k]) * (wanted[k + 1] - wanted[k]) / (known[k + 1] - known[k])
