"""Many quadrupeds in flat arrays; one call advances all of them.

    herd = Herd(ground)
    rex = herd.add(load_body("dog"), (0.0, 0.0, 0.0), yaw=0.0)
    herd.follow(rex, lay_trail(points, herd.bodies[rex], ground), speed=1.5)
    while not herd.resting(rex):
        herd.tick()

A herd plays motions: trails and scripts. `locomotion.quadruped.animal` chooses the motions that lead to a
goal.
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.avoidance.yielding import COUNT
from locomotion.errors import LocomotionError
from locomotion.ground.ground import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped.advance import advance_all
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import root_behind, wanted_pose, wrap
from locomotion.quadruped.idle import habits
from locomotion.quadruped.motion import DT, begin_stop, stop_length
from locomotion.quadruped.pool import Pool
from locomotion.quadruped.pose import body_names, count_bodies, write_pose
from locomotion.quadruped.predicted_discs import (
    DISCS,
    between_feet,
    cover_with_discs,
    disc_radius,
    foretell_motion,
)
from locomotion.quadruped.script import Place, Script
from locomotion.quadruped.tail import hang_tail
from locomotion.quadruped.trail import Trail, kernel_ground

__all__ = ["AnimalState", "Herd"]

RING = 512
"""Number of crumbs kept: about 50 m of the way."""
_CHANGE = 0.01  # [m] by which ground may change without effect
_DROP = 0.5  # [m] off the ground that an animal may be placed


@dataclass(frozen=True)
class AnimalState:
    """Everything that a herd stores of one animal; ``body``: name of its kind."""

    body: str
    row: NDArray[np.float64]
    feet: NDArray[np.float64]
    crumbs: NDArray[np.float64]
    table: NDArray[np.float64]


class Herd:
    """Quadrupeds on one ground. ``bodies``: kind of each animal; animals are addressed by index."""

    def __init__(self, ground: Ground) -> None:
        self.ground = ground
        self.bodies: list[Body] = []
        self.state = np.zeros((0, at.STATE))
        self.feet = np.zeros((0, 4, at.FOOT))
        self.crumbs = np.zeros((0, RING, 3))
        self.joints = np.zeros((0, at.JOINTS))
        self.poses = np.zeros((0, 7))
        self.pose_start = np.zeros(1, np.int64)
        self._disc_radii = np.zeros(0)
        self._kinds: list[Body] = []
        self._params = np.zeros((0, at.PARAMS))
        self._gaits = np.zeros((0, 1, at.GAIT))
        self._pool = Pool(at.ROW)

    def __len__(self) -> int:
        return len(self.bodies)

    # --- animals
    def add(self, body: Body, position: ArrayLike, yaw: float, seed: int = 0) -> int:
        """Put an animal with its rear feet at ``position`` (3,) [m], facing ``yaw`` [rad]; returns its index.
        ``seed``: with another one it has other habits and begins its stride elsewhere.

        Raises `LocomotionError` for numbers that are not finite or a place more than 0.5 m off the ground.
        """
        place = self._checked(position, yaw)
        index = self._grow(body)
        self.reset(index, place, yaw, seed)
        return index

    def adopt(self, body: Body, saved: AnimalState) -> int:
        """Add an animal in a saved state; returns its index."""
        index = self._grow(body)
        self.restore(index, saved)
        return index

    def remove(self, index: int) -> None:
        """Remove an animal; the indices of those after it decrease by one."""
        first, last = self.pose_start[index : index + 2]
        del self.bodies[index]
        self._disc_radii = np.delete(self._disc_radii, index)
        self.state, self.feet, self.crumbs, self.joints = (
            np.delete(each, index, axis=0) for each in (self.state, self.feet, self.crumbs, self.joints)
        )
        self.poses = np.delete(self.poses, slice(first, last), axis=0)
        self.pose_start = np.delete(self.pose_start, index + 1)
        self.pose_start[index + 1 :] -= last - first
        self._pool.remove(index)

    def _grow(self, body: Body) -> int:
        """Make room for one more animal; returns its index."""
        index = len(self.bodies)
        self.bodies.append(body)
        self._disc_radii = np.append(self._disc_radii, disc_radius(body))
        kind = self._kind(body)
        count = count_bodies(body.spine.bones)
        self.state = np.vstack([self.state, np.zeros(at.STATE)])
        self.feet = np.concatenate([self.feet, np.zeros((1, 4, at.FOOT))])
        self.crumbs = np.concatenate([self.crumbs, np.zeros((1, RING, 3))])
        self.joints = np.vstack([self.joints, np.zeros(at.JOINTS)])
        self.poses = np.vstack([self.poses, np.zeros((count, 7))])
        self.pose_start = np.append(self.pose_start, self.pose_start[-1] + count)
        self.state[index, at.KIND] = kind
        return index

    def reset(self, index: int, position: ArrayLike, yaw: float, seed: int = 0) -> None:
        """Place an animal anew, standing; its motion and crumbs are dropped. Raises as `add` does."""
        place = self._checked(position, yaw)
        body, st = self.bodies[index], self.state[index]
        kind = st[at.KIND]
        st[:] = 0.0
        st[at.KIND], st[at.WAY], st[at.REST], st[at.FIRST_TICK], st[at.PACE] = kind, 1.0, 1.0, 1.0, 1.0
        st[at.X], st[at.Y], st[at.YAW], st[at.HEIGHT] = place[0], place[1], yaw, place[2]
        st[at.GAIT_WISH], st[at.LOOK_X], st[at.LOOK_Y] = -1.0, math.nan, math.nan
        gait = self._gaits[int(kind), 0]
        st[at.FREQUENCY_NOW] = body.movement.step_frequency
        st[at.DUTY_FRONT_NOW] = st[at.DUTY_REAR_NOW] = st[at.STANDS_FRONT] = st[at.STANDS_REAR] = 0.6
        st[at.LIFT_NOW] = gait[at.LIFT]
        st[at.TOUCHDOWN_NOW : at.TOUCHDOWN_NOW + 4] = gait[at.TOUCHDOWN : at.TOUCHDOWN + 4]
        st[at.HABITS : at.HABITS + 4] = habits(seed, place, yaw)
        st[at.CLOCK], st[at.BREATH], st[at.CHORD] = st[at.HABITS], st[at.HABITS + 1], 1.0
        x, y, z = place.tolist()
        st[at.FRONT_X], st[at.FRONT_Y] = Place(x, y, z, yaw).front(body)
        st[at.CHEST] = yaw
        self._stand(index)

    def _stand(self, index: int) -> None:
        """Put the feet in place on the ground, and the trunk over them."""
        body, st, feet = self.bodies[index], self.state[index], self.feet[index]
        feet[:] = 0.0
        left = np.array([-math.sin(st[at.YAW]), math.cos(st[at.YAW])])
        for leg in range(4):
            legs = body.front_legs if leg < 2 else body.rear_legs
            middle = st[[at.FRONT_X, at.FRONT_Y]] if leg < 2 else st[[at.X, at.Y]]
            spot = middle + (0.5 if leg % 2 == 0 else -0.5) * legs.track * left
            feet[leg, at.FX : at.FZ + 1] = *spot, self.ground_near([*spot, st[at.HEIGHT]], body)
            feet[leg, at.TO : at.TO + 3] = feet[leg, at.FX : at.FZ + 1]
            feet[leg, at.BASE] = feet[leg, at.FZ]
        feet[:, at.STANCE], feet[:, at.TEMPO] = st[at.DUTY_FRONT_NOW], 1.0
        st[at.GROUND_FRONT], st[at.GROUND_REAR] = feet[:2, at.FZ].mean(), feet[2:, at.FZ].mean()
        st[at.Z_FRONT] = st[at.CARRIED_FRONT] = st[at.GROUND_FRONT] + body.front_legs.height
        st[at.Z_REAR] = st[at.CARRIED_REAR] = st[at.GROUND_REAR] + body.rear_legs.height
        st[at.PITCH] = math.asin(np.clip((st[at.Z_FRONT] - st[at.Z_REAR]) / body.spine.length, -0.75, 0.75))
        st[at.SLOPE] = (st[at.GROUND_FRONT] - st[at.GROUND_REAR]) / body.spine.length
        hang_tail(st, self._params[int(st[at.KIND])])
        self._write_pose(index)

    def _write_pose(self, index: int) -> None:
        st = self.state[index]
        own = self.poses[self.pose_start[index] : self.pose_start[index + 1]]
        write_pose(st, self._params[int(st[at.KIND])], self.feet[index], own, self.joints[index])

    def _kind(self, body: Body) -> int:
        """Row of a body in params, added if it is new."""
        if body not in self._kinds:
            self._kinds.append(body)
            self._params = np.stack([each.params() for each in self._kinds])
            most = max(len(each.gaits) for each in self._kinds)
            self._gaits = np.zeros((len(self._kinds), most, at.GAIT))
            for k, each in enumerate(self._kinds):
                self._gaits[k, : len(each.gaits)] = each.gait_rows()
        return self._kinds.index(body)

    def _checked(self, position: ArrayLike, yaw: float) -> NDArray[np.float64]:
        place = np.asarray(position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all() or not math.isfinite(yaw):
            raise LocomotionError(f"position and yaw must be finite (3,) and (), not {position} and {yaw}")
        z = float(self.ground.surface_below([[place[0], place[1], place[2] + _DROP]])[0][0])
        if not abs(z - place[2]) <= _DROP:
            raise LocomotionError(f"there is no ground within {_DROP:g} m of {place.round(2).tolist()}")
        return np.array([place[0], place[1], z])

    def ground_near(self, point: ArrayLike, body: Body) -> float:
        """Height [m] of the ground near ``point`` (3,) as a foot finds it; the point's z if there is none."""
        x, y, z = np.asarray(point, dtype=np.float64)
        reach = body.movement.step + 0.12
        found = float(self.ground.surface_below([[x, y, z + reach]])[0][0])
        return found if found >= z - reach else float(z)

    # --- motions
    def follow(
        self, index: int, trail: Trail, speed: float, *, start: float = 0.0, end: float | None = None,
        backwards: bool = False, gait: str | None = None,
    ) -> None:  # fmt: skip
        """Follow a trail with the root, from arc length ``start`` [m] until it stops at ``end`` [m], by
        default where the front feet reach the trail's end. ``backwards``: rear first, towards a smaller
        arc length. ``gait``: a name, which also limits the speed; None: chosen by speed. A moving animal
        keeps its speed.

        Raises `LocomotionError` for a speed that is not above 0, an unknown gait, or an end before the start.
        """
        if not (math.isfinite(speed) and speed > 0.0):
            raise LocomotionError(f"speed must be a finite number above 0 m/s, not {speed}")
        body, st = self.bodies[index], self.state[index]
        wish = body.gait_index(gait)
        end = self.last_arc(index, trail) if end is None else end
        way = -1.0 if backwards else 1.0
        if not way * (end - start) >= 0.0:
            raise LocomotionError(f"a trail cannot be followed from {start:g} to {end:g} m in that direction")
        keeps = st[at.MODE] == at.ON_TRAIL and st[at.WAY] == way
        pace = (st[at.SPEED], st[at.PUSH]) if keeps else (0.0, 0.0)
        self._begin(index, at.ON_TRAIL, trail.rows, trail.step)
        st[at.ARC], st[at.ARC_END], st[at.WAY] = start, end, way
        st[at.FRONT_ARC] = start + body.spine.length
        st[at.SPEED], st[at.PUSH] = pace
        fastest = body.top_speed if gait is None else body.gaits[gait].up_to
        st[at.WISH], st[at.GAIT_WISH], st[at.STOPPING] = min(speed, fastest), wish, 0.0
        left = way * (end - start)
        if left <= stop_length(st[at.SPEED], body.movement.braking):
            begin_stop(st, left)
        self._blend(index)

    def play(self, index: int, script: Script) -> None:
        """Play a script. The animal should be at rest."""
        st = self.state[index]
        self._begin(index, at.SCRIPTED, script.rows, 1.0 / (len(script.rows) - 1))
        st[at.SCRIPT_TIME], st[at.SCRIPT_LENGTH], st[at.SPEED] = 0.0, script.seconds, 0.0
        self._blend(index)

    def stop(self, index: int) -> None:
        """Stop on the trail as soon as the body can."""
        st = self.state[index]
        if st[at.MODE] == at.ON_TRAIL and st[at.STOPPING] == 0.0:
            left = stop_length(st[at.SPEED], self.bodies[index].movement.braking)
            st[at.ARC_END] = st[at.ARC] + st[at.WAY] * left
            begin_stop(st, left)

    def look_at(self, index: int, point: ArrayLike | None) -> None:
        """Turn the head to ``point`` (2,) or (3,) [m] from now on; None: where the animal goes."""
        st = self.state[index]
        st[at.FIXED_LOOK] = 0.0 if point is None else 1.0
        if point is not None:
            st[at.LOOK_X], st[at.LOOK_Y] = np.asarray(point, dtype=np.float64)[:2]

    def last_arc(self, index: int, trail: Trail) -> float:
        """[m] where the root is when the front feet's midpoint is at the trail's end."""
        body = self.bodies[index]
        pitch = float(self.state[index, at.PITCH]) if trail.length < 1.0 else _end_pitch(trail, body)
        pr = self._params[int(self.state[index, at.KIND])]
        return root_behind(trail.rows, trail.step, pr, pitch)

    def _begin(self, index: int, mode: float, rows: NDArray[np.float64], step: float) -> None:
        st = self.state[index]
        if self._pool.put(index, rows):
            for other in range(len(self)):
                self.state[other, at.ROW_START] = self._pool.region(other)[0]
        st[at.ROW_START], st[at.ROW_COUNT] = self._pool.region(index)
        st[at.ROW_STEP], st[at.MODE], st[at.REST], st[at.NO_GROUND] = step, mode, 0.0, 0.0

    def _blend(self, index: int) -> None:
        """Keep the difference between the animal's pose and its new motion as an offset that decays."""
        st, pool = self.state[index], self._pool.rows
        pr = self._params[int(st[at.KIND])]
        now = wanted_pose(st, pr, pool, st[at.ARC], st[at.SCRIPT_TIME])
        after = wanted_pose(
            st, pr, pool, st[at.ARC] + st[at.WAY] * st[at.SPEED] * DT, st[at.SCRIPT_TIME] + DT
        )
        for k, channel in enumerate((0, 1, 3, 4)):
            off, rate = st[at.X + k] - now[channel], (after[channel] - now[channel]) / DT
            st[at.OFFSET + k] = wrap(off) if channel == 3 else off
            st[at.OFFSET_RATE + k] = st[at.RATE + k] - rate if st[at.FIRST_TICK] == 0.0 else 0.0
        st[at.FRONT_ARC] = now[5]

    def change_ground(self, ground: Ground) -> NDArray[np.int64]:
        """Continue on another ground. Returns the animals whose standing feet or path ahead are no longer on
        it, or more than 1 cm off it; they stop where they stand."""
        self.ground = ground
        lost = [index for index in range(len(self)) if self._has_lost_ground(index)]
        self.state[lost, at.NO_GROUND] = 1.0
        return np.array(lost, dtype=np.int64)

    def _has_lost_ground(self, index: int) -> bool:
        st = self.state[index]
        if not self.stands_on_ground(index):
            return True
        if st[at.MODE] == at.ON_TRAIL and self.resting(index) is False:
            rows = self._pool.table(index)
            arcs = st[at.ROW_STEP] * np.arange(len(rows))
            ahead = st[at.WAY] * (arcs - st[at.ARC]) >= 0.0
            return not self._on_ground(rows[ahead][:, [at.PX, at.PY, at.PZ]])
        return False

    def stands_on_ground(self, index: int) -> bool:
        """Whether there is ground under all standing feet, to within 1 cm."""
        return self._on_ground(self.feet[index, self.standing_feet(index), : at.FZ + 1])

    def _on_ground(self, spots: NDArray[np.float64]) -> bool:
        found = self.ground.surface_below(spots + np.array([0.0, 0.0, _CHANGE]))[0]
        return bool(np.all(np.abs(found - spots[:, 2]) <= _CHANGE))

    # --- time
    def tick(self) -> None:
        """Advance all animals by 10 ms."""
        if len(self):
            advance_all(
                self.state, self._params, self._gaits, self._pool.rows, kernel_ground(self.ground),
                self.ground.origin, self.feet, self.crumbs, self.poses, self.pose_start, self.joints,
            )  # fmt: skip

    # --- what can be asked
    def resting(self, index: int) -> bool:
        """Whether the motion is over and all feet are in place."""
        return bool(self.state[index, at.REST])

    def pose(self, index: int) -> NDArray[np.float64]:
        """(m, 7) float64: position [m] and quaternion (w, x, y, z) of each body, see `body_names`."""
        return self.poses[self.pose_start[index] : self.pose_start[index + 1]].copy()

    def names(self, index: int) -> tuple[str, ...]:
        """Names of the bodies in `pose`."""
        return body_names(self.bodies[index].spine.bones)

    def root(self, index: int) -> NDArray[np.float64]:
        """(4,) [m, m, m, rad]: point of the ground between the rear feet, and the body's direction there."""
        return self.state[index, [at.X, at.Y, at.HEIGHT, at.YAW]]

    def place(self, index: int) -> Place:
        """Where an animal stands, for scripts and footprint checks."""
        x, y, z, yaw, bend = self.state[index, [at.X, at.Y, at.HEIGHT, at.YAW, at.BEND]].tolist()
        return Place(x, y, z, yaw, bend)

    def front(self, index: int) -> NDArray[np.float64]:
        """(2,) [m]: the front feet's place under the shoulders."""
        return self.state[index, [at.FRONT_X, at.FRONT_Y]]

    def discs(self) -> NDArray[np.float64]:
        """(DISCS n, 6) discs that cover all animals on the ground, at the rear feet, the middle and the front
        feet: x, y, z [m], velocity of the root in x and y [m/s], radius [m]."""
        if not self.bodies:
            return np.empty((0, 6))
        rows = np.empty((DISCS * len(self), 6))
        cover_with_discs(self.state, self._disc_radii, rows)
        return rows

    def foretold(self, index: int) -> NDArray[np.float64]:
        """(COUNT, DISCS, 2) [m] predicted places of an animal's discs, every `giving_way.STEP`, if it
        continues its motion."""
        st, feet = self.state[index], np.empty((COUNT, 2, 2))
        foretell_motion(st, self._params[int(st[at.KIND])], self._pool.rows, feet)
        return between_feet(feet[:, 0], feet[:, 1])

    def rows(self, index: int) -> NDArray[np.float64]:
        """(n, ROW) the rows of the present trail or script."""
        return self._pool.table(index)

    def toes(self, index: int) -> NDArray[np.float64]:
        """(4, 3) [m] in the order of `LEGS`."""
        return self.feet[index, :, : at.FZ + 1].copy()

    def standing_feet(self, index: int) -> NDArray[np.bool_]:
        """(4,) which feet are on the ground."""
        return self.feet[index, :, at.IN_SWING] == 0.0

    def trail_of_crumbs(self, index: int) -> NDArray[np.float64]:
        """(k, 3) [m] the root's past places, oldest first."""
        st = self.state[index]
        count, last = int(st[at.CRUMBS]), int(st[at.CRUMB_LAST])
        return self.crumbs[index, (last - np.arange(count)[::-1]) % RING]

    def forget_crumbs(self, index: int) -> None:
        """Begin a new trail of crumbs here."""
        self.state[index, at.CRUMBS] = 0.0

    # --- saving
    def save(self, index: int) -> AnimalState:
        """Everything needed to continue from here."""
        return AnimalState(
            self.bodies[index].name, self.state[index].copy(), self.feet[index].copy(),
            self.crumbs[index].copy(), self._pool.table(index),
        )  # fmt: skip

    def restore(self, index: int, saved: AnimalState) -> None:
        """Restore a state of this animal."""
        if saved.body != self.bodies[index].name:
            raise LocomotionError(
                f"the saved state belongs to a {saved.body}, not to a {self.bodies[index].name}"
            )
        kind = self.state[index, at.KIND]  # each herd counts these itself
        self.state[index], self.feet[index], self.crumbs[index] = saved.row, saved.feet, saved.crumbs
        self.state[index, at.KIND] = kind
        if len(saved.table):
            moved = self._pool.put(index, saved.table)
            for other in range(len(self)) if moved else (index,):
                self.state[other, at.ROW_START] = self._pool.region(other)[0]
        self._write_pose(index)

    def state_hash(self, index: int) -> str:
        """Hex digest of everything that decides an animal's future."""
        row = self.state[index].copy()
        row[at.ROW_START] = row[at.KIND] = 0.0  # indices into the herd's tables do not count
        hasher = hashlib.sha256(self.bodies[index].name.encode() + row.tobytes())
        for part in (self.feet[index], self.trail_of_crumbs(index), self._pool.table(index)):
            hasher.update(np.ascontiguousarray(part).tobytes())
        return hasher.hexdigest()[:16]


def _end_pitch(trail: Trail, body: Body) -> float:
    """[rad] of the trunk at the end of a trail."""
    back = max(len(trail.rows) - 1 - round(body.spine.length / trail.step), 0)
    rise = trail.rows[-1, at.PZ] - trail.rows[back, at.PZ]
    return math.asin(np.clip(rise / body.spine.length, -0.75, 0.75))
