"""One simulated trial of running: commands, pushes and ground in, figures out."""

import math
from dataclasses import dataclass, field

import mujoco
import numpy as np

from locomotion.body.person import CONTROL_DT, MASS, STEPS_PER_TICK, PersonIndex, build_person
from locomotion.body.physics import restore_physics
from locomotion.gaits.run import controller as c
from locomotion.gaits.run import layout
from locomotion.gaits.run.skill import RunSkill, reset_running
from locomotion.paths.command import HEADING_ASKED, SLOPE_THERE, SPEED_ASKED
from locomotion.training.gaits.walk_starts import walk_starts
from surefoot.kernels import allocating_kernel

__all__ = ["FIGURES", "Measures", "Scenario", "Simulator", "Trial", "stays_up"]

FIGURES = (
    "time",
    "speed_error",
    "heading_error",
    "side_drift",
    "reaction",
    "effort",
    "head",
    "step_rate",
    "trunk",
    "speed",
    "peak",
    "turn",
    "landing",
)
"""Figures that a trial measures; see `Trial`."""
_WEIGHT = MASS * 9.81
_G = 9.81
_SOFT = 2.8  # [body weights]


@dataclass(frozen=True)
class Scenario:
    """What one trial asks for.

    Attributes:
        duration: [s].
        speeds: (k, 2) float64, rows of time [s] and desired speed [m/s].
        headings: (h, 2) float64, rows of time [s] and desired turn rate [rad/s].
        pushes: (j, 4) float64, rows of time [s], force x, y [N] on the chest in the world, length [s].
        tilt: (2,) float64, slope of the plane along x and y [rise over run].
        walking: which of `walk_starts.walk_starts`, along x, it starts from; None: from a running pose.
        start_noise: (51,) float64 added to the start: root velocity (3), root angular velocity (3), 39
            joints' angles [rad], 6 spare; empty for none.
        yaw: heading at the start [rad].
    """

    duration: float
    speeds: np.ndarray
    headings: np.ndarray = field(default_factory=lambda: np.zeros((1, 2)))
    pushes: np.ndarray = field(default_factory=lambda: np.zeros((0, 4)))
    tilt: tuple[float, float] = (0.0, 0.0)
    walking: int | None = None
    start_noise: np.ndarray = field(default_factory=lambda: np.zeros(0))
    yaw: float = 0.0


@dataclass
class Trial:
    """Outcome of a trial: the figures by name of `FIGURES`, and the final state for hashing.

    time [s] survived; mean absolute errors of speed, off the reference speed, which follows the one asked for
    [m/s], and heading [rad]; mean lateral speed off the heading [m/s]; reaction: mean excess of the ground
    reaction above 3 body weights; effort: mean squared torque [(Nm)^2] over 1e4;
    head: mean squared acceleration of the head [g^2]; step_rate [1/s]; trunk: mean squared tilt [rad^2];
    speed: mean [m/s]; peak: highest reaction [body weights]; turn: turning per step [rad]; landing: root mean
    square, over the steps, of how far the highest reaction of each exceeds 2.8 body weights.
    """

    figures: dict[str, float]
    state: np.ndarray


def stays_up(trial: Trial, duration: float) -> bool:
    """Whether a trial of ``duration`` [s] did not end before."""
    return trial.figures["time"] > duration - 1.5 * CONTROL_DT


@allocating_kernel
def _measure(sums, state, head, past, forces, chest):
    """Add one tick to ``sums``; ``past`` (8,): head at the last two ticks, ticks seen, and the highest
    reaction of the present step [body weights]."""
    h = state[layout.HEADING]
    ch, sh = math.cos(h), math.sin(h)
    vx = ch * state[layout.VELOCITY_X] + sh * state[layout.VELOCITY_Y]
    vy = -sh * state[layout.VELOCITY_X] + ch * state[layout.VELOCITY_Y]
    sums[0] += 1.0
    sums[1] += vx
    sums[2] += abs(vy)
    reaction = (state[layout.RIGHT_CONTACT] + state[layout.LEFT_CONTACT]) / _WEIGHT
    sums[3] += max(reaction - 3.0, 0.0)
    sums[10] = max(sums[10], reaction)
    if state[layout.STEP_TIME] == 0.0:
        sums[12] += max(past[7] - _SOFT, 0.0) ** 2
        sums[13] += 1.0
        past[7] = 0.0
    past[7] = max(past[7], reaction)
    effort = 0.0
    for k in range(forces.shape[0]):
        effort += forces[k] * forces[k]
    sums[4] += effort * 1e-4
    if past[6] >= 2.0:
        acc = 0.0
        for k in range(3):
            a = (head[k] - 2.0 * past[3 + k] + past[k]) / (CONTROL_DT * CONTROL_DT) / _G
            acc += a * a
        sums[5] += acc
    for k in range(3):
        past[k] = past[3 + k]
        past[3 + k] = head[k]
    past[6] += 1.0
    tilt_x = ch * chest[2] + sh * chest[5] - 0.10
    tilt_y = -sh * chest[2] + ch * chest[5]
    sums[6] += tilt_x * tilt_x + 2.0 * tilt_y * tilt_y
    fy = -sh * chest[0] + ch * chest[3]
    sums[7] += fy * fy
    sums[8] += abs(math.atan2(-sh * state[layout.VELOCITY_X] + ch * state[layout.VELOCITY_Y], max(vx, 0.5)))
    if state[layout.SPEED] > 0.0 and state[layout.STEP_TIME] == 0.0 and state[layout.STEPS] > 1.0:
        sums[9] += abs(state[layout.STEP_SPEED] - state[layout.SPEED])
        sums[11] += 1.0


def _at(schedule: np.ndarray, time: float) -> float:
    """Value of the last row of ``schedule`` whose time has come."""
    return float(schedule[max(int(np.searchsorted(schedule[:, 0], time, side="right")) - 1, 0), 1])


class Measures:
    """Sums up what `FIGURES` name, tick by tick."""

    def __init__(self, data: mujoco.MjData, index: PersonIndex) -> None:
        self._sums, self._past = np.zeros(14), np.zeros(8)
        self._head, self._chest = data.xpos[index.head], data.xmat[index.chest]
        self._forces = data.actuator_force

    def add(self, state: np.ndarray) -> None:
        """Add a tick."""
        _measure(self._sums, state, self._head, self._past, self._forces, self._chest)

    def figures(self, state: np.ndarray, ticks: int, turned: float = 0.0) -> dict[str, float]:
        """The figures after ``ticks`` and ``turned`` [rad] in all."""
        sums = self._sums
        n, steps = max(sums[0], 1.0), max(sums[11], 1.0)
        time = ticks * CONTROL_DT
        if state[c.FALLEN] > 0.0:
            time -= CONTROL_DT
        return {
            "time": time,
            "speed_error": sums[9] / steps,
            "heading_error": sums[8] / n + np.sqrt(sums[7] / n) * 0.5,
            "side_drift": sums[2] / n,
            "reaction": sums[3] / n,
            "effort": sums[4] / n,
            "head": sums[5] / n,
            "step_rate": state[c.STEPS] / max(time, CONTROL_DT),
            "trunk": sums[6] / n,
            "speed": sums[1] / n,
            "peak": sums[10],
            "turn": turned / steps,
            "landing": math.sqrt(sums[12] / max(sums[13], 1.0)),
        }


class Simulator:
    """A person on a plane for running trials; one per process. ``steps``: physics steps in a control tick;
    fewer than the product's train faster."""

    def __init__(self, steps: int = STEPS_PER_TICK) -> None:
        self.model, self._steps = build_person(), steps
        self.model.opt.timestep = CONTROL_DT / steps
        self.data = mujoco.MjData(self.model)
        self.index = PersonIndex.of(self.model)
        self.ground = self.model.geom("ground").id
        self.model.geom_sameframe[self.ground] = (
            mujoco.mjtSameFrame.mjSAMEFRAME_NONE
        )  # so that tilting it has an effect
        self.state = c.new_state()

    def _tilt(self, slope: tuple[float, float]) -> None:
        normal = np.array([-slope[0], -slope[1], 1.0])
        normal /= np.linalg.norm(normal)
        quat = np.array([1.0 + normal[2], -normal[1], normal[0], 0.0])
        self.model.geom_quat[self.ground] = quat / np.linalg.norm(quat)

    def start(self, skill: RunSkill, scenario: Scenario) -> None:
        """Put the person at the origin as ``scenario`` describes."""
        self._tilt(scenario.tilt)
        origin = np.zeros(3)
        if scenario.walking is not None:
            walked = walk_starts()[scenario.walking]
            restore_physics(self.model, self.data, walked.physics)
            self.state[:], speed = walked.running, walked.speed
        else:
            speed = _at(scenario.speeds, 0.0)
            reset_running(skill, self.model, self.data, self.index, self.state, origin, scenario.yaw, speed)
        if any(scenario.tilt):
            self._lift(scenario.tilt)
        if scenario.start_noise.size:
            noise = scenario.start_noise
            self.data.qvel[:6] += noise[:6]
            self.data.qpos[7:] += noise[6:45]
            mujoco.mj_forward(self.model, self.data)
            self.state[c.COM_VELOCITY] += noise[:3]
            c.observe(self.index, self.model, self.data, self.state, fresh=True)

    def _lift(self, slope: tuple[float, float]) -> None:
        """Raise a person placed into the slope until it only touches it, and let it move along the slope."""
        velocity = self.data.qvel[:2]
        self.data.qvel[2] += float(np.dot(slope, velocity))
        self.state[c.COM_VELOCITY][2] = self.data.qvel[2]
        depth = min(float(self.data.contact.dist.min()) if self.data.ncon else 0.0, 0.0)
        self.data.qpos[2] -= depth
        mujoco.mj_forward(self.model, self.data)
        c.observe(self.index, self.model, self.data, self.state, fresh=True)

    def run(self, skill: RunSkill, scenario: Scenario, on_tick=None) -> Trial:
        """Simulate ``scenario``; ``on_tick(simulator)`` is called after every tick."""
        model, data, state, index = self.model, self.data, self.state, self.index
        self.start(skill, scenario)
        command = np.array([scenario.yaw, 0.0, 0.0, 0.0])
        measures = Measures(data, index)
        ticks = round(scenario.duration / CONTROL_DT)
        tables, qpos, qvel, ctrl = skill.tables, data.qpos, data.qvel, data.ctrl
        push, turned = data.xfrc_applied[index.chest], 0.0
        tick = 0
        events = np.unique(np.concatenate([scenario.speeds[:, 0], scenario.headings[:, 0]]))
        changes = set(np.round(events / CONTROL_DT).astype(int).tolist()) | {0}
        turn = 0.0
        for tick in range(ticks):
            time = tick * CONTROL_DT
            if tick in changes:
                command[SPEED_ASKED], turn = (
                    _at(scenario.speeds, time + 1e-9),
                    _at(scenario.headings, time + 1e-9),
                )
            command[HEADING_ASKED] += turn * CONTROL_DT
            turned += abs(turn) * CONTROL_DT
            heading = state[c.HEADING]
            command[SLOPE_THERE] = scenario.tilt[0] * math.cos(heading) + scenario.tilt[1] * math.sin(heading)
            if len(scenario.pushes):
                push[:2] = 0.0
                for start, fx, fy, length in scenario.pushes:
                    if start <= time < start + length:
                        push[0], push[1] = fx, fy
            c.run_tick(*tables, state, command, qpos, qvel, ctrl)
            mujoco.mj_step(model, data, self._steps)
            c.observe(index, model, data, state)
            measures.add(state)
            if on_tick is not None:
                on_tick(self)
            if state[c.FALLEN] > 0.0:
                break
        push[:2] = 0.0
        figures = measures.figures(state, tick + 1, turned)
        return Trial(figures, np.concatenate([data.qpos, data.qvel, state]))
