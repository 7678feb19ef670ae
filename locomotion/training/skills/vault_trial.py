"""Trials of vaulting: a wall before a running person, start states from planned run-ups, figures."""

from dataclasses import dataclass

import mujoco
import numpy as np

from locomotion.body.hand_hold import let_go_both
from locomotion.body.person import CONTROL_DT, MASS
from locomotion.gaits.run import controller as c
from locomotion.gaits.run import layout
from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.kernel import mirror
from locomotion.skills.learned_skill import LawTables
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.kernel import start_vault, vault_fell, vault_tick
from locomotion.skills.vault.skill import grip, vault_clip
from locomotion.training.skills.jump_trial import JumpSimulator, StartState

__all__ = ["VaultOutcome", "VaultSimulator"]

_MARGIN = 0.03  # [m] around the wall in which a foot counts as over it, and by which it should clear it
_HIGH = 0.85  # [m] of the centre of mass above the floor: a leg that lands is nearly straight
_NO_FORCE = 10.0  # [m] by which anything would have to be inside before a wall that is not solid pushes it
_YAW = c.SENSORS.index("yaw")
_COMPARED = ("hip_flexion", "hip_abduction", "knee_flexion")


@dataclass(frozen=True)
class VaultOutcome:
    """What a trial showed.

    cleared: both feet landed behind the wall and the person still runs at the end. time: share of the trial
    survived. shortfall: how far [m] the lowest parts of the feet were below `_MARGIN` above the top while
    they were over it, both added. scrape: ticks in which anything but the supporting hand and forearm
    touched the wall. missed: least distance [m] of the hand to the middle of the top before it held, 0 when
    it held. planted: where it held, as share of the depth, NaN if it did not. held: ticks. impulse: [Ns]
    upward from the top on the hand. steps: made behind it. speed: mean speed [m/s] of these. drift:
    sideways distance [m] at the end. yaw: mean squared turn [rad^2] of the pelvis after the landing.
    headlong: most that the chest was upside down, from 0 (its axis level or above) to 1.
    sunk: how far [m] the centre of mass was below `_HIGH` when the leading foot landed, or at the end.
    reaction, effort, trunk, pose, errors: as in `JumpOutcome`.
    """

    cleared: bool
    time: float
    shortfall: float
    scrape: int
    missed: float
    planted: float
    held: int
    impulse: float
    steps: int
    speed: float
    drift: float
    reaction: float
    effort: float
    trunk: float
    yaw: float
    headlong: float
    sunk: float
    pose: float
    errors: tuple[float, float]

    @property
    def vaulted(self) -> bool:
        """Cleared, with the hand on the top and nothing else touching the wall."""
        return self.cleared and self.held > 0 and self.scrape == 0


class VaultSimulator(JumpSimulator):
    """A person, a plane and a wall that trials are run with; one per process."""

    def __init__(self, run: RunSkill) -> None:
        super().__init__(run)
        self.vault_memory = np.zeros(vault.MEMORY_SIZE)
        shares = np.linspace(0.0, 1.0, 41)
        self.clip = vault_clip().sample(shares)
        self.mirrored_clip = mirror(self.clip)
        self.limbs = np.array([i for i, name in enumerate(c.JOINT_NAMES) if name.endswith(_COMPARED)])

    def place_wall(self, edge_x: float, height: float, depth: float, solid: bool = True) -> None:
        """The wall's near edge at x = ``edge_x`` [m], its top at ``height`` [m], ``depth`` [m] thick. One
        that is not solid is seen to be touched and lets through; a joint holds the hand on it."""
        # MuJoCo reports contacts nearer than margin + gap; there is force in those nearer than margin
        self.model.geom_margin[self.stair] = 0.0 if solid else -_NO_FORCE
        self.model.geom_gap[self.stair] = 0.0 if solid else _NO_FORCE
        self.model.geom_size[self.stair, 0] = 0.5 * depth
        self.model.geom_pos[self.stair] = [
            edge_x + 0.5 * depth,
            0.0,
            height - self.model.geom_size[self.stair, 2],
        ]

    def vault_trial(
        self,
        tables: LawTables,
        wall: tuple[float, float],
        start: StartState,
        error: float,
        duration: float,
        solid: bool = True,
        on_tick=None,
        record: np.ndarray | None = None,
    ) -> VaultOutcome:
        """Vault from a harvested state; the wall is put so that the distance misses the mark by ``error``
        [m].

        wall: its height and depth [m]. duration: [s]. solid: see `place_wall`. on_tick(simulator) is called
        after each tick. record: (4, 6, 19) sums of the sensors per bin and their count, added to.
        """
        height, depth = wall
        edge = float(start.planted[0]) + tables.mark - vault.nearer(depth) + error
        self.place_wall(edge, height, depth, solid)
        self._restore(start)
        memory, state, data = self.vault_memory, self.state, self.data
        memory[:] = 0.0
        steps = state[c.STEPS]
        self.command[:] = 0.0, tables.entry, 0.0
        meter = _Meter(self, edge, height, depth)
        begun = False
        ticks = round(duration / CONTROL_DT)
        ahead = np.array([1.0, 0.0])
        for _ in range(ticks):
            if begun and memory[vault.ACTIVE] == 0.0:
                self.steer()
            self.run_tick()
            if not begun and state[c.STEPS] != steps:
                begun = True
                where = np.array([edge, 0.0])
                start_vault(tables.parameters, memory, state, where, ahead, height, height, depth)
            if begun:
                vault_tick(tables.parameters, *tables.rest, memory, state, data.qpos, data.ctrl)
                if not solid:
                    grip(memory, data)
            state[c.FALLEN] = 0.0
            self._step()
            if begun:
                state[c.FALLEN] = float(vault_fell(memory, state))
            step = int(state[c.STEPS] - steps) - 1
            if record is not None and 0 <= step < vault.STEPS:
                place = min(int(state[c.PHASE] * (vault.BINS - 1) + 0.5), vault.BINS - 1)
                record[step, place, : vault.SENSORS] += memory[vault.SENSED]
                record[step, place, vault.SENSORS] += 1.0
            meter.tick(step)
            if on_tick is not None:
                on_tick(self)
            if state[c.FALLEN] > 0.0:
                break
        let_go_both(data)
        return meter.outcome(ticks)


class _Meter:
    """Collects the figures of a trial."""

    def __init__(self, simulator: VaultSimulator, edge: float, height: float, depth: float) -> None:
        s = self.s = simulator
        self.edge, self.height, self.depth = edge, height, depth
        model, bodies = s.model, s.index.bodies
        solid = model.geom_conaffinity > 0
        sides = ("right", "left")
        self.feet = [np.flatnonzero((s.index.geom_side == sign) & solid) for sign in (-1, 1)]
        self.half = [model.geom_size[f, 1] for f in self.feet]
        self.radius = [model.geom_size[f, 0] for f in self.feet]
        of = model.geom_bodyid
        self.arm = [np.isin(of, [bodies[f"{x}_hand"], bodies[f"{x}_forearm"]]) for x in sides]
        self.hands = [np.flatnonzero((of == bodies[f"{x}_hand"]) & solid) for x in sides]
        self.shortfall, self.crossed = np.zeros(2), np.zeros(2, dtype=bool)
        self.landed = [False, False]
        self.ticks = self.scrape = self.held = self.steps = self.pose_ticks = 0
        self.reaction = self.effort = self.trunk = self.yaw = self.pose = self.impulse = 0.0
        self.headlong = self.sunk = 0.0
        self.missed, self.planted = 1.0, np.nan
        self.last_step = -1
        self.speeds: list[float] = []

    def tick(self, step: int) -> None:
        s, data, state, memory = self.s, self.s.data, self.s.state, self.s.vault_memory
        self.ticks += 1
        if step < 2:
            self.sunk = max(_HIGH - state[layout.COM_Z], 0.0)
        if step == 1 or (step >= 0 and not all(self.landed)):
            self._feet(step)
            self._wall(memory)
        if step == 1 and memory[vault.HOLD] == 0.0:
            hand = data.geom_xpos[self.hands[int(memory[vault.SIDE] > 0)][0]]
            off = (hand[0] - self.edge - 0.5 * self.depth, hand[2] - self.height - 0.07)
            self.missed = min(self.missed, float(np.hypot(*off)))
        elif memory[vault.HOLD] == 1.0:
            self.missed, self.held = 0.0, self.held + 1
            self.planted = (memory[vault.ANCHOR.start] - self.edge) / self.depth
            if data.ne == 3:
                self.impulse -= float(data.efc_force[2]) * CONTROL_DT
        weight = MASS * 9.81
        self.reaction += max((state[layout.RIGHT_CONTACT] + state[layout.LEFT_CONTACT]) / weight - 4.0, 0.0)
        self.effort += float(np.dot(data.actuator_force, data.actuator_force)) * 1e-4
        up = data.xmat[s.index.chest]
        self.headlong = max(self.headlong, -up[8])
        if step >= 2:
            self.trunk += (up[2] - 0.1) ** 2 + 2.0 * up[5] ** 2
            self.yaw += float(state[c.SENSOR_VALUES][_YAW]) ** 2
        if 1 <= step <= 2:
            mirrored = (state[c.STANCE] > 0) == (step == 1)
            clip = s.mirrored_clip if mirrored else s.clip
            row = clip[round(20.0 * (step - 1 + state[c.PHASE]))]
            self.pose += float(np.mean((data.qpos[7:][s.limbs] - row[s.limbs]) ** 2))
            self.pose_ticks += 1
        if step != self.last_step:
            self.last_step = step
            if all(self.landed):
                self.steps += 1
                self.speeds.append(float(state[c.STEP_SPEED]))

    def _feet(self, step: int) -> None:
        data, state = self.s.data, self.s.state
        for k in range(2):
            middle, axis = data.geom_xpos[self.feet[k]], data.geom_xmat[self.feet[k]][:, [2, 5, 8]]
            along = axis * self.half[k][:, None]
            ends = np.concatenate([middle + along, middle - along])
            radius = np.concatenate([self.radius[k], self.radius[k]])
            over = (ends[:, 0] > self.edge - _MARGIN - radius) & (
                ends[:, 0] < self.edge + self.depth + _MARGIN + radius
            )
            if step >= 1 and over.any():
                self.crossed[k] = True
                short = self.height + _MARGIN - (ends[over, 2] - radius[over]).min()
                self.shortfall[k] = max(self.shortfall[k], short)
            if (
                state[layout.RIGHT_FOOT + 3 * k] > self.edge + self.depth
                and state[layout.RIGHT_CONTACT + k] > 20.0
                and step >= 1
            ):
                self.landed[k] = True

    def _wall(self, memory: np.ndarray) -> None:
        """Contacts with the wall: of the supporting hand its force, of anything else that there is one."""
        data, model = self.s.data, self.s.model
        if data.ncon == 0:
            return
        geoms = data.contact.geom
        mine = (geoms == self.s.stair).any(axis=1)
        if not mine.any():
            return
        arm = self.arm[int(memory[vault.SIDE] > 0)]
        touched = False
        for i in np.flatnonzero(mine):
            if not arm[geoms[i]].any():
                touched = True
            elif memory[vault.HOLD] == 1.0:
                force = np.zeros(6)
                mujoco.mj_contactForce(model, data, int(i), force)
                self.impulse += force[0] * abs(data.contact.frame[i, 2]) * CONTROL_DT
        self.scrape += touched

    def outcome(self, ticks: int) -> VaultOutcome:
        state, memory, n = self.s.state, self.s.vault_memory, max(self.ticks, 1)
        fallen = state[c.FALLEN] > 0.0
        return VaultOutcome(
            cleared=all(self.landed) and not fallen,
            time=(self.ticks - (1 if fallen else 0)) / ticks,
            shortfall=float(np.where(self.crossed, self.shortfall, 0.6).sum()),
            scrape=self.scrape,
            missed=self.missed,
            planted=float(self.planted),
            held=self.held,
            impulse=self.impulse,
            steps=self.steps,
            speed=float(np.mean(self.speeds[-3:])) if self.speeds else 0.0,
            drift=abs(float(state[c.COM.start + 1])),
            reaction=self.reaction / n,
            effort=self.effort / n,
            trunk=self.trunk / n,
            yaw=self.yaw / n,
            headlong=self.headlong,
            sunk=self.sunk,
            pose=self.pose / max(self.pose_ticks, 1),
            errors=(float(memory[vault.ERROR_DISTANCE]), float(memory[vault.ERROR_SPEED])),
        )
