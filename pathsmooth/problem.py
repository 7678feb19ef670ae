"""The smoothing problem: waypoints on the pulled path, the discs they must stay in, and the weights."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pathsmooth import kernels
from pathsmooth.errors import PathSmoothError
from pathsmooth.geometry import arc_along, interpolated, steps_along
from pathsmooth.packing import into_discs, pack
from pathsmooth.placement import COVERED, END_OUTSIDE, START_OUTSIDE, cover, place, point_at

SLACK = 1e-9
"""[m] by which discs may miss the path: rounding in the caller's arithmetic."""

SMOOTHNESS = 0.3
"""[m^3] default weight of the bending term, the cube of a smoothing length of 0.67 m."""

_SHORTEST_TANGENT = 1 / 32  # of the spacing


class _Placed(NamedTuple):
    """Waypoints in the discs of a corridor, as in `Problem`."""

    arc: NDArray[np.float64]
    segment_disc: NDArray[Any]
    centers: NDArray[np.float64]
    radii: NDArray[np.float64]


class _Wanted(NamedTuple):
    """What is asked of the path, as in `Problem`."""

    max_curvature: float | None
    smoothness: float
    spacing: float


@dataclass(frozen=True, eq=False)
class Problem:
    """Waypoints to be moved by the solver; made by `from_corridor`. Arrays are float64 and must not be
    changed.

    The objective of positions x (n, 2), with targets p on the pulled path, h the spacing of the targets and
    h̄ its mean on both sides of a waypoint:

        f = Σ h̄ᵢ ‖xᵢ − pᵢ‖ + λ Σ h̄ᵢ ‖second divided difference of x at i‖²

    The first and the last waypoint are pinned, and with an end tangent their neighbours too.
    """

    targets: NDArray[np.float64]
    """(n, 2) [m] where the waypoints lie on the pulled path; pinned ones lie where they are pinned."""
    heights: NDArray[np.float64]
    """(n,) [m] z of the pulled path at the waypoints; not optimised."""
    arc: NDArray[np.float64]
    """(n,) [m] horizontal arc length at the waypoints, along the path that they were placed on."""
    source: NDArray[np.float64]
    """(n,) [m] horizontal arc length of the pulled path at the targets; the same as `arc` unless a bound on
    curvature made the solver place the waypoints anew."""
    segment_disc: NDArray[np.int32]
    """(n - 1,) the disc that holds each segment; a waypoint stays in the discs of both its segments."""
    centers: NDArray[np.float64]
    """(m, 2) [m] centres of the corridor's discs."""
    radii: NDArray[np.float64]
    """(m,) [m] their radii, already less the body's radius."""
    first: int
    """Index of the first waypoint that may move: 1, or 2 with a start tangent."""
    last: int
    """One more than the index of the last waypoint that may move."""
    spacing: float
    """[m], > 0: greatest distance between waypoints."""
    smoothness: float
    """λ [m³], > 0: the cube of the length over which corners are rounded."""
    max_curvature: float | None
    """[1/m], > 0, or None for no bound."""
    obstruction: str
    """Why no path with the wanted end tangents stays in the corridor; empty where one may exist."""
    path: NDArray[np.float64]
    """(k, 3) [m] the pulled path, without repeated points."""
    tangents: tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]
    """Horizontal unit tangents (2,) at the start and the end."""
    packed: NDArray[np.float64] = field(repr=False)
    """(ROWS, n) what the compiled loops read, see `kernels`."""

    def __repr__(self) -> str:
        bound = "" if self.max_curvature is None else f", curvature up to {self.max_curvature:g} 1/m"
        return f"<Problem: {len(self.targets)} waypoints, {len(self.radii)} discs{bound}>"

    @classmethod
    def from_corridor(
        cls,
        waypoints: ArrayLike,
        centers: ArrayLike,
        radii: ArrayLike,
        spacing: float = 0.25,
        start_tangent: ArrayLike | None = None,
        end_tangent: ArrayLike | None = None,
        max_curvature: float | None = None,
        smoothness: float = SMOOTHNESS,
    ) -> Problem:
        """Subdivide a pulled path and assign its waypoints to the discs of its corridor.

        waypoints: (k, 2) or (k, 3) [m], k >= 2, the pulled path. Only x and y are smoothed, z is carried on.
        centers, radii: (m, 2) or (m, 3) [m], (m,) [m] >= 0, the discs in the order of the path, shrunk by
            the body's radius. There are increasing arc lengths between which the path lies in disc j, so
            consecutive discs overlap on the path. Missing it by up to 1e-9 m counts as rounding.
        spacing: [m] > 0, greatest distance between waypoints. Short paths get at least four segments.
        start_tangent, end_tangent: (2,) or (3,), directions of travel at the two ends, of any length; the
            horizontal part is kept exactly.
        max_curvature: [1/m] > 0, bound on the curvature of the result.
        smoothness: λ [m³] > 0; larger is smoother and farther from the pulled path.

        Raises PathSmoothError for wrong shapes, values that are not finite, and discs that do not cover the
        path.
        """
        path, xy, arc = _path(waypoints)
        disc_centers, disc_radii = _discs(centers, radii)
        _positive("spacing", spacing, "m")
        _positive("smoothness", smoothness, "m^3")
        if max_curvature is not None:
            _positive("max_curvature", max_curvature, "1/m")
        tangents = (_tangent("start_tangent", start_tangent), _tangent("end_tangent", end_tangent))
        local_centers = disc_centers - xy[0]
        local = xy - xy[0]
        code, disc, reached, begin, end = cover(local, arc, local_centers, disc_radii, SLACK)
        if code != COVERED:
            raise PathSmoothError(_not_covered(code, disc, reached, local, arc, local_centers, disc_radii))
        step = min(spacing, arc[-1] / 4)
        waypoint_arc, segment_disc = place(local, arc, local_centers, disc_radii, begin, end, step)
        return cls._assemble(
            path, arc, arc, _Placed(waypoint_arc, segment_disc, disc_centers, disc_radii), tangents,
            _Wanted(max_curvature, float(smoothness), float(spacing)),
        )  # fmt: skip

    def narrowed(self, by: float) -> Problem:
        """The same problem in discs that are smaller by ``by`` [m] > 0, or as far as its targets allow."""
        _positive("by", by, "m")
        ends = np.stack([self.targets[:-1], self.targets[1:]])
        needed = np.zeros(len(self.radii))
        np.maximum.at(
            needed,
            self.segment_disc,
            np.linalg.norm(ends - self.centers[self.segment_disc], axis=2).max(axis=0),
        )
        radii = np.minimum(np.maximum(self.radii - by, needed), self.radii)
        packed = pack(
            self.targets, self.arc, self.segment_disc, self.centers, radii, self.smoothness, self.first,
            self.last,
        )  # fmt: skip
        return replace(self, radii=radii, packed=packed)

    def along(
        self, curve: NDArray[np.float64], source: NDArray[np.float64], discs: NDArray[np.integer]
    ) -> Problem:
        """The same problem with its waypoints spread evenly along another curve in the corridor.

        curve (k, 2) [m]: the spacing, and with it the second divided difference, is measured along it. source
        (k,) [m]: arc length of the pulled path that each of its points corresponds to, not decreasing. discs
        (j,): the discs that the curve passes, in order. The targets stay on the pulled path, and may lie
        outside the discs of their waypoints.
        """
        keep = np.concatenate([[True], steps_along(curve) > SLACK])
        keep[-1] = True
        curve, source = curve[keep], source[keep]
        arc = arc_along(steps_along(curve))
        centers, radii = self.centers[discs], self.radii[discs]
        local, local_centers = curve - curve[0], centers - curve[0]
        code, disc, reached, begin, end = cover(local, arc, local_centers, radii, 10 * SLACK)
        if code != COVERED:
            raise PathSmoothError(_not_covered(code, disc, reached, local, arc, local_centers, radii))
        step = min(self.spacing, arc[-1] / 4)
        waypoint_arc, segment_disc = place(local, arc, local_centers, radii, begin, end, step)
        return self._assemble(
            self.path, arc, source, _Placed(waypoint_arc, segment_disc, centers, radii), self.tangents,
            _Wanted(self.max_curvature, self.smoothness, self.spacing),
        )  # fmt: skip

    @classmethod
    def _assemble(
        cls,
        path: NDArray[np.float64],
        arc: NDArray[np.float64],
        source: NDArray[np.float64],
        placed: _Placed,
        tangents: tuple[NDArray[np.float64] | None, NDArray[np.float64] | None],
        wanted: _Wanted,
    ) -> Problem:
        """Pin the ends and pack the arrays of the compiled loops."""
        waypoint_arc, segment_disc, centers, radii = placed
        max_curvature, smoothness, spacing = wanted
        obstruction = ""
        pins: dict[int, NDArray[np.float64]] = {}
        start, end = tangents
        if start is not None:
            length = _tangent_step(path[0, :2], start, waypoint_arc[1], segment_disc[:2], centers, radii)
            if length == 0.0:
                obstruction = "the start tangent leaves the corridor at once"
            else:
                if length < waypoint_arc[1]:
                    waypoint_arc = np.insert(waypoint_arc, 1, length)
                    segment_disc = np.insert(segment_disc, 0, segment_disc[0])
                pins[1] = path[0, :2] + length * start
        if end is not None:
            gap = waypoint_arc[-1] - waypoint_arc[-2]
            length = _tangent_step(path[-1, :2], -end, gap, segment_disc[:-3:-1], centers, radii)
            if length == 0.0:
                obstruction = "the end tangent comes from outside the corridor"
            else:
                if length < gap:
                    waypoint_arc = np.insert(waypoint_arc, -1, waypoint_arc[-1] - length)
                    segment_disc = np.append(segment_disc, segment_disc[-1])
                pins[len(waypoint_arc) - 2] = path[-1, :2] - length * end
        n = len(waypoint_arc)
        waypoint_source = np.interp(waypoint_arc, arc, source)
        targets = interpolated(waypoint_source, arc_along(steps_along(path)), path)
        heights = targets[:, 2].copy()
        targets = np.ascontiguousarray(targets[:, :2])
        if source is arc:
            into_discs(targets, segment_disc, centers, radii)
        for index, position in pins.items():
            targets[index] = position
        first = 2 if start is not None and not obstruction else 1
        last = n - (2 if end is not None and not obstruction else 1)
        packed = pack(targets, waypoint_arc, segment_disc, centers, radii, smoothness, first, last)
        return cls(
            targets, heights, waypoint_arc, waypoint_source, segment_disc, centers, radii, first, last,
            spacing, smoothness,
            max_curvature, obstruction, path, tangents, packed,
        )  # fmt: skip

    @property
    def count(self) -> int:
        """Number of waypoints n."""
        return len(self.arc)

    def objective(self, points: ArrayLike) -> float:
        """f of the horizontal positions points (n, 2) or (n, 3) [m], whether or not they are in the
        corridor."""
        xy = np.asarray(points, dtype=np.float64)[:, :2]
        if xy.shape != self.targets.shape:
            raise PathSmoothError(f"points has {len(xy)} rows, but the problem has {self.count} waypoints")
        return float(kernels.objective(self.packed, xy - self.targets, 0, self.count))

    def outside(self, points: ArrayLike) -> float:
        """[m] how far the polyline through points (n, 2) or (n, 3) leaves its discs; 0 where it is inside."""
        xy = np.asarray(points, dtype=np.float64)[:, :2]
        worst = 0.0
        for ends in (xy[:-1], xy[1:]):
            distance = np.linalg.norm(ends - self.centers[self.segment_disc], axis=1)
            worst = max(worst, float(np.max(distance - self.radii[self.segment_disc])))
        return worst


def _tangent_step(end, direction, length, discs, centers, radii) -> float:
    """Length of the straight first step along a tangent that stays in the corridor; 0 where there is none."""
    shortest = length * _SHORTEST_TANGENT
    while length >= shortest:
        if np.all(np.linalg.norm(end + length * direction - centers[discs], axis=1) <= radii[discs]):
            return float(length)
        discs = discs[:1]  # a shorter step ends before the next waypoint, in one disc only
        length *= 0.5
    return 0.0


def _array(name: str, value: ArrayLike, columns: tuple[int, ...] | None) -> NDArray[np.float64]:
    wanted = "(n,)" if columns is None else " or ".join(f"(n, {c})" for c in columns)
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise PathSmoothError(f"{name} must be an array of numbers of shape {wanted}: {error}") from None
    right = array.ndim == 1 if columns is None else array.ndim == 2 and array.shape[1] in columns
    if not right:
        raise PathSmoothError(f"{name} has shape {array.shape}, not {wanted}")
    finite = np.isfinite(array) if columns is None else np.isfinite(array).all(axis=1)
    if not finite.all():
        row = int(np.argmin(finite))
        raise PathSmoothError(f"{name}[{row}] is not finite: {array[row]}")
    return array


def _path(waypoints: ArrayLike):
    """The path (k, 3) without repeated points, its (k, 2) part, and its arc length (k,)."""
    given = _array("waypoints", waypoints, (2, 3))
    if len(given) < 2:
        raise PathSmoothError(f"waypoints has {len(given)} rows; a path has at least 2")
    path = given if given.shape[1] == 3 else np.column_stack([given, np.zeros(len(given))])
    step = steps_along(path)
    keep = np.concatenate([[True], step > SLACK])
    keep[-1] = True
    if not np.any(step > SLACK):
        raise PathSmoothError(
            f"the path has no horizontal length: all {len(path)} waypoints lie at "
            f"({path[0, 0]:g}, {path[0, 1]:g})"
        )
    path = path[keep]
    if len(path) > 2 and np.hypot(*(path[-1, :2] - path[-2, :2])) <= SLACK:
        path = np.delete(path, -2, axis=0)
    xy = np.ascontiguousarray(path[:, :2])
    return path, xy, arc_along(steps_along(xy))


def _discs(centers: ArrayLike, radii: ArrayLike):
    disc_centers = np.ascontiguousarray(_array("centers", centers, (2, 3))[:, :2])
    disc_radii = _array("radii", radii, None)
    if len(disc_centers) != len(disc_radii):
        raise PathSmoothError(
            f"{len(disc_centers)} centers but {len(disc_radii)} radii; each disc needs both"
        )
    if len(disc_radii) == 0:
        raise PathSmoothError("the corridor has no discs")
    if np.any(disc_radii < 0.0):
        row = int(np.argmax(disc_radii < 0.0))
        raise PathSmoothError(
            f"radii[{row}] is {disc_radii[row]:g} m: a disc shrunk by the body's radius must not be negative"
        )
    return disc_centers, disc_radii


def _tangent(name: str, value: ArrayLike | None) -> NDArray[np.float64] | None:
    if value is None:
        return None
    try:
        vector = np.array(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise PathSmoothError(f"{name} must be a direction (2,) or (3,): {error}") from None
    if vector.shape not in ((2,), (3,)) or not np.isfinite(vector).all():
        raise PathSmoothError(f"{name} must be a finite direction of shape (2,) or (3,), not {value!r}")
    length = float(np.hypot(vector[0], vector[1]))
    if length < 1e-12:
        raise PathSmoothError(f"{name} has no horizontal part: {value!r}")
    return vector[:2] / length


def _positive(name: str, value: float, unit: str) -> None:
    try:
        right = np.isfinite(value) and value > 0.0
    except TypeError:
        right = False
    if not right:
        raise PathSmoothError(f"{name} must be a positive number [{unit}], not {value!r}")


def _not_covered(code, disc, reached, path, arc, centers, radii) -> str:
    total = arc[-1]
    where = point_at(path, arc, reached)
    gap = np.hypot(where[0] - centers[disc, 0], where[1] - centers[disc, 1]) - radii[disc]
    if code == START_OUTSIDE:
        return f"the path starts {gap:.3g} m outside disc 0; the first disc must hold its start"
    if code == END_OUTSIDE:
        return (
            f"the corridor ends before the path: its {len(radii)} discs in order cover the path up to "
            f"arc length {reached:.6g} m of {total:.6g} m"
        )
    beyond = f"{gap:.3g} m outside" if gap > 0 else "not in the stretch of path inside"
    return (
        f"the corridor has a gap: discs 0 to {disc - 1} in order cover the path up to "
        f"arc length {reached:.6g} m of {total:.6g} m, "
        f"where it is {beyond} disc {disc}; consecutive discs must overlap on the path"
    )
