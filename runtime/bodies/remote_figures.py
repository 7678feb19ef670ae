"""Figures that other simulators move: drawn where dead reckoning has them, and in everybody's way.

`runtime.dis` tells what their simulators say (`RemoteFigures.tell`). Between that they go on by dead
reckoning, each tick, all in one table. A correction moves no figure at once (`runtime.dis.smoothing`).
"""

import hashlib
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from locomotion.avoidance.yielding import COUNT, STEP, Course
from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Event
from locomotion.postures.playback import Playback
from locomotion.saved_arrays import check_array
from runtime.bodies import remote_poses
from runtime.bodies.pose import between
from runtime.bodies.protocol import Driver, Follower, Population
from runtime.bodies.remote_looks import Look, look_of
from runtime.dis.dead_reckoning import ROTATES, Motion, reckoned, velocities
from runtime.dis.smoothing import advanced, rate_for
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import Plan

__all__ = ["REMOTE", "RemoteDriver", "RemoteFigures", "RemoteState", "told_state"]

REMOTE = np.dtype(
    [
        ("algorithm", "f8"), ("position", "f8", 3), ("rotation", "f8", (3, 3)), ("velocity", "f8", 3),
        ("acceleration", "f8", 3), ("turning", "f8", 3), ("since_told", "f8"), ("since_heard", "f8"),
        ("time", "f8"), ("offset", "f8", 2), ("offset_speed", "f8", 2), ("offset_rate", "f8"),
        ("turn", "f8", 1), ("turn_speed", "f8", 1), ("turn_rate", "f8"),
        ("place", "f8", 3), ("moving", "f8", 2), ("heading", "f8"),
        ("on_ground", "f8"), ("crawling", "f8"), ("fatal", "f8"), ("told_gait", "f8"),
        ("moves", "f8"), ("told_run", "f8"), ("posture", "f8"), ("asked", "f8"), ("rests", "f8"),
        ("at", "f8"), ("stride", "f8"), ("phase", "f8"), ("pace", "f8"), ("pace_speed", "f8"),
        ("runs", "f8"), ("runs_speed", "f8"),
        ("crawls", "f8"), ("crawls_speed", "f8"), ("by_graph", "f8"), ("by_graph_speed", "f8"),
    ]
)  # fmt: skip
"""A figure. What was told, in the level's frame: ``algorithm`` to ``turning`` as in `Motion`. [s] since then,
since it was heard of, and since it came. ``offset`` [m] and ``turn`` [rad] that it is drawn off by.
``place`` [m], ``moving`` [m/s] and ``heading`` [rad] as drawn. Flags: whether it goes on the ground, crawls,
is dead; ``told_gait``: 1 runs, -1 walks, 0 neither; ``posture``: told, as a number of the posture graph;
``stride`` [m]: of an animal. The rest is of `remote_poses`."""
WIDTH = REMOTE.itemsize // 8
LONGEST = 12.0
"""[s] after which a figure that nothing is heard of stands still: the time-out of DIS."""
TELEPORT = 10.0
"""[m] of a correction from which a figure is put where it is told to be, and does not go there."""
_FASTEST, _FASTEST_TURN = 3.0, 4.0  # [m/s], [rad/s] of corrections
_UP, _DOWN = 1.0, 2.5  # [m] above and below what is told within which our ground is looked for
_LIFT, _LIFT_RATE = 1.2, 30.0  # [m/s] at most, [1/s]: how it is brought up and down to the ground


@dataclass(frozen=True)
class RemoteState:
    """What is kept of a figure. ``look``: "human", an animal, or "thing"; ``marking``: what its simulator
    wrote on it; ``row``: (`WIDTH`,) float64 as `REMOTE`; ``playback``: None if it has just come."""

    look: str
    marking: str
    row: np.ndarray
    playback: Playback | None = None


def told_state(look: str, marking: str, motion: Motion, age: float, on_ground: bool = True) -> RemoteState:
    """A figure that comes in: ``motion`` of one entity is what was told ``age`` [s] ago."""
    row = np.zeros(WIDTH)
    _put_motion(row.view(REMOTE), motion, age)
    row.view(REMOTE)["on_ground"], row.view(REMOTE)["rests"] = on_ground, 1.0
    row.view(REMOTE)["stride"] = look_of(look).stride
    for name in ("posture", "asked", "at"):
        row.view(REMOTE)[name] = remote_poses.posture_number(remote_poses.STANDS)
    return RemoteState(look, marking, row)


def _put_motion(rows: np.ndarray, motion: Motion, age: float | np.ndarray) -> None:
    for name in ("algorithm", "position", "rotation", "velocity", "acceleration", "turning"):
        rows[name] = getattr(motion, name)
    rows["since_told"], rows["since_heard"] = age, 0.0


class RemoteFigures(Population):
    """All figures of other simulators in a world."""

    def __init__(self, level: Level) -> None:
        self._level = level
        self.rows = np.zeros(0, REMOTE)
        self.drivers: list[RemoteDriver] = []
        self._poses: dict[int, np.ndarray] | None = None
        self._before: dict[int, np.ndarray] = {}

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        raise RuntimeInputError("remote figures come in from other simulators; they are not spawned")

    def revive(self, body: str, state: Any) -> Driver:
        driver = RemoteDriver(self, _checked(state))
        self.rows = np.concatenate([self.rows, np.zeros(1, REMOTE)])
        self.drivers.append(driver)
        driver.restore(state)
        if state.playback is None:  # it has just come
            self._place(driver.index)
        return driver

    def remove(self, driver: Driver) -> None:
        assert isinstance(driver, RemoteDriver)
        self.rows = np.delete(self.rows, driver.index)
        del self.drivers[driver.index]
        for later in self.drivers[driver.index :]:
            later.index -= 1
        self.forget()

    def _place(self, index: int) -> None:
        """Put a figure where it was told to be."""
        row = self.rows[index : index + 1]
        row["offset"] = row["offset_speed"] = 0.0
        row["turn"] = row["turn_speed"] = 0.0
        row["offset_rate"] = row["turn_rate"] = 1.0
        places, rotation, velocity = self._reckoned(row)
        row["place"], row["moving"] = places, velocity[:, :2]
        row["heading"] = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
        floor = self._floors(row, places)
        row["place"][:, 2] = floor
        row["pace"] = np.linalg.norm(velocity[:, :2], axis=1)
        row["told_run"] = row["runs"] = remote_poses.runs_now(row, row["told_gait"])
        self.forget()

    def _reckoned(self, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, rotations and velocities by dead reckoning."""
        motion = Motion(
            rows["algorithm"].astype(np.int64), rows["position"], rows["rotation"], rows["velocity"],
            rows["acceleration"], rows["turning"],
        )  # fmt: skip
        seconds = np.minimum(rows["since_told"], LONGEST)
        places, rotations = reckoned(motion, seconds)
        speeds = velocities(motion, seconds, rotations)
        speeds[rows["since_told"] >= LONGEST] = 0.0
        return places, rotations, speeds

    def _floors(self, rows: np.ndarray, places: np.ndarray) -> np.ndarray:
        """(n,) heights [m] of our ground under ``places`` (n, 3), or theirs where there is none near."""
        probes = np.column_stack([rows["place"][:, :2], places[:, 2] + _UP])
        floor = self._level.ground.surface_below(probes)[0]
        near = (rows["on_ground"] > 0.0) & (floor > places[:, 2] - _DOWN)  # NaN is not
        return np.where(near, floor, places[:, 2])

    def tell(self, indices: np.ndarray, motion: Motion, ages: np.ndarray, teleports: np.ndarray) -> None:
        """Figures are somewhere else than was reckoned: ``motion`` of ``indices`` (k,), told ``ages`` (k,)
        [s] ago; ``teleports`` (k,) bool: who is put there."""
        rows = self.rows[indices]
        spin = self._spin(rows) + rows["turn_speed"][:, 0]
        _put_motion(rows, motion, ages)
        places, rotation, velocity = self._reckoned(rows)
        offset = rows["place"][:, :2] - places[:, :2]
        turn = rows["heading"] - np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
        turn = ((turn + np.pi) % (2.0 * np.pi) - np.pi)[:, None]
        rows["offset"], rows["offset_speed"] = offset, rows["moving"] - velocity[:, :2]
        rows["offset_rate"] = rate_for(offset, _FASTEST)
        rows["turn"], rows["turn_speed"] = turn, (spin - self._spin(rows))[:, None]
        rows["turn_rate"] = rate_for(turn, _FASTEST_TURN)
        self.rows[indices] = rows
        far = np.linalg.norm(offset, axis=1) > TELEPORT
        for index in indices[teleports | far].tolist():
            self._place(index)

    @staticmethod
    def _spin(rows: np.ndarray) -> np.ndarray:
        """(n,) [rad/s] at which headings turn by dead reckoning; body axes point down."""
        rotates = ROTATES[rows["algorithm"].astype(np.int64)] & (rows["since_told"] < LONGEST)
        return np.where(rotates, -rows["turning"][:, 2], 0.0)

    def heard(self, driver: "RemoteDriver") -> None:
        """There is a sign of life of a figure, and nothing new."""
        self.rows["since_heard"][driver.index] = 0.0

    def tick(self) -> None:
        rows = self.rows
        if not len(rows):
            return
        for name in ("since_told", "since_heard", "time"):
            rows[name] += CONTROL_DT
        places, rotation, velocity = self._reckoned(rows)
        for name in ("offset", "turn"):
            rows[name], rows[f"{name}_speed"] = advanced(
                rows[name], rows[f"{name}_speed"], rows[f"{name}_rate"], CONTROL_DT
            )
        rows["place"][:, :2] = places[:, :2] + rows["offset"]
        rows["moving"] = velocity[:, :2] + rows["offset_speed"]
        rows["heading"] = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0]) + rows["turn"][:, 0]
        lift = self._floors(rows, places) - rows["place"][:, 2]
        share = 1.0 - np.exp(-_LIFT_RATE * CONTROL_DT)
        rows["place"][:, 2] += np.clip(share * lift, -_LIFT * CONTROL_DT, _LIFT * CONTROL_DT)
        self._advance_people()
        self._poses = None

    def _advance_people(self) -> None:
        rows = self.rows
        rows["moves"] = remote_poses.moves_now(rows, rows["moves"] > 0.0)
        rows["told_run"] = remote_poses.runs_now(rows, rows["told_gait"])
        wanted = remote_poses.wanted_postures(rows)
        for index in np.flatnonzero((wanted != rows["asked"]) | (rows["rests"] == 0.0)).tolist():
            self.drivers[index].ask(float(wanted[index]))
        remote_poses.advance_poses(rows, CONTROL_DT)

    def poses(self) -> dict[int, np.ndarray]:
        """By index, (b, 7) where the bodies of each figure are; made once a tick."""
        if self._poses is None:
            people = [k for k, driver in enumerate(self.drivers) if driver.look.is_person]
            playbacks = [self.drivers[k].playback for k in people]
            made = remote_poses.figures_at(self.rows[people], playbacks) if people else []
            self._poses = dict(zip(people, made, strict=True))
            for k, driver in enumerate(self.drivers):
                if not driver.look.is_person:
                    self._poses[k] = driver.look.posed(self.rows[k])
        return self._poses

    def remember(self) -> None:
        self._before = dict(self.poses())

    def forget(self) -> None:
        """Draw all where they are now."""
        self._poses, self._before = None, {}

    def before(self, index: int) -> np.ndarray | None:
        """The bodies of a figure when `remember` was called."""
        return self._before.get(index)

    def in_the_way(self) -> np.ndarray:
        radii = [driver.radius for driver in self.drivers]
        return (
            np.column_stack([self.rows["place"], self.rows["moving"], radii]) if radii else np.zeros((0, 6))
        )

    def followers(self) -> Sequence[Follower]:
        return self.drivers

    def change_level(self) -> None:
        self.forget()


class RemoteDriver(Driver):
    """A figure that another simulator moves. As a follower it gives way to nobody; others foresee it going on
    as it moves."""

    comes_from_elsewhere = True
    pace, reach, backs, length = 1.0, 0.0, 0.0, 0.0
    waited = None

    def __init__(self, population: RemoteFigures, state: RemoteState) -> None:
        self._population, self.index = population, len(population.drivers)
        self.look: Look = look_of(state.look)
        self.marking = state.marking
        self.radius, self.figure = self.look.radius, self.look.figure
        self.events: list[Event] = []
        self.plans: deque[Plan] = deque()
        self.playback = state.playback or remote_poses.resting()

    @property
    def population(self) -> RemoteFigures:
        """All figures that it is one of."""
        return self._population

    @property
    def row(self) -> np.ndarray:
        """(1,) of `REMOTE`; a view."""
        return self._population.rows[self.index : self.index + 1]

    @property
    def posture(self) -> str:
        """The one that was told, of those of the posture graph."""
        return remote_poses.posture_name(self.row["posture"][0])

    @posture.setter
    def posture(self, posture: str) -> None:
        self.row["posture"] = remote_poses.posture_number(posture)

    def ask(self, wanted: float) -> None:
        """Go on to a posture, by its number in the graph."""
        row = self.row
        self.playback = remote_poses.asked(self.playback, wanted, float(row["time"][0]))
        row["asked"], row["at"] = wanted, self.playback.posture
        row["rests"] = self.playback.arc < 0 and self.playback.last is None

    @property
    def simulated(self) -> "RemoteDriver":
        return self

    @property
    def follower(self) -> Follower:
        return self

    @property
    def time(self) -> float:
        return float(self.row["time"][0])

    @property
    def status(self) -> str:
        return "remote"

    @property
    def position(self) -> np.ndarray:
        return self.row["place"][0].copy()

    @property
    def velocity(self) -> np.ndarray:
        """(2,) float64 [m/s] at which it is drawn to move."""
        return self.row["moving"][0].copy()

    @property
    def facing(self) -> float:
        heading = float(self.row["heading"][0])
        return (heading + np.pi) % (2.0 * np.pi) - np.pi

    @property
    def left(self) -> float:
        return 0.0

    def transforms(self) -> np.ndarray:
        return self._population.poses()[self.index].copy()

    def transforms_between(self, share: float) -> np.ndarray:
        before = self._population.before(self.index)
        return self.transforms() if before is None else between(before, self.transforms(), share)

    def plan(self, goals: np.ndarray) -> Plan:
        raise RuntimeInputError("it is moved by another simulator and takes no orders")

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        return self.plan(goals)

    @property
    def goals_left(self) -> int:
        return 0

    def way_holds(self) -> bool:
        return True

    def stop(self) -> None:
        """Nothing: another simulator moves it."""

    def course(self) -> Course | None:
        return None

    def foretold(self) -> np.ndarray:
        moments = STEP * np.arange(COUNT)[:, None, None]
        return self.row["place"][None, :, :2] + moments * self.row["moving"][None]

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        """Nothing, as `stop`."""

    def way_back(self) -> np.ndarray | None:
        return None

    def make_room(self, far: float) -> None:
        """Nothing, as `stop`."""

    def give_up(self, reason: str | None = None) -> None:
        """Nothing, as `stop`."""

    def end_in(self, ahead: float) -> None:
        """Nothing, as `stop`."""

    def save(self) -> RemoteState:
        row = self.row.view("f8").copy()
        return RemoteState(self.look.name, self.marking, row, self.playback)

    def restore(self, state: Any) -> None:
        saved = _checked(state)
        if saved.look != self.look.name:
            raise RuntimeInputError(f"a {saved.look!r} is saved, this is a {self.look.name!r}")
        self._population.rows[self.index] = saved.row.view(REMOTE)[0]
        self.marking, self.playback = saved.marking, saved.playback or remote_poses.resting()
        self._population.forget()

    def state_hash(self) -> str:
        saved = replace(self.save(), row=np.zeros(0), playback=None)
        return hashlib.sha256(repr(saved).encode() + self.row.tobytes()).hexdigest()


def _checked(state: Any) -> RemoteState:
    """``state``, if a figure can be in it."""
    if not isinstance(state, RemoteState):
        raise RuntimeInputError("no remote figure is saved")
    check_array("a remote figure", state.row, WIDTH)
    if not 0 <= state.row.view(REMOTE)["algorithm"][0] <= 9:
        raise RuntimeInputError("a remote figure is reckoned by a model that is not there")
    look_of(state.look)
    row = state.row.view(REMOTE)[0]
    remote_poses.check(float(row["posture"]), float(row["asked"]), state.playback)
    return state
