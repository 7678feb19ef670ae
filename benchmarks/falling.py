"""What falls do to people, measured at every physics step of 2.5 ms.

    python -m benchmarks.falling [--falls 36] [--seed 0]

On a plane they stand, walk at 1.25 m/s or run at 3.5 m/s, and are pushed at the waist with 300 to 600 N for
0.15 to 0.35 s from one of twelve sides; pushes without a fall do not count. For those pushed forward, to a
side, or backward (90, 180 and 90 degrees), those who fall out of each gait, and all: median, nine of ten, and
worst of

hands, arms, head, seat, trunk, knees: hardest force [body weights] on both hands, fore and upper arms, the
head, the pelvis, waist and chest with the shoulders, thighs and shanks; and the impulse [body weights times
seconds] on the first five, until 1.5 s after the fall was noticed. jolt: hardest acceleration of the head
[g], over 5 ms. energy: of motion [J] when something else than feet touches the ground first. warning: [s]
from when the fall is noticed to then.
"""

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import mujoco
import numpy as np
from numpy.typing import NDArray

from benchmarks.gait_record import tick_in_steps
from locomotion import Human
from locomotion.body.anatomy import MASS
from locomotion.body.person import CONTROL_DT, TIMESTEP
from locomotion.body_events import Fell
from locomotion.gaits.policy.skill import load_policy

SPEEDS = {"stand": 0.0, "walk": 1.25, "run": 3.5}
SIDES = 12
PARTS = ("hands", "arms", "head", "seat", "trunk", "knees")
WATCHED = 1.5  # [s] after a fall was noticed
_JOLT = 2  # steps over which an acceleration is taken
_WEIGHT = MASS * 9.81
_WAY = np.array([[x, 0.0, 0.0] for x in np.arange(0.0, 80.0)])


@dataclass
class FallSeen:
    """A fall: gait; ``side`` to which it was pushed [rad from ahead]; ``forces`` (n, 6) [N] on `PARTS`;
    ``head`` (n, 3) its velocity [m/s]; ``energy`` [J] and ``warning`` [s] of the first touch."""

    gait: str
    side: float
    forces: list[NDArray[np.float64]] = field(default_factory=list)
    head: list[NDArray[np.float64]] = field(default_factory=list)
    energy: float = math.nan
    warning: float = math.nan

    @property
    def kind(self) -> str:
        """Forward, sideways or backward."""
        ahead = math.cos(self.side)
        return "sideways" if abs(ahead) < 0.6 else "forward" if ahead > 0.0 else "backward"

    def figures(self) -> dict[str, float]:
        """The figures of the table."""
        forces, head = np.array(self.forces) / _WEIGHT, np.array(self.head)
        jolts = np.linalg.norm(head[_JOLT:] - head[:-_JOLT], axis=1) / (_JOLT * TIMESTEP * 9.81)
        peaks, impulses = forces.max(axis=0), forces.sum(axis=0) * TIMESTEP
        out = {part: float(peak) for part, peak in zip(PARTS, peaks, strict=True)}
        out |= {f"{part} [s]": float(whole) for part, whole in zip(PARTS[:5], impulses, strict=False)}
        return out | {"jolt": float(jolts.max()), "energy": self.energy, "warning": self.warning}


def part_of_body(human: Human) -> NDArray[np.int64]:
    """(nbody,) number in `PARTS` of each body, -1 for feet and the world."""
    out = np.full(human.model.nbody, -1)
    words = {"hand": 0, "forearm": 1, "upper_arm": 1, "head": 2, "pelvis": 3, "waist": 4, "chest": 4,
             "clavicle": 4, "thigh": 5, "shank": 5}  # fmt: skip
    for name, body in human.index.bodies.items():
        for word, part in words.items():
            if name == word or name in (f"right_{word}", f"left_{word}"):
                out[body] = part
    return out


class Watch:
    """Notes a fall step by step."""

    def __init__(self, human: Human) -> None:
        self.human, self._twin, self._parts = human, mujoco.MjData(human.model), part_of_body(human)

    def tick(self, seen: FallSeen) -> None:
        """A tick of the person; ``seen`` gets its steps."""
        tick_in_steps(self.human, self._twin, lambda: self._note(seen))

    def _note(self, seen: FallSeen) -> None:
        model, data = self.human.model, self._twin
        contact, forces, head = data.contact, np.zeros(len(PARTS)), np.empty(6)
        bears = contact.efc_address >= 0
        amounts = data.efc_force[contact.efc_address[bears][:, None] + np.arange(4)].sum(axis=1)
        parts = self._parts[model.geom_bodyid[contact.geom[bears]].max(axis=1)]
        np.add.at(forces, parts[parts >= 0], amounts[parts >= 0])
        if math.isnan(seen.energy) and forces.any():
            momentum = np.empty(model.nv)
            mujoco.mj_mulM(model, data, momentum, data.qvel)
            seen.energy, seen.warning = 0.5 * float(momentum @ data.qvel), len(seen.forces) * TIMESTEP
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, self.human.index.head, head, 0)
        seen.forces.append(forces)
        seen.head.append(head[3:])


def start(human: Human, gait: str, lasts: float) -> None:
    """Let it stand, walk or run straight ahead for so many seconds."""
    human.events.clear()
    human.reset((0, 0, 0), 0.0)
    if SPEEDS[gait] > 0.0:
        human.follow(_WAY, SPEEDS[gait])
    for _ in range(round(lasts / CONTROL_DT)):
        human.tick()


def falls(human: Human, count: int, rng: np.random.Generator) -> Iterator[FallSeen]:
    """``count`` falls, a third out of each gait and the same number from each side as far as they make it
    fall; sides whose pushes it withstands are tried again with other forces."""
    watch, tries = Watch(human), 0
    while count > 0:
        gait = list(SPEEDS)[tries % 3]
        side = 2.0 * math.pi * ((tries // 3) % SIDES) / SIDES
        tries += 1
        start(human, gait, rng.uniform(3.0, 6.0) if gait != "stand" else 1.0)
        newtons = rng.uniform(300.0, 600.0) * np.array([math.cos(side), math.sin(side), 0.0])
        lasts, since = rng.uniform(0.15, 0.35), human.ticks
        human.push(newtons, lasts)
        seen = FallSeen(gait, side)
        while human.ticks - since < 4.0 / CONTROL_DT:
            fell = next((each for each in human.events if isinstance(each, Fell)), None)
            if fell is None:
                human.tick()
            else:
                watch.tick(seen)
                if human.time > fell.time + WATCHED:
                    count -= 1
                    yield seen
                    break


def table(seen: list[FallSeen]) -> str:
    """What happened, as lines of text."""
    lines = []
    names = ("forward", "sideways", "backward", *SPEEDS, "all")
    for name in names:
        group = [each for each in seen if name in (each.kind, each.gait, "all")]
        if not group:
            continue
        rows = [each.figures() for each in group]
        touched = np.mean([row["head"] > 0.0 for row in rows])
        lines.append(f"{name}: {len(group)} falls, the head touches in {100 * touched:.0f} %")
        for key in rows[0]:
            values = np.array([row[key] for row in rows])
            line = (np.nanmedian(values), np.nanquantile(values, 0.9), np.nanmax(values))
            lines.append(f"    {key:10}" + "".join(f"{value:9.2f}" for value in line))
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--falls", type=int, default=36)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    human = Human(None, clearing=(), gets_up=True, policy=load_policy())
    print(table(list(falls(human, options.falls, np.random.default_rng(options.seed)))))


if __name__ == "__main__":
    main()
