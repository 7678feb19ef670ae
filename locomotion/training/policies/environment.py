"""Many people at once who walk as a policy decides, with pushes, slopes and changing orders."""

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray

from locomotion.body.traits import SPREAD as DEVIATIONS
from locomotion.body.traits import by_hand
from locomotion.gaits.policy import law
from locomotion.gaits.policy.layout import (
    ACTION,
    ACTIONS,
    ARM_SWING,
    ASKED_SPEED,
    CHANGE,
    FAST,
    FELT_SIZE,
    FORCES,
    HEADING,
    HEELS_AND_BALLS,
    HIP_ROTATIONS,
    INPUTS,
    JOINTS,
    PHASE,
    POLICY_DT,
    RUNNING,
    SOLES,
    SPEED,
    SPREAD,
    STATE_SIZE,
    STYLE,
    SWINGING,
    TOLD,
    TURN_RATE,
)
from locomotion.gaits.policy.motion import Motion
from locomotion.gaits.policy.style import style_of
from locomotion.training.policies.curriculum import Stage
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.reference import Reference, quaternions
from locomotion.training.policies.rewards import Moment, rewards, sway_off, total
from locomotion.training.policies.starts import Starts

__all__ = ["Environment", "Outcome", "motion_of"]

THREADS = 2
_STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS
_CONTROL = int(mujoco.mjtState.mjSTATE_CTRL) | int(mujoco.mjtState.mjSTATE_XFRC_APPLIED)
_GRAVITY = 9.81
_EVERY = 3.0  # [s] between pushes, on average
_PUSHED = 5  # decisions that a push lasts: 0.1 s
_WEAKEST = 0.2  # of the greatest push
_LOWEST, _LEAST_UP, _MOST_SWAY = 0.70, 0.75, 1.5  # beyond which a person counts as fallen
_SETTLED = 25  # decisions after which a pose has to be like the reference's: some begin in another
_ANGLE, _SPEED, _RATE = 0.03, 0.08, 0.1  # spread of the starts: [rad], [m/s], [rad/s]
_SIDEWAYS = 1.2  # [m/s^2] in a bend at most: as much as people are asked for
_TURNING, _BEGIN_TURNING = 0.6, 0.7  # shares of the orders that turn
_CAUGHT, _CAUGHT_SPEEDS = 0.5, (0.25, 0.9)
# share of those who begin in a stand, and stay, whom a push has thrown off it, and how fast they are [m/s]
_LEANS = 0.5  # share of the angle that would balance a change of speed, by which a runner leans
_DIFFERS = 2.0  # standard deviations of traits by chance, by which somebody differs at most
_SETS_OFF = 0.5  # share of those who begin in a stand and are to walk at once


@dataclass(frozen=True)
class Outcome:
    """After a decision: reward (n,); who fell, whose time is over, and for whom the other network would take
    over now, (n,) bool; the memories with which it would, (n, STATE_SIZE); mean of each term of the
    reward."""

    reward: NDArray[np.float64]
    fell: NDArray[np.bool_]
    over: NDArray[np.bool_]
    changes: NDArray[np.bool_]
    switched: NDArray[np.float64]
    terms: dict[str, float]


def motion_of(reference: Reference) -> Motion:
    """The part of a reference that is needed at run time."""
    right, left = reference.soles[0, 0, HEELS_AND_BALLS].reshape(2, 2, 3).mean(axis=1)
    stance = np.array([0.5 * (right + left)[0], (left - right)[1]])
    return Motion(reference.speeds, reference.periods, reference.joints, reference.rates, stance)


class Environment:
    """``count`` people on a plane, each in a world of its own.

    Attributes:
      stage: what they are asked to do. memory: (n, STATE_SIZE) of their policies. asked: (n, 2).
      physics: (n, k) MuJoCo's states; sensed: (n, 22) sensors; age: (n,) decisions since they began.
      whole: on the figure of all 45 degrees of freedom.

    ``starts``: states in which some begin, see `Stage.from_starts`.
    """

    inputs, actions, kept = INPUTS, ACTIONS, True

    def __init__(
        self,
        reference: Reference,
        stage: Stage,
        count: int,
        seed: int,
        whole: bool = False,
        starts: Starts | None = None,
    ) -> None:
        self.reference, self.motion = reference, motion_of(reference)
        self.count, self.whole, self.stage, self._starts = count, whole, stage, starts
        self.rng = np.random.default_rng(seed)
        self._rollout = rollout.Rollout(nthread=THREADS)
        self._build(stage)
        self.memory, self.asked = np.zeros((count, STATE_SIZE)), np.zeros((count, 2))
        self.physics, self.sensed = np.zeros((count, self._size)), np.zeros((count, FELT_SIZE))
        self.age, self.pushed = np.zeros(count, np.int64), np.zeros(count, np.int64)
        self.force, self.slope = np.zeros((count, 2)), np.zeros((count, 2))
        self.reset(np.ones(count, bool))

    def _build(self, stage: Stage) -> None:
        self.figure = Figure(self.whole, stage.timestep)
        model = self.model = self.figure.model
        self._substeps = round(POLICY_DT / stage.timestep)
        self._size = mujoco.mj_stateSize(model, _STATE)
        self._controls = mujoco.mj_stateSize(model, _CONTROL)
        self._datas = [mujoco.MjData(model) for _ in range(THREADS)]
        self._start = mujoco.MjData(model)
        self._waist = model.nu + 6 * model.body("waist").id

    def begin(self, stage: Stage) -> None:
        """Everybody begins anew, in another stage."""
        if stage.timestep != self.stage.timestep:
            self._build(stage)
        self.stage = stage
        self.reset(np.ones(self.count, bool))

    @property
    def qpos(self) -> NDArray[np.float64]:
        """(n, nq)"""
        return self.physics[:, 1 : 1 + self.model.nq]

    @property
    def qvel(self) -> NDArray[np.float64]:
        """(n, nv)"""
        return self.physics[:, 1 + self.model.nq : 1 + self.model.nq + self.model.nv]

    @property
    def soles(self) -> NDArray[np.float64]:
        """(n, 6, 3) [m]"""
        return self.sensed[:, SOLES].reshape(-1, 6, 3)

    def observe(self) -> NDArray[np.float64]:
        """What the policies observe, (n, INPUTS)."""
        return law.observe(self.memory, self.seen())

    def seen(self) -> law.Seen:
        """The bodies."""
        qpos, qvel, figure = self.qpos, self.qvel, self.figure
        angles, rates = qpos[:, figure.angles], qvel[:, figure.rates]
        return law.Seen(qpos, qvel, angles, rates, self.soles, self.sensed[:, FORCES])

    # ---- beginnings and orders

    def _orders(self, count: int, stand: float, turning: float) -> NDArray[np.float64]:
        """Random orders (count, 2)."""
        rng, stage = self.rng, self.stage
        speeds = np.where(rng.random(count) < stand, 0.0, rng.uniform(*stage.speeds, count))
        turns = rng.uniform(-stage.turn, stage.turn, count) * (rng.random(count) < turning)
        most = _SIDEWAYS / np.maximum(speeds, _SIDEWAYS / max(stage.turn, 1e-6))
        turns = np.clip(turns, -most, most)
        return np.stack([speeds, turns], axis=1)

    def reset(self, who: NDArray[np.bool_]) -> None:
        """Some begin anew, near the reference at a random moment of the cycle."""
        ids = np.flatnonzero(who)
        k, rng, reference = len(ids), self.rng, self.reference
        if k == 0:
            return
        orders = self._orders(k, self.stage.stand, _BEGIN_TURNING)
        memory = np.zeros((k, STATE_SIZE))
        memory[:, SPEED], memory[:, TURN_RATE] = orders.T
        memory[:, TOLD], memory[:, FAST] = memory[:, SPEED], self.stage.runs
        stands = (orders[:, ASKED_SPEED] < law.AT_REST) & (self.stage.stands | (rng.random(k) < 0.5))
        memory[stands, TURN_RATE] = 0.0
        halves = 0.5 * rng.integers(0, 2, k)
        begins = law.LIFT_OFF + halves - (0.0 if self.stage.stands else law.SHIFTING)
        memory[:, PHASE] = np.where(stands, begins % 1.0, rng.random(k))
        sets_off = stands & (rng.random(k) < _SETS_OFF) & (not self.stage.stands)
        orders[:, ASKED_SPEED] += sets_off * rng.uniform(*self.stage.speeds, k)
        pushed = stands & ~sets_off & (rng.random(k) < _CAUGHT) & bool(self.stage.push)
        pushed &= not self.stage.stands
        angle, fast = rng.uniform(0.0, 2.0 * np.pi, k), rng.uniform(*_CAUGHT_SPEEDS, k) * pushed
        thrown = fast[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        memory[pushed, PHASE] = law.LIFT_OFF + 0.5 * (thrown[pushed, 1] > 0.0)
        self.memory[ids], self.asked[ids] = memory, orders
        self.age[ids] = self.pushed[ids] = 0
        self.slope[ids] = rng.uniform(-self.stage.slope, self.stage.slope, (k, 2))
        place = self.motion.at(memory[:, PHASE], memory[:, SPEED], np.where(stands, 0.0, 1.0))
        self.memory[ids, RUNNING] = 0.0 if self.stage.stands else 1.0
        root, joints = place.read(reference.root), place.read(reference.joints)
        qpos, qvel = np.zeros((k, self.model.nq)), np.zeros((k, self.model.nv))
        qpos[:, 1], qpos[:, 3:7] = root[:, 0], quaternions(root[:, 2:5])
        limits = self.figure.limits
        angles = joints + _ANGLE * rng.standard_normal((k, len(JOINTS)))
        qpos[:, self.figure.angles] = np.clip(angles, limits[:, 0], limits[:, 1])
        qvel[:, :3], qvel[:, 3:6] = root[:, 5:8], place.read(reference.spin)
        qvel[:, :2] += _SPEED * rng.standard_normal((k, 2)) + thrown
        qvel[:, self.figure.rates] = place.read(reference.rates) + _RATE * rng.standard_normal(
            (k, len(JOINTS))
        )
        qpos[:, 2] = root[:, 1] * self.stage.runs
        for i, q, v in zip(ids.tolist(), qpos, qvel, strict=True):
            self._put(i, q, v)
        if self._starts is not None:
            some = ids[rng.random(k) < self.stage.from_starts]
            picked = rng.integers(0, len(self._starts.memory), len(some))
            for name, values in vars(self._starts).items():
                getattr(self, name)[some] = values[picked]
        if self.stage.traits:
            some = ids[rng.random(k) < self.stage.traits]
            chance = rng.uniform(-1.0, 1.0, (len(some), len(DEVIATIONS)))
            for i, each in zip(
                some.tolist(), by_hand() + _DIFFERS * np.array(DEVIATIONS) * chance, strict=True
            ):
                self.memory[i, STYLE] = style_of(each)

    def _put(self, i: int, qpos: NDArray[np.float64], qvel: NDArray[np.float64]) -> None:
        """Put person ``i`` there, the lowest point of its soles just on the ground."""
        data, nq = self._start, self.model.nq
        data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, data)
        soles = data.site_xpos[self.figure.soles].copy()
        raised = 0.001 - soles[:, 2].min()
        raised = max(raised, 0.0) if qpos[2] > 0.0 else raised
        soles[:, 2] += raised
        self.physics[i] = 0.0
        self.physics[i, 1 : 1 + nq], self.physics[i, 1 + nq : 1 + nq + len(qvel)] = qpos, qvel
        self.physics[i, 3] += raised
        self.sensed[i, SOLES], self.sensed[i, FORCES] = soles.ravel(), 0.0

    def _change_orders(self) -> None:
        every = self.stage.changes or np.inf
        who = self.rng.random(self.count) < POLICY_DT / every
        if who.any():
            self.asked[who] = self._orders(int(who.sum()), self.stage.stand, _TURNING)

    def _push(self) -> None:
        rng, new = self.rng, self.rng.random(self.count) < POLICY_DT / _EVERY
        new &= self.pushed <= 0
        k = int(new.sum())
        if self.stage.push and k:
            force, angle = self.stage.push * rng.uniform(_WEAKEST, 1.0, k), rng.uniform(0.0, 2.0 * np.pi, k)
            self.force[new] = np.stack([force * np.cos(angle), force * np.sin(angle)], axis=1)
            self.pushed[new] = _PUSHED

    # ---- going on

    def step(self, decided: NDArray[np.floating]) -> Outcome:
        """Do what the policies ``decided`` (n, ACTIONS) for `POLICY_DT`."""
        before = self.memory[:, ACTION].copy()
        law.decide(self.memory, decided)
        control = self._control()
        soles = self.soles.copy()
        held = np.ascontiguousarray(
            np.broadcast_to(control[:, None], (self.count, self._substeps, self._controls))
        )
        states, sensed = self._rollout.rollout(
            self.model, self._datas, self.physics, held, control_spec=_CONTROL
        )
        self.physics, self.sensed = states[:, -1].copy(), sensed[:, -1].copy()
        broken = ~np.isfinite(self.physics).all(axis=1)
        self.physics[broken] = 0.0
        self.physics[broken, 4] = 1.0
        changes, switched = self._advance()
        self.memory[:, FAST] = self.stage.runs
        self._change_orders()
        self.age += 1
        moment = self.moment(sensed[:, :, FORCES], soles, before)
        terms = rewards(moment)
        fell = broken | self._fallen(moment)
        reward = np.where(broken, 0.0, total(terms, self.stage.weights)) - self.stage.fall * fell
        changes &= ~fell
        if self.stage.stands:
            fell |= changes
        means = {name: float(values.mean()) for name, values in terms.items()}
        over = (self.age >= self.stage.longest) & ~fell
        return Outcome(reward, fell, over, changes, switched, means)

    def _advance(self) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
        """The memories go on; gives for whom the other network would take over, (n,), and with which
        memories. While it learns to walk, who could stand steps in place instead."""
        before = self.memory.copy()
        how = {"steadies": self.stage.steadies, "waits": self.stage.waits}
        law.advance(self.memory, self.motion, self.asked, self.seen(), **how)
        changes = self.memory[:, RUNNING] != before[:, RUNNING]
        switched = self.memory.copy()
        if not self.stage.stands and changes.any():
            self.memory[changes] = before[changes]
            some = self.memory[changes]
            seen = _pick(self.seen(), changes)
            law.advance(some, self.motion, self.asked[changes], seen, halts=False, **how)
            self.memory[changes] = some
        return changes, switched

    def _control(self) -> NDArray[np.float64]:
        """Targets and outer forces, (n, controls)."""
        self._push()
        control = np.zeros((self.count, self._controls))
        control[:, self.figure.targets] = law.targets(self.memory, self.motion)
        if self.stage.slope:  # as gravity that is not vertical
            nu, masses = self.model.nu, self.model.body_mass
            for axis in (0, 1):
                control[:, nu + axis :: 6] = -_GRAVITY * self.slope[:, axis, None] * masses
        on = self.pushed > 0
        control[on, self._waist : self._waist + 2] += self.force[on]
        self.pushed[on] -= 1
        return control

    def moment(
        self,
        forces: NDArray[np.float64],
        soles: NDArray[np.float64],
        decided_before: NDArray[np.float64],
    ) -> Moment:
        """How they are after a decision: ``forces``, ``soles`` and ``decided_before`` as of `Moment`."""
        memory, reference, seen = self.memory, self.reference, self.seen()
        speed = law.shown_speed(memory)
        place = self.motion.at(memory[:, PHASE], speed, memory[:, RUNNING])
        root = place.read(reference.root)
        roll, pitch, facing = root[:, 2], root[:, 3], root[:, 4]
        pitch = pitch + _LEANS * np.arctan2(memory[:, CHANGE], _GRAVITY) * memory[:, FAST]
        up, yaw = law.up_and_yaw(self.qpos)
        wanted = np.stack([-np.sin(pitch), np.sin(roll) * np.cos(pitch)], axis=1)
        feet = law.along(memory[:, HEADING], seen.soles - self.qpos[:, None, :3])
        turned = law.turned_feet(memory, memory[:, PHASE], law.own_period(memory, self.motion))
        feet -= _turn(_spread(place.read(reference.soles), memory[:, SPREAD]), turned)
        velocity = law.along(memory[:, HEADING], self.qvel[:, :3]) - root[:, 5:8]
        velocity[:, 0] += (speed - memory[:, SPEED]) * memory[:, FAST]  # a run is to come to the speed told
        joints = law.styled(memory, place.read(reference.joints), place.read_rows(self.motion.means))
        joints[:, HIP_ROTATIONS] += law.turned_in(turned)
        spin = place.read(reference.spin)
        spin[:, 2] += memory[:, TURN_RATE] * memory[:, RUNNING]
        rates = place.read(reference.rates)
        rates[:, SWINGING] *= 1.0 + memory[:, ARM_SWING, None]
        return Moment(
            angles=seen.angles - joints,
            rates=seen.rates - rates,
            feet=feet[:, [0, 2, 3, 5]],
            up=up[:, :2] - wanted,
            yaw=law.wrap(yaw - memory[:, HEADING] - facing),
            spin=self.qvel[:, 3:6] - spin,
            height=self.qpos[:, 2] - root[:, 1],
            velocity=velocity,
            forces=forces,
            soles=seen.soles,
            soles_before=soles,
            loads=place.read(reference.loads),
            memory=memory,
            decided_before=decided_before,
        )

    def _fallen(self, moment: Moment) -> NDArray[np.bool_]:
        up, _ = law.up_and_yaw(self.qpos)
        low = (self.qpos[:, 2] < _LOWEST) | (up[:, 2] < _LEAST_UP)
        if self.stage.runs:  # whose reference may change faster than a body can
            return low
        return low | (sway_off(moment.angles) > _MOST_SWAY) & (self.age > _SETTLED)

    # ---- saved and restored

    def arrays(self) -> dict[str, NDArray[Any]]:
        """All that the next step depends on, besides `rng`, stage and reference."""
        names = ("memory", "asked", "physics", "sensed", "age", "pushed", "force", "slope")
        return {name: getattr(self, name) for name in names}

    def restore(self, arrays: dict[str, NDArray[Any]]) -> None:
        """Go on from `arrays`."""
        for name in self.arrays():
            setattr(self, name, arrays[name].copy())


def _turn(soles: NDArray[np.float64], turned: NDArray[np.float64]) -> NDArray[np.float64]:
    """Soles (n, 6, 3) whose feet are ``turned`` (n, 2) from a body that goes round a bend."""
    points = soles.reshape(-1, 2, 3, 3)
    middle = points[:, :, :2].mean(axis=2, keepdims=True)
    c, s = np.cos(turned)[:, :, None], np.sin(turned)[:, :, None]
    off, found = points - middle, points.copy()
    found[..., 0] = middle[..., 0] - s * middle[..., 1] + c * off[..., 0] - s * off[..., 1]
    found[..., 1] = middle[..., 1] + 0.5 * s * middle[..., 0] + s * off[..., 0] + c * off[..., 1]
    return found.reshape(soles.shape)


def _spread(soles: NDArray[np.float64], angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Soles (n, 6, 3) from the root, right and left, of legs spread by ``angles`` (n,) [rad] more."""
    found = soles.copy()
    found[:, :, 1] -= angles[:, None] * soles[:, :, 2] * np.repeat([-1.0, 1.0], 3)
    return found


def _pick(seen: law.Seen, who: NDArray[np.bool_]) -> law.Seen:
    return law.Seen(*(values[who] for values in vars(seen).values()))
