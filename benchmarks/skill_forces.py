"""What the skills do to the body: forces, contacts, joints and limbs, at every physics step.

    python -m benchmarks.skill_forces [--only jump vault drop gap] [--starts 10] [--seed 1] [--rehearsals 0]

People start from a stand, 9 to 16 m away, for the lowest, the middle and the highest size of each skill;
walls are 0.3 m thick. Of those who stay on their feet the median and the worst, from a second before the
take-off until two seconds after the obstacle:

hand: impulse [Ns] that bears the person on a hand or forearm; pull: that holds its hand down. peak: hardest
reaction of the ground [body weights] after the take-off. head: hardest acceleration [g], over 5 ms. sunk:
deepest contact [mm]. through: how far [mm] limbs are in each other that are apart in the stand. beyond: how
far [deg] a joint is beyond its limits. speed: [m/s] two seconds after the obstacle.

Below: which limbs, joints and parts of the body it was, and how often.
"""

import argparse
from collections import Counter
from dataclasses import dataclass
from itertools import combinations

import mujoco
import numpy as np
from numpy.typing import NDArray

from benchmarks.gait_record import tick_in_steps
from locomotion import MOVING, Human
from locomotion.body.person import JOINT_NAMES, MASS, TIMESTEP
from locomotion.body_events import Cleared, TookOff
from locomotion.gaits.run.layout import COM_VELOCITY
from locomotion.skills.registry import skill_kinds
from runtime.evaluation.courses import enter_course, make_course
from runtime.evaluation.evaluation import WALL, start_noise

FIGURES = ("hand", "pull", "peak", "head", "sunk", "through", "beyond", "speed")
WHERE = ("through", "beyond", "sunk")
_BEFORE, _AFTER = round(1.0 / TIMESTEP), round(2.0 / TIMESTEP)  # steps
_LONGEST = 40.0  # [s]
_JOLT = 2  # steps over which an acceleration is taken
_FAR = 0.3  # [m] beyond which distances of limbs are not worked out


@dataclass(frozen=True)
class Step:
    """A physics step. reaction: of the ground [N]. by_hand: upward force on hands and forearms [N], negative
    if it pulls. head (3,): its velocity [m/s]. sunk, through [m], beyond [rad]: the worst, each with what it
    was."""

    reaction: float
    by_hand: float
    head: NDArray[np.float64]
    sunk: tuple[float, str]
    through: tuple[float, str]
    beyond: tuple[float, str]


class Meter:
    """Simulates the ticks of a person once more, step by step, and notes what happens."""

    def __init__(self, human: Human) -> None:
        self.human, self.steps = human, list[Step]()
        self._model, self._data = human.model, mujoco.MjData(human.model)
        self._limbs = limbs_apart(human.model)
        bodies = human.index.bodies
        self._hands = [bodies[f"{side}_{part}"] for side in ("right", "left") for part in ("hand", "forearm")]

    def tick(self) -> None:
        """A tick of the person."""
        tick_in_steps(self.human, self._data, lambda: self.steps.append(self._step()))

    def _step(self) -> Step:
        model, data, contact = self._model, self._data, self._data.contact
        pushes = contact.efc_address >= 0
        forces = data.efc_force[contact.efc_address[pushes][:, None] + np.arange(4)].sum(axis=1)
        depths = -contact.dist[pushes]
        bodies = model.geom_bodyid[contact.geom[pushes]].max(axis=1)  # the level's geoms belong to body 0
        upward = forces * np.abs(contact.frame[pushes][:, 2])
        held = data.efc_force[2 : data.ne : 3].sum()  # the world's pull at hands that hold on
        head = np.empty(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, self.human.index.head, head, 0)
        deepest = int(np.argmax(depths)) if len(depths) else None
        low, high = model.jnt_range[1:].T
        angles = data.qpos[7:46]
        beyond = np.maximum(low - angles, angles - high)
        joint = int(np.argmax(beyond))
        return Step(
            reaction=float(forces.sum()),
            by_hand=float(upward[np.isin(bodies, self._hands)].sum() - held),
            head=head[3:],
            sunk=(0.0, "") if deepest is None else (depths[deepest], model.body(bodies[deepest]).name),
            through=self._through(),
            beyond=(beyond[joint], JOINT_NAMES[joint]),
        )

    def _through(self) -> tuple[float, str]:
        model = self._model
        apart = [mujoco.mj_geomDistance(model, self._data, a, b, _FAR, None) for a, b in self._limbs]
        nearest = int(np.argmin(apart))
        names = [model.body(model.geom_bodyid[geom]).name for geom in self._limbs[nearest]]
        return -apart[nearest], " in ".join(names)


def limbs_apart(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Pairs of a person's geoms that do not touch in the stand, of bodies that no joint joins."""
    data, parent = mujoco.MjData(model), model.body_parentid
    mujoco.mj_kinematics(model, data)
    own = np.flatnonzero((model.geom_conaffinity > 0) & (model.geom_bodyid > 0)).tolist()
    pairs = []
    for a, b in combinations(own, 2):
        i, j = model.geom_bodyid[a], model.geom_bodyid[b]
        joined = i == j or parent[i] == j or parent[j] == i
        if not joined and mujoco.mj_geomDistance(model, data, a, b, _FAR, None) > 0.0:
            pairs.append((a, b))
    return pairs


def measure(
    affordance: str, size: float, distance: float, seed: int, rehearsals: int
) -> dict[str, tuple[float, str]] | None:
    """The figures of one start, each with what it was; None if the person did not get over the obstacle and
    stay on its feet."""
    course = make_course([(affordance, size, WALL)], [distance])
    human = enter_course(course, None, start_noise(seed, distance), rehearsals)
    meter, off, over = Meter(human), None, None
    while human.status in MOVING and human.time < _LONGEST:
        meter.tick()
        for event in human.events:
            if isinstance(event, TookOff) and off is None:
                off = len(meter.steps)
            if isinstance(event, Cleared) and over is None:
                over = len(meter.steps)
        human.events.clear()
        if over is not None and len(meter.steps) >= over + _AFTER:
            break
    if off is None or over is None or human.status not in MOVING:
        return None
    after, around = meter.steps[off:], meter.steps[max(off - _BEFORE, 0) :]
    by_hand = np.array([step.by_hand for step in after]) * TIMESTEP
    head = np.array([step.head for step in after])
    jolts = np.linalg.norm(head[_JOLT:] - head[:-_JOLT], axis=1) / (_JOLT * TIMESTEP * 9.81)
    through, beyond, sunk = (max(getattr(step, name) for step in around) for name in WHERE)
    return {
        "hand": (float(np.maximum(by_hand, 0.0).sum()), ""),
        "pull": (float(np.maximum(-by_hand, 0.0).sum()), ""),
        "peak": (max(step.reaction for step in after) / (MASS * 9.81), ""),
        "head": (float(jolts.max()), ""),
        "sunk": (1000.0 * max(sunk[0], 0.0), sunk[1]),
        "through": (1000.0 * max(through[0], 0.0), through[1]),
        "beyond": (float(np.degrees(max(beyond[0], 0.0))), beyond[1]),
        "speed": (float(np.hypot(*human.control[COM_VELOCITY][:2])), ""),
    }


def main() -> None:
    """Measure every size, print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = {kind.affordance: kind for kind in skill_kinds()}
    parser.add_argument("--only", nargs="+", choices=list(kinds), default=list(kinds))
    parser.add_argument("--starts", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--rehearsals", type=int, default=0)
    asked = parser.parse_args()
    rng = np.random.default_rng(asked.seed)
    print("       size [m]  on feet" + "".join(f"{name:>16}" for name in FIGURES))
    for name in asked.only:
        low, high = kinds[name].sizes
        for size in (low, 0.5 * (low + high), high):
            starts = rng.uniform(9.0, 16.0, asked.starts)
            tried = [measure(name, size, d, asked.seed, asked.rehearsals) for d in starts]
            held = [each for each in tried if each is not None]
            line = f"{name:6}  {size:7.2f}  {len(held):3d}/{len(tried):<3d}"
            for key in FIGURES if held else ():
                values = [each[key][0] for each in held]
                worst = min(values) if key in ("hand", "speed") else max(values)
                line += f"  {np.median(values):6.1f} {worst:7.1f}"
            print(line, flush=True)
            for key in WHERE:
                counts = Counter(each[key][1] for each in held)
                print(f"        {key}: " + ", ".join(f"{what} {n}" for what, n in counts.most_common()))


if __name__ == "__main__":
    main()
