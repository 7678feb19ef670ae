"""Trials of jumping: a stair, ledge or gap before a running person, start states from planned run-ups,
figures."""

from dataclasses import dataclass

import mujoco
import numpy as np

from locomotion.body.person import CONTROL_DT, MASS, STEPS_PER_TICK, PersonIndex
from locomotion.clips.clip import Clip
from locomotion.gaits.run import controller as c
from locomotion.gaits.run import layout
from locomotion.gaits.run.skill import RunSkill, reset_running
from locomotion.human.human import Human
from locomotion.paths.command import HEADING_ASKED, SIDEWAYS_ASKED, SPEED_ASKED
from locomotion.paths.gait_plan import RUN_UP
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.skills.interface import ClearingSkill, foot_distance, plan_run_up, run_up_speeds
from locomotion.skills.jump import kernel as jump
from locomotion.skills.jump.kernel import jump_tick, start_jump
from locomotion.skills.jump.skill import jump_clip
from locomotion.skills.learned_skill import LawTables
from locomotion.training.skills.trial_scene import BOX_LENGTH, BOX_TOP, trial_scene
from navmesh.obstacles.kinds import Crossing

__all__ = ["JumpOutcome", "JumpSimulator", "LedgeSimulator", "StartState"]

_COMPARED = ("hip_flexion", "knee_flexion", "shoulder_flexion")
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


@dataclass(frozen=True)
class StartState:
    """A person at the stance switch at which a jump begins.

    physics, control: as saved. planted: (2,) stance foot [m]. error: of the distance to the mark [m].
    """

    physics: np.ndarray
    control: np.ndarray
    planted: np.ndarray
    error: float


@dataclass(frozen=True)
class JumpOutcome:
    """What a trial showed.

    cleared: both feet were on top (behind the gap, below) and the person still runs at the end. time: share
    of the trial survived. shortfall: how far [m] the lowest foot was below the height of the edge that it
    lands behind when its toes crossed it. scrape: ticks in which something touched the face below that edge.
    steps: made behind it. speed: mean speed
    [m/s] of the last steps. drift: sideways distance [m] at the end. reaction: mean excess of the ground
    reaction above 4 body weights.
    effort: mean squared torque [(Nm)^2] over 1e4. trunk: mean squared pitch and roll of the trunk off its
    lean [rad^2]. pose: mean squared difference [rad^2] to the clip over steps 1 and 2. errors: of
    distance and speed.
    """

    cleared: bool
    time: float
    shortfall: float
    scrape: int
    steps: int
    speed: float
    drift: float
    reaction: float
    effort: float
    trunk: float
    pose: float
    errors: tuple[float, float]


class JumpSimulator:
    """A person, a plane and a stair that trials are run with; one per process."""

    def __init__(self, run: RunSkill, clip: Clip | None = None) -> None:
        self.run = run
        self.model = self._make_model()
        self.data = mujoco.MjData(self.model)
        self.index = PersonIndex.of(self.model)
        self.stair = self.model.geom("stair").id
        self.state = c.new_state()
        self.command = np.zeros(3)
        self.memory = np.zeros(jump.MEMORY_SIZE)
        shares = np.linspace(0.0, 1.0, 41)
        self.clip = (clip or jump_clip()).sample(shares)
        self.mirrored_clip = jump.mirror(self.clip)
        self.limbs = np.array([i for i, name in enumerate(c.JOINT_NAMES) if name.endswith(_COMPARED)])

    def _make_model(self) -> mujoco.MjModel:
        return trial_scene("stair")

    def place(self, edge_x: float, size: float) -> tuple[float, float]:
        """Put an obstacle of ``size`` [m] with its edge at x = ``edge_x`` [m]; gives x and height [m] of the
        edge that the person lands behind."""
        self.model.geom_pos[self.stair] = [edge_x + BOX_LENGTH / 2, 0.0, size - BOX_TOP]
        return edge_x, size

    def clear_away(self) -> None:
        """Nothing but the plane."""
        self.model.geom_pos[self.stair, 0] = 1000.0

    def begin(self, distance: float, speed: float, yaw: float = 0.0, noise: np.ndarray | None = None) -> None:
        """Run at ``speed`` [m/s] from x = -``distance``; ``noise`` (51,) as in `rollout.Scenario`."""
        start = np.array([-distance, 0.0, 0.0])
        reset_running(self.run, self.model, self.data, self.index, self.state, start, yaw, speed)
        if noise is not None:
            self.data.qvel[:6] += noise[:6]
            self.data.qpos[7:] += noise[6:45]
            mujoco.mj_forward(self.model, self.data)
            self.state[c.COM_VELOCITY] += noise[:3]
            c.observe(self.index, self.model, self.data, self.state, fresh=True)
        self.command[:] = yaw, speed, 0.0

    def _step(self) -> None:
        mujoco.mj_step(self.model, self.data, STEPS_PER_TICK)
        c.observe(self.index, self.model, self.data, self.state)

    def steer(self) -> None:
        """Hold y = 0 while running along +x: heading and sideways speed into ``command``."""
        y = self.state[c.COM.start + 1]
        self.command[HEADING_ASKED] = -float(np.clip(1.2 * y / max(self.state[c.SPEED], 1.0), -0.3, 0.3))
        self.command[SIDEWAYS_ASKED] = float(np.clip(-0.5 * y, -0.2, 0.2))

    def run_tick(self) -> None:
        """The running controller's part of a tick."""
        data = self.data
        c.run_tick(*self.run.tables, self.state, self.command, data.qpos, data.qvel, data.ctrl)

    def fit_stride(self, entry: float, rng: np.random.Generator) -> tuple[float, float, float]:
        """(a, lag, b) of step length = a v + lag (v' - v) + b [m] for a step asked for at v after one at
        v'.

        Least squares over 16 runs of 12 s in which the speed that is asked for wanders from step to
        step, within what a run-up to ``entry`` [m/s] may ask for. Every other sets off from a walk, as people
        do: their steps come out shorter for a while.
        """
        rows, lengths = [], []
        self.clear_away()
        low, high = run_up_speeds(entry, self.run)
        for number, speed in enumerate(np.linspace(low, high, 16)):
            if number % 2:
                self._set_off(np.zeros(3), float(speed))
            else:
                self.begin(0.0, float(speed))
            seen, last, asked = 0.0, None, [float(speed)] * 2
            for _ in range(1200):
                self.steer()
                self.run_tick()
                if self.state[c.STEPS] != seen:
                    seen = self.state[c.STEPS]
                    x = float(self.state[c.PLANTED.start + (3 if self.state[c.STANCE] > 0 else 0)])
                    if last is not None and seen > 3:
                        rows.append([asked[1], asked[0] - asked[1], 1.0])
                        lengths.append(x - last)
                    last = x
                    asked = [asked[1], float(np.clip(asked[1] + rng.normal(0.0, 0.2), low, high))]
                    self.command[SPEED_ASKED] = asked[1]
                self._step()
                if self.state[c.FALLEN] > 0.0:
                    break
        a, lag, b = np.linalg.lstsq(np.array(rows), np.array(lengths), rcond=None)[0]
        return float(a), float(lag), float(b)

    def harvest(
        self, skill: ClearingSkill, distances: np.ndarray, rng: np.random.Generator, standing: bool = False
    ) -> list[StartState]:
        """Run up to the mark of ``skill`` at its least height from each of ``distances`` [m]; save the states
        at which the jump begins, less those from which not even the run goes on.

        The person starts in a running pose with noise, or ``standing``, from which it walks first.
        """
        height = skill.heights[0]
        ahead = ObstacleAhead(0.0, skill.affordance, height, np.zeros(3), np.array([-1.0, 0.0, 0.0]), height)
        entry, _ = skill.approach(height)
        found = []
        self.clear_away()
        for distance in distances:
            noise = rng.normal(size=51) * np.r_[np.full(3, 0.1), np.full(3, 0.1), np.full(45, 0.02)]
            speed = rng.uniform(*np.clip([entry - 0.8, entry + 0.5], *self.run.speeds))
            if standing:
                self._set_off(np.array([-distance, rng.normal(0.0, 0.1), 0.0]), float(speed))
            else:
                self.begin(float(distance), float(speed), noise=noise)
            seen = -1.0
            for _ in range(3000):
                before = np.empty(mujoco.mj_stateSize(self.model, _STATE))
                mujoco.mj_getState(self.model, self.data, before, _STATE)
                control = self.state.copy()
                self.steer()
                self.run_tick()
                if self.state[c.STEPS] != seen:
                    seen = self.state[c.STEPS]
                    plan = plan_run_up(self.state, ahead, skill, self.run)
                    if plan.speeds.size == 0:
                        foot = c.PLANTED.start + (3 if self.state[c.STANCE] > 0 else 0)
                        planted = self.state[foot : foot + 2].copy()
                        found.append(StartState(before, control, planted, plan.takeoff_error))
                        break
                    if foot_distance(self.state, ahead) < RUN_UP:
                        self.command[SPEED_ASKED] = plan.speeds[0]
                self._step()
                if self.state[c.FALLEN] > 0.0:
                    break
        return [start for start in found if self.runs_on(start)]

    def _set_off(self, start: np.ndarray, speed: float) -> None:
        """Begin where a person that stood at ``start`` (3,) goes over from walking to running."""
        human = Human(None, self.run, clearing=(), rehearsals=0)
        human.reset(start, 0.0)
        human.follow(np.array([start, [BOX_LENGTH / 2, start[1], 0.0]]), speed)
        while human.status == "walking":
            human.tick()
        state = np.empty(mujoco.mj_stateSize(human.model, _STATE))
        mujoco.mj_getState(human.model, human.data, state, _STATE)
        mujoco.mj_setState(self.model, self.data, state, _STATE)
        self.state[:] = human.control
        self.command[:] = 0.0, speed, 0.0

    def runs_on(self, start: StartState, seconds: float = 1.5) -> bool:
        """Whether the run alone goes on from a harvested state; where it does not, no jump could."""
        self.clear_away()
        self._restore(start)
        for _ in range(round(seconds / CONTROL_DT)):
            self.steer()
            self.run_tick()
            self._step()
        return self.state[c.FALLEN] == 0.0

    def _restore(self, start: StartState) -> None:
        mujoco.mj_setState(self.model, self.data, start.physics, _STATE)
        self.state[:] = start.control
        self.command[:] = 0.0, self.state[c.SPEED], 0.0

    def trial(
        self,
        tables: LawTables,
        size: float,
        start: StartState,
        error: float,
        duration: float,
        on_tick=None,
        record: np.ndarray | None = None,
    ) -> JumpOutcome:
        """Jump from a harvested state; the obstacle of ``size`` [m] is put so that the distance misses the
        mark by ``error`` [m].

        duration: [s]. on_tick(simulator) is called after each tick. record: (4, 6, 16) sums of the
        sensors per bin and their count, added to.
        """
        edge = float(start.planted[0]) + tables.mark + error
        landing = self.place(edge, size)
        self._restore(start)
        steps = self.state[c.STEPS]
        self.command[:] = 0.0, tables.entry, 0.0
        meter = _Meter(self, *landing)
        begun = False
        ticks = round(duration / CONTROL_DT)
        for _ in range(ticks):
            if begun and self.memory[jump.ACTIVE] == 0.0:
                self.command[SIDEWAYS_ASKED] = float(np.clip(-0.5 * self.state[c.COM.start + 1], -0.2, 0.2))
            self.run_tick()
            if not begun and self.state[c.STEPS] != steps:
                begun = True
                start_jump(tables.parameters, self.memory, self.state, edge, 0.0, 1.0, 0.0)
            if begun:
                jump_tick(tables.parameters, *tables.rest, self.memory, self.state, self.data.ctrl)
            self._step()
            step = int(self.state[c.STEPS] - steps) - 1
            if record is not None and 0 <= step < jump.STEPS:
                place = min(int(self.state[c.PHASE] * (jump.BINS - 1) + 0.5), jump.BINS - 1)
                record[step, place, : jump.SENSORS] += self.memory[jump.SENSED]
                record[step, place, jump.SENSORS] += 1.0
            meter.tick(step)
            if on_tick is not None:
                on_tick(self)
            if self.state[c.FALLEN] > 0.0:
                break
        return meter.outcome(
            ticks, (float(self.memory[jump.ERROR_DISTANCE]), float(self.memory[jump.ERROR_SPEED]))
        )


class LedgeSimulator(JumpSimulator):
    """A person on a ledge, and a ledge behind it: across a gap, or lower. ``crossing``: "across" or "off"."""

    def __init__(self, run: RunSkill, clip: Clip, crossing: Crossing) -> None:
        super().__init__(run, clip)
        self._crossing = crossing
        self._ground, self._ledge = self.model.geom("ground").id, self.model.geom("ledge").id

    def _make_model(self) -> mujoco.MjModel:
        return trial_scene("stair", "ledge")

    def place(self, edge_x: float, size: float) -> tuple[float, float]:
        landing = (edge_x + size, 0.0) if self._crossing == "across" else (edge_x, -size)
        super().place(*landing)
        self.model.geom_pos[self._ledge] = [edge_x - BOX_LENGTH / 2, 0.0, -BOX_TOP]
        self.model.geom_pos[self._ground, 2] = -BOX_TOP
        return landing

    def clear_away(self) -> None:
        super().clear_away()
        self.model.geom_pos[self._ledge, 0] = -1000.0
        self.model.geom_pos[self._ground, 2] = 0.0


class _Meter:
    """Collects the figures of a trial."""

    def __init__(self, simulator: JumpSimulator, edge: float, height: float) -> None:
        self.s, self.edge, self.height = simulator, edge, height
        self.ticks = self.scrape = 0
        self.shortfall = self.reaction = self.effort = self.trunk = self.pose = 0.0
        self.pose_ticks = 0
        self.crossed = [False, False]
        self.landed = [False, False]
        self.steps_on_top = 0
        self.last_step = -1
        self.speeds: list[float] = []
        self.toes = [simulator.model.body(f"{side}_toes").id for side in ("right", "left")]

    def tick(self, step: int) -> None:
        s, data, state = self.s, self.s.data, self.s.state
        self.ticks += 1
        for k in range(2):
            toe = data.xpos[self.toes[k]]
            if not self.crossed[k] and toe[0] > self.edge - 0.05:
                self.crossed[k] = True
                lowest = min(float(toe[2]), float(data.xpos[s.index.feet[k]][2]) - 0.04)
                self.shortfall += max(self.height + 0.05 - (lowest - 0.02), 0.0)
            on_top = (
                state[layout.RIGHT_FOOT + 3 * k] > self.edge
                and state[layout.RIGHT_FOOT + 3 * k + 2] > self.height - 0.02
            )
            if on_top and state[layout.CONTACT][k] > 20.0:
                self.landed[k] = True
        if not all(self.landed):
            self.scrape += self._touches_face()
        weight = MASS * 9.81
        self.reaction += max((state[layout.RIGHT_CONTACT] + state[layout.LEFT_CONTACT]) / weight - 4.0, 0.0)
        self.effort += float(np.dot(data.actuator_force, data.actuator_force)) * 1e-4
        up = data.xmat[s.index.chest]
        self.trunk += (up[2] - 0.1) ** 2 + 2.0 * up[5] ** 2
        if 1 <= step <= 2:
            mirrored = (state[c.STANCE] > 0) == (step == 1)
            clip = s.mirrored_clip if mirrored else s.clip
            row = clip[round(20.0 * (step - 1 + state[c.PHASE]))]
            self.pose += float(np.mean((data.qpos[7:][s.limbs] - row[s.limbs]) ** 2))
            self.pose_ticks += 1
        if step != self.last_step:
            self.last_step = step
            if all(self.landed):
                self.steps_on_top += 1
                self.speeds.append(float(state[c.STEP_SPEED]))

    def _touches_face(self) -> int:
        """Whether anything touches the stair below its top with a force that pushes back."""
        data = self.s.data
        if data.ncon == 0:
            return 0
        contact = data.contact
        mine = (contact.geom == self.s.stair).any(axis=1)
        if not mine.any():
            return 0
        low = (contact.pos[:, 2] < self.height - 0.03) & (np.abs(contact.frame[:, 0]) > 0.5)
        return int((mine & low).any())

    def outcome(self, ticks: int, errors: tuple[float, float]) -> JumpOutcome:
        state, n = self.s.state, max(self.ticks, 1)
        shortfall = self.shortfall + sum(0.3 for crossed in self.crossed if not crossed)
        fallen = state[c.FALLEN] > 0.0
        return JumpOutcome(
            cleared=all(self.landed) and not fallen,
            time=(self.ticks - (1 if fallen else 0)) / ticks,
            shortfall=shortfall,
            scrape=self.scrape,
            steps=self.steps_on_top,
            speed=float(np.mean(self.speeds[-3:])) if self.speeds else 0.0,
            drift=abs(float(state[c.COM.start + 1])),
            reaction=self.reaction / n,
            effort=self.effort / n,
            trunk=self.trunk / n,
            pose=self.pose / max(self.pose_ticks, 1),
            errors=errors,
        )
