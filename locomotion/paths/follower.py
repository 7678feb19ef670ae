"""The path of a person, its progress along it, and going back for a run-up."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from locomotion.avoidance.yielding import SPACING
from locomotion.body.person import CONTROL_DT
from locomotion.paths import table as path_table
from locomotion.paths import tracking as path_tracking
from locomotion.paths.gait_plan import SLOWS_WITHIN
from locomotion.paths.table import PathTable, TrackingLimits
from locomotion.paths.tracking import back_along, new_track, shifted, track

__all__ = ["PathFollower"]

_ROOM = 2.5, 5.0  # [m] that it goes back at least to let others pass, the first and the second time
_STRAIGHT, _AT_EDGE = 0.35, 0.3  # [rad] by which a run-up may bend; [m] before an edge
_SLOWING = [path_tracking.TRIED, path_tracking.STOPS_SINCE]
_LEAST = 0.5  # [m] behind the edge from which it does


class PathFollower:
    """``path``: the present path, None before the first. ``interrupted``: the path to which it returns, at
    arc length ``back_to`` [m], after going back along it; else None. ``memory``: of `path_tracking.track`."""

    def __init__(self) -> None:
        self.path: PathTable | None = None
        self.interrupted: PathTable | None = None
        self.back_to = 0.0
        self.memory = new_track()

    def begin(self, path: PathTable, tick: int, slows: bool = False) -> None:
        """Follow ``path`` from its beginning. ``slows``: whether it is slowing down; it goes on with that."""
        self.path, self.interrupted = path, None
        slowing = self.memory[_SLOWING]
        self.memory[:] = new_track()
        if slows:
            self.memory[_SLOWING] = slowing
        self.memory[path_tracking.HEADWAY_TICK] = tick
        self.memory[path_tracking.REMAINING] = path.length

    def forget(self) -> None:
        """Have no path."""
        self.path = self.interrupted = None

    @property
    def arc(self) -> float:
        """[m] travelled along the present path."""
        return self.memory.item(path_tracking.ARC)

    @property
    def arc_length(self) -> float:
        """[m] travelled along the whole path, also while it goes back."""
        if self.interrupted is not None:
            return self.back_to + self.remaining
        return self.arc

    @property
    def remaining(self) -> float:
        """[m] left of the present path."""
        return self.memory.item(path_tracking.REMAINING)

    @property
    def ended(self) -> bool:
        """Whether it is at the end, or beyond."""
        return self.remaining <= 1e-9

    @property
    def lateral(self) -> float:
        """[m] of the centre of mass to the left of the path."""
        return self.memory.item(path_tracking.LATERAL)

    @property
    def pace(self) -> float:
        """Share of the planned speed at which it moves."""
        return self.memory.item(path_tracking.PACE)

    @pace.setter
    def pace(self, pace: float) -> None:
        self.memory[path_tracking.PACE] = pace

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3) float64 [m]: the whole path."""
        path = self.interrupted or self.path
        return np.empty((0, 3)) if path is None else path.table[:, :3].copy()

    @property
    def runs(self) -> bool:
        """Whether the plan says to run here."""
        return self.path is not None and self.path.runs(self.arc)

    @property
    def brakes(self) -> bool:
        """Whether the plan says to stop here if it runs."""
        return self.path is not None and self.path.brakes(self.arc)

    @property
    def begins_to_slow(self) -> bool:
        """Whether it may still slow down or brake a moment later."""
        return self.path is not None and self.path.changed(self.arc, SLOWS_WITHIN)

    @property
    def tried_to_slow(self) -> int:
        """Tick at which it found no way to slow down to a walk, or began to without having rehearsed it; 0:
        it has not tried, or knows that it holds."""
        return int(self.memory.item(path_tracking.TRIED))

    @tried_to_slow.setter
    def tried_to_slow(self, tick: int) -> None:
        self.memory[path_tracking.TRIED] = tick

    @property
    def stops_since(self) -> int:
        """Tick since which one that runs wants to stop without having rehearsed it; 0: it does not."""
        return int(self.memory.item(path_tracking.STOPS_SINCE))

    @stops_since.setter
    def stops_since(self, tick: int) -> None:
        self.memory[path_tracking.STOPS_SINCE] = tick

    @property
    def starts(self) -> int:
        """Tick before which it does not start."""
        return int(self.memory.item(path_tracking.STARTS))

    @starts.setter
    def starts(self, tick: int) -> None:
        self.memory[path_tracking.STARTS] = tick

    @property
    def walks_fast(self) -> bool:
        """Whether it may walk faster than usual here."""
        return self.path is not None and self.path.walks_fast(self.arc)

    def straight_before(self, arc: float) -> float:
        """Arc length [m] from which the path leads straight to ``arc`` [m]."""
        assert self.path is not None
        table, step = self.path.table, self.path.length / (len(self.path.table) - 1)
        end = min(max(int((arc - _AT_EDGE) / step), 0), len(table) - 1)
        bent = np.abs(table[: end + 1, path_table.HEADING] - table[end, path_table.HEADING]) > _STRAIGHT
        return step * (int(np.flatnonzero(bent)[-1]) + 1) if bent.any() else 0.0

    def track(
        self, gains: NDArray[np.float64], x: float, y: float, speed: float, tick: int, command: NDArray
    ) -> None:
        """One tick: see `path_tracking.track`."""
        assert self.path is not None
        track(self.path.table, self.path.length, gains, self.memory, x, y, speed, tick, command)

    def without_headway(self, tick: float) -> float:
        """[s] without progress."""
        return (tick - self.memory.item(path_tracking.HEADWAY_TICK)) * CONTROL_DT

    def wait(self) -> None:
        """Count a tick of giving way, which does not count as without progress."""
        self.excuse(1.0)
        self.memory[path_tracking.WAITED] += 1.0

    @property
    def waited(self) -> float:
        """[s] of giving way since its last progress."""
        return float(self.memory[path_tracking.WAITED]) * CONTROL_DT

    def excuse(self, ticks: float) -> None:
        """Exclude so many ticks from the time without progress."""
        self.memory[path_tracking.HEADWAY_TICK] += ticks

    def make_headway(self, tick: int) -> None:
        """Count the time without progress from this ``tick``."""
        self.memory[path_tracking.HEADWAY_TICK] = tick

    def go_on_from(self, place: NDArray[np.float64], tick: int) -> None:
        """A fall has moved it along the path: continue from the point nearest to ``place`` (3,)."""
        if self.path is not None:
            table = self.path.table
            nearest = int(np.argmin(np.linalg.norm(table[:, :3] - place, axis=1)))
            arc = nearest * self.path.length / (len(table) - 1)
            self.memory[[path_tracking.ARC, path_tracking.HEADWAY]] = arc
            self.make_headway(tick)

    def shift(self, shift: NDArray[np.float64], limits: TrackingLimits, walk: TrackingLimits | None) -> None:
        """Move the path, see `path_tracking.shifted`."""
        assert self.path is not None
        self.path = shifted(self.path, self.arc_length, shift, limits, walk)

    def go_back(self, to: float, walk: TrackingLimits, tick: int) -> None:
        """Turn round and walk back to arc length ``to`` [m]."""
        assert self.path is not None
        back = back_along(self.path, self.arc, to, walk)
        self.interrupted, self.back_to = self.path, to
        self._take(back, 0.0, tick)

    def way_back(self, to: float) -> NDArray[np.float64] | None:
        """(k, 3) [m] the points of its path, `SPACING` apart, from where it is back to arc length ``to`` [m];
        None if there are hardly any, it is already going back, or it has done so often enough."""
        often = self.memory[path_tracking.BACKED] >= len(_ROOM)
        if self.path is None or self.interrupted is not None or often or self.arc < to + _LEAST:
            return None
        arcs = np.arange(self.arc, to, -SPACING)
        known = np.linspace(0.0, self.path.length, len(self.path.table))
        return np.stack([np.interp(arcs, known, self.path.table[:, k]) for k in range(3)], axis=1)

    @property
    def backs(self) -> float:
        """[m] that it goes back at least, to let others pass."""
        return _ROOM[min(int(self.memory[path_tracking.BACKED]), len(_ROOM) - 1)]

    def make_room(self, far: float, walk: TrackingLimits, tick: int) -> None:
        """Go ``far`` [m] back, then forward again."""
        backed = self.memory[path_tracking.BACKED]
        self.go_back(max(self.arc - far, 0.0), walk, tick)
        self.memory[[path_tracking.BACKED, path_tracking.PACE]] = backed + 1.0, 1.0

    def turn_again(self, tick: int) -> None:
        """Having gone back, continue."""
        assert self.interrupted is not None
        path, self.interrupted = self.interrupted, None
        self._take(path, self.back_to, tick)

    def _take(self, path: PathTable, arc: float, tick: int) -> None:
        """Follow another path from arc length ``arc`` [m]."""
        pace, backed = self.memory[[path_tracking.PACE, path_tracking.BACKED]]
        self.path = path
        self.memory[:] = new_track()
        self.memory[[path_tracking.ARC, path_tracking.HEADWAY]] = arc
        self.memory[[path_tracking.HEADWAY_TICK, path_tracking.PACE]] = tick, pace
        self.memory[path_tracking.BACKED] = backed
        self.memory[path_tracking.REMAINING] = path.length - arc
