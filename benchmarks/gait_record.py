"""What a walk or run looks like, noted at every physics step."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from benchmarks.limbs import Limbs
from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK, PersonIndex
from locomotion.gaits.policy.kernel import Parts, feel
from locomotion.gaits.policy.layout import FELT_SIZE, FORCES, SOLES
from locomotion.gaits.policy.skill import PolicySkill
from locomotion.human.human import Human
from locomotion.training.policies.trial import PolicyTrial
from surefoot.kernels import allocating_kernel

__all__ = ["Record", "learned_walk", "planned_walk", "thigh_angles", "tick_in_steps"]

_STANDS, _WARM_UP = 1.0, 5.0  # [s] that do not count
_FALLEN = 0.6  # [m] height of the root


@dataclass(frozen=True)
class Record:
    """n physics steps: time step [s]; com (n, 3); angles (n, 39) [rad]; thighs (n, 2) from the vertical
    [rad]; forces (n, 2) under the right and the left foot [N]; soles (n, 6, 3); slid (n, 2), how far what
    bears slid [m]; depth (n,) of the deepest contact [m]; limbs: how deep limbs were in each other [m], by
    name; fell."""

    step: float
    com: NDArray[np.float64]
    angles: NDArray[np.float64]
    thighs: NDArray[np.float64]
    forces: NDArray[np.float64]
    soles: NDArray[np.float64]
    slid: NDArray[np.float64]
    depth: NDArray[np.float64]
    limbs: dict[str, float]
    fell: bool


def thigh_angles(data: mujoco.MjData, thighs: list[int]) -> NDArray[np.float64]:
    """Angles of the ``thighs`` (body ids) from the vertical, forward as the pelvis faces, [rad]."""
    w, x, y, z = data.qpos[3:7]
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    down = -data.xmat[thighs].reshape(-1, 3, 3)[:, :, 2]
    return np.arctan2(down[:, 0] * np.cos(yaw) + down[:, 1] * np.sin(yaw), -down[:, 2])


@allocating_kernel
def _slid(pairs, places, gaps, addresses, forces, ncon, velocities, com, geoms, bodies, out):
    """Mean speed at which what bears of each foot slides, into ``out`` (2,) [m/s]; gives the deepest
    contact."""
    weights, depth = np.zeros(2), 0.0
    for c in range(ncon):
        part = geoms[pairs[c, 0]] + geoms[pairs[c, 1]]
        if part == 0 or addresses[c] < 0:
            continue
        depth = max(depth, -gaps[c])
        force = 0.0
        for k in range(4):
            force += forces[addresses[c] + k]
        v = velocities[bodies[part - 1]]
        x, y, z = places[c, 0] - com[0], places[c, 1] - com[1], places[c, 2] - com[2]
        speed = math.hypot(v[3] + v[1] * z - v[2] * y, v[4] + v[2] * x - v[0] * z)
        out[(part - 1) // 2] += force * speed
        weights[(part - 1) // 2] += force
    for side in range(2):
        out[side] /= max(weights[side], 1e-9)
    return depth


class _Recorder:
    """Notes the steps of a simulation."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self.model, self.data = model, data
        self.parts, self.felt = Parts(PersonIndex.of(model), model), np.zeros(FELT_SIZE)
        self.rows: dict[str, list] = {
            name: [] for name in ("com", "angles", "thighs", "forces", "soles", "slid", "depth")
        }
        self._limbs = Limbs(model)
        self._thighs = [model.body(f"{side}_thigh").id for side in ("right", "left")]

    def note(self) -> None:
        """Note the state after a physics step."""
        data, rows = self.data, self.rows
        feel(self.parts, data, self.felt)
        rows["com"].append(data.subtree_com[1].copy())
        rows["angles"].append(data.qpos[7:46].copy())
        rows["thighs"].append(thigh_angles(data, self._thighs))
        rows["forces"].append(self.felt[FORCES].reshape(2, 2).sum(axis=1))
        rows["soles"].append(self.felt[SOLES].reshape(6, 3).copy())
        slid, depth = self._contacts()
        rows["slid"].append(slid)
        rows["depth"].append(depth)
        self._limbs.note(data)

    def _contacts(self) -> tuple[NDArray[np.float64], float]:
        """How far the bearing contacts of each foot slid in this step, weighted by their forces; the
        deepest."""
        data, contact, slid = self.data, self.data.contact, np.zeros(2)
        depth = _slid(
            contact.geom, contact.pos, contact.dist, contact.efc_address, data.efc_force, data.ncon,
            data.cvel, data.subtree_com[1], self.parts.geoms, self.parts.bodies, slid,
        )  # fmt: skip
        return slid * self.model.opt.timestep, depth

    def record(self, fell: bool) -> Record:
        """What was noted."""
        arrays = {name: np.array(rows) for name, rows in self.rows.items()}
        return Record(self.model.opt.timestep, **arrays, limbs=self._limbs.deepest(), fell=fell)


def learned_walk(skill: PolicySkill, speed: float, seconds: float, warm_up: float = _WARM_UP) -> Record:
    """The learned walk or run on a plane, from a stand; the first ``warm_up`` [s] do not count."""
    trial = PolicyTrial(skill)
    recorder = _Recorder(trial.model, trial.data)
    trial.go(_STANDS)
    trial.asked[0] = speed
    held = trial.go(warm_up) and trial.go(seconds, recorder.note)
    return recorder.record(not held)


def tick_in_steps(human: Human, twin: mujoco.MjData, note: Callable[[], None]) -> None:
    """A tick of a person, simulated once more on ``twin``; ``note`` is called after each physics step."""
    state = mujoco.mjtState.mjSTATE_INTEGRATION
    before = np.empty(mujoco.mj_stateSize(human.model, state))
    mujoco.mj_getState(human.model, human.data, before, state)
    on_feet = not human.fours.active
    human.tick()
    model = human.model if on_feet else human.fours.model
    mujoco.mj_setState(human.model, twin, before, state)
    twin.ctrl[:], twin.eq_active[:] = human.data.ctrl, human.data.eq_active
    twin.mocap_pos[:] = human.data.mocap_pos
    for _ in range(STEPS_PER_TICK):
        mujoco.mj_step(model, twin)
        note()


def planned_walk(speed: float, seconds: float, warm_up: float = _WARM_UP) -> Record:
    """The same of the walk of `locomotion.gaits.walk`, or the run, along a straight line."""
    human = Human(None, clearing=(), rehearsals=0)
    human.reset(np.zeros(3), 0.0)
    human.follow(np.array([[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0]]), speed)
    data = mujoco.MjData(human.model)
    recorder = _Recorder(human.model, data)
    for k in range(round((warm_up + seconds) / CONTROL_DT)):
        if k * CONTROL_DT < warm_up:
            human.tick()
        else:
            tick_in_steps(human, data, recorder.note)
        if human.data.qpos[2] < _FALLEN:
            return recorder.record(True)
    return recorder.record(False)
