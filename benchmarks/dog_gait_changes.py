"""Row of `benchmarks.dog` about changes of gait: the trunk moves no more than at even speeds.

Animals of one body first move at even speeds, which gives the ranges of hip and shoulder heights, trunk tilt
and joint acceleration. Then others start, change speed between all pairs, change gait on command, and stop,
at all moments of the stride. They must stay within these ranges, bones above the ground, standing feet in
place.
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion import Ground
from locomotion.quadruped import Body, Herd, Trail, lay_trail, load_body
from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT

Array = NDArray[np.float64]

FOAL = Path(__file__).parent / "foal.yaml"
"""A body of another size, that nothing was tuned on."""
BODIES = ("dog", "cat", "horse", str(FOAL))
_SETTLED = 5.0  # [s] at an even speed before it is measured or changed
_MEASURED = 4.0  # [s]
_AFTER = 4.0  # [s] that are watched after a change, besides what the change of speed takes


@dataclass(frozen=True)
class Place:
    """Ground that rises by ``slope`` along x, and a path on it: straight, or a circle of ``radius``."""

    name: str
    slope: float = 0.0
    radius: float | None = None
    """In spine lengths."""

    def turn_radius(self, body: Body) -> float:
        """[m]; 0 for a straight path."""
        return 0.0 if self.radius is None else self.radius * body.spine.length

    def fastest(self, body: Body) -> float:
        """[m/s] that the path allows."""
        speed = body.top_speed
        if self.slope:
            speed = min(speed, 0.25 * math.sqrt(9.81 * body.rear_legs.height) / abs(self.slope))
        if self.radius is not None:
            speed = min(speed, math.sqrt(body.movement.sideways * self.radius * body.spine.length))
        return 0.97 * speed

    def ground(self, length: float) -> Ground:
        x, y = length + 20.0, length + 20.0
        corners = [(-x, -y, -x * self.slope), (x, -y, x * self.slope), (x, y, x * self.slope)]
        corners.append((-x, y, -x * self.slope))
        return Ground.from_arrays(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]))

    def points(self, body: Body, length: float) -> Array:
        if self.radius is None:
            return np.array([[0.0, 0.0, 0.0], [length, 0.0, self.slope * length]])
        radius = self.radius * body.spine.length
        turn = np.arange(0.0, length / radius, 0.05)
        return np.column_stack([radius * np.sin(turn), radius * (1.0 - np.cos(turn)), np.zeros(len(turn))])


PLACES = (
    Place("flat"), Place("uphill", 0.12), Place("downhill", -0.12), Place("steep uphill", 0.3),
    Place("steep downhill", -0.3), Place("curve", radius=6.0), Place("wide curve", radius=25.0),
)  # fmt: skip


class Watch:
    """What animals of one body do, tick by tick: least and greatest of heights of hips and shoulders over the
    ground [m] and of the trunk's pitch against it [rad], the lowest point of a bone [m], the farthest that a
    standing toe came from where it stood [m], the greatest speed of a joint [rad/s] and change of it."""

    def __init__(self, herd: Herd, slope: float) -> None:
        self.herd, self.slope = herd, slope
        body, n = herd.bodies[0], len(herd)
        front, rear = body.front_legs, body.rear_legs
        legs = [[each.upper, each.lower, each.foot] for each in (front, front, rear, rear)]
        bones, self.spine = body.spine.bones, body.spine.length
        self.lengths = np.array(
            [0.0, *[body.spine.bone_length] * bones, body.neck.length, body.head.length]
            + [body.tail.length / 3.0] * 3 + [bone for leg in legs for bone in leg]
        )  # fmt: skip
        self.low, self.high = np.full((n, 3), np.inf), np.full((n, 3), -np.inf)
        self.bone, self.slide = np.full(n, np.inf), np.zeros(n)
        self.speed, self.change = np.zeros(n), np.zeros(n)
        self._anchors = np.full((n, 4, 3), np.nan)
        self._joints: list[Array] = []

    def look(self, some: NDArray[np.bool_]) -> None:
        """Take in this tick of ``some`` (n,)."""
        herd, st = self.herd, self.herd.state
        now = np.column_stack([
            st[:, at.Z_REAR] - self.slope * st[:, at.X], st[:, at.Z_FRONT] - self.slope * st[:, at.FRONT_X],
            np.arcsin((st[:, at.Z_FRONT] - st[:, at.Z_REAR]) / self.spine)
            - np.arctan(self.slope) * np.cos(st[:, at.YAW]),
        ])  # fmt: skip
        self.low[some] = np.minimum(self.low, now)[some]
        self.high[some] = np.maximum(self.high, now)[some]
        poses = herd.poses.reshape(len(herd), -1, 7)
        w, x, y, z = np.moveaxis(poses[:, :, 3:], 2, 0)
        along = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=2)
        ends = poses[:, :, :3] + self.lengths[:, None] * along
        heights = np.minimum(
            poses[:, :, 2] - self.slope * poses[:, :, 0], ends[:, :, 2] - self.slope * ends[:, :, 0]
        )
        self.bone[some] = np.minimum(self.bone, heights.min(axis=1))[some]
        toes, stands = ends[:, -10::3], herd.feet[:, :, at.IN_SWING] == 0.0
        new = stands & np.isnan(self._anchors[:, :, 0])
        self._anchors[new] = toes[new]
        self._anchors[~stands] = np.nan
        off = np.nan_to_num(np.linalg.norm(toes - self._anchors, axis=2)).max(axis=1)
        self.slide[some] = np.maximum(self.slide, off)[some]
        self._joints = [*self._joints[-2:], herd.joints.copy()]
        if len(self._joints) == 3:
            a, b, c = self._joints
            first, second = _turned(a, b), _turned(b, c)
            self.speed[some] = np.maximum(self.speed, np.abs(second).max(axis=1))[some]
            self.change[some] = np.maximum(self.change, np.abs(second - first).max(axis=1))[some]


def _turned(a: Array, b: Array) -> Array:
    """[rad/s]"""
    return ((b - a + math.pi) % (2.0 * math.pi) - math.pi) / DT


@dataclass(frozen=True)
class Task:
    """At ``first`` [m/s] in ``gait``, then at ``then`` in ``gait_then`` (None: by speed); 0: it stands."""

    first: float
    then: float
    gait: str | None = None
    gait_then: str | None = None


def tasks_for(body: Body, fastest: float, quick: bool) -> list[Task]:
    """Starts and stops over a fine sweep, every pair of a coarse one, every pair of gaits at some speeds."""
    fine = np.linspace(0.1, 1.0, 12 if quick else 60) * fastest
    coarse = np.linspace(0.08, 1.0, 6 if quick else 14) * fastest
    tasks = [Task(0.0, v) for v in fine] + [Task(v, 0.0) for v in fine]
    tasks += [Task(a, b) for a in coarse for b in coarse if a != b]
    steps = [each.up_to for each in body.gaits.values() if not each.on_request and each.up_to < fastest]
    for step in steps:  # just over and under each change, to and fro
        for by in (0.03, 0.1, 0.2):
            tasks += [Task(step * (1 - by), step * (1 + by)), Task(step * (1 + by), step * (1 - by))]
    for a in body.gaits:
        for b in body.gaits:
            top = min(body.gaits[a].up_to, body.gaits[b].up_to, fastest)
            tasks += [Task(v, v, a, b) for v in np.linspace(0.4, 1.0, 2 if quick else 5) * top if a != b]
    return tasks


def _trail(body: Body, place: Place, length: float, ground: Ground) -> Trail:
    return lay_trail(place.points(body, length), body, ground)


def steady(body: Body, place: Place, speeds: Array, gaits: list[str | None]):
    """Animals at even speeds, each of ``speeds`` in each of ``gaits`` that goes so fast (None: by speed):
    what they do, the speed and the gait of each, heights and pitch of one that stands."""
    runs = [(v, g) for g in gaits for v in speeds if g is None or v <= body.gaits[g].up_to]
    time = speeds.max() / body.movement.acceleration + 2.0 + _SETTLED + _MEASURED
    length = speeds.max() * time + 5.0
    ground = place.ground(length if place.radius is None else 2.2 * place.turn_radius(body))
    trail, herd = _trail(body, place, length, ground), Herd(ground)
    for speed, gait in runs:
        herd.add(body, trail.points[0], trail.heading(0.0))
        herd.follow(len(herd) - 1, trail, speed, gait=gait)
    watch = Watch(herd, place.slope)
    everybody = np.ones(len(herd), bool)
    watch.look(everybody)
    standing = watch.low[0].copy()
    watch = Watch(herd, place.slope)
    for tick in range(round(time / DT)):
        herd.tick()
        if tick * DT >= time - _MEASURED:
            watch.look(everybody)
    return watch, np.array([v for v, _ in runs]), [g for _, g in runs], standing


def change(body: Body, place: Place, tasks: list[Task], seed: int) -> Watch:
    """Animals that do ``tasks``, each at a moment of the stride of its own."""
    rng = np.random.default_rng(seed)
    top = max(max(task.first, task.then) for task in tasks)
    ramp = top / min(body.movement.acceleration, body.movement.braking) + 2.0
    time = 2.0 * ramp + _SETTLED + _AFTER + 2.0
    length = top * time + 5.0
    ground = place.ground(length if place.radius is None else 2.2 * place.turn_radius(body))
    trail, herd = _trail(body, place, length, ground), Herd(ground)
    begins = np.round((ramp + _SETTLED + rng.uniform(0.0, 2.0, len(tasks))) / DT).astype(int)
    for k, task in enumerate(tasks):
        herd.add(body, trail.points[0], trail.heading(0.0))
        if task.first == 0.0:
            begins[k] = round(rng.uniform(0.0, 2.0) / DT)
        else:
            herd.follow(k, trail, task.first, gait=task.gait)
    watch = Watch(herd, place.slope)
    for tick in range(round(time / DT)):
        for k in np.flatnonzero(begins == tick).tolist():
            if tasks[k].then == 0.0:
                herd.stop(k)
            else:
                arc = float(herd.state[k, at.ARC])
                herd.follow(k, trail, tasks[k].then, start=arc, gait=tasks[k].gait_then)
        herd.tick()
        watch.look((tick >= begins) & (tick < begins + round((ramp + _AFTER) / DT)))
    return watch


def compare(body: Body, place: Place, quick: bool, seed: int = 0) -> dict[str, Any]:
    """What changes do against what even speeds do: each against the range of all speeds between its two."""
    fastest = place.fastest(body)
    speeds = np.linspace(0.05, 1.0, 20 if quick else 80) * fastest
    even, at_speed, in_gait, standing = steady(body, place, speeds, [None, *body.gaits])
    tasks = tasks_for(body, fastest, quick)
    watch = change(body, place, tasks, seed)
    height = np.array([body.rear_legs.height, body.front_legs.height])
    off = np.zeros((len(tasks), 3))
    for k, task in enumerate(tasks):
        low, high = sorted((task.first, task.then))
        step = speeds[1] - speeds[0]
        own = (at_speed >= low - step) & (at_speed <= high + step)
        own &= np.array([gait in (task.gait, task.gait_then) for gait in in_gait])
        least, most = even.low[own].min(axis=0), even.high[own].max(axis=0)
        if low == 0.0:
            least, most = np.minimum(least, standing), np.maximum(most, standing)
        off[k] = np.maximum(least - watch.low[k], watch.high[k] - most).clip(min=0.0)
    share = (off[:, :2] / height).max(axis=1)
    worst = int(np.argmax(share))
    return {
        "tasks": len(tasks), "slope": place.slope,
        "height_off": float(share[worst]), "height_off_p95": float(np.percentile(share, 95)),
        "worst_task": repr(tasks[worst]),
        "pitch_off_deg": math.degrees(off[:, 2].max()),
        "pitch_off_p95_deg": math.degrees(float(np.percentile(off[:, 2], 95))),
        "lowest_bone": float(watch.bone.min()), "slide": float(watch.slide.max()),
        "joint_change": float(watch.change.max()), "joint_change_steady": float(even.change.max()),
        "joint_speed": float(watch.speed.max()), "joint_speed_steady": float(even.speed.max()),
        "steady_hips": (float(even.low[:, 0].min()), float(even.high[:, 0].max())),
        "steady_shoulders": (float(even.low[:, 1].min()), float(even.high[:, 1].max())),
        "steady_pitch_deg": (math.degrees(even.low[:, 2].min()), math.degrees(even.high[:, 2].max())),
    }  # fmt: skip


def gait_changes(quick: bool) -> dict[str, Any]:
    """Every body on every ground; how fast joints speed up is compared with the body's steady gaits on the
    flat, where it goes fastest."""
    found: dict[str, Any] = {}
    for name in BODIES:
        body = load_body(name)
        rows = {f"{body.name} {place.name}": compare(body, place, quick) for place in PLACES}
        usual = rows[f"{body.name} flat"]["joint_change_steady"]
        found |= {key: row | {"joint_change_usual": usual} for key, row in rows.items()}
    return found
