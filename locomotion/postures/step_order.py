"""Which step follows: the locomotion part of a posture graph.

Its nodes are steps, in which a figure never stays: as long as it moves, one step follows the other, left and
right by turns. So nothing has to be searched for; what follows depends on the speed alone (Granieri, Crabtree
and Badler 1995, figure 3). A gait begins in a posture and ends in it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import kernel

__all__ = ["AT_REST", "Gait", "following", "gait_for", "gait_table", "gaits_for", "step_name"]

AT_REST = 0.05
"""[m/s] below which a figure counts as at rest."""


@dataclass(frozen=True)
class Gait:
    """A way to move.

    Attributes:
        name: such as "walk". posture: number of the posture in which it begins and ends.
        steps: those of a cycle, in their order, such as "left", "right".
        slowest, fastest: [m/s] between which it is gone on with. backwards: whether it moves backwards.
    """

    name: str
    posture: int
    steps: tuple[str, ...]
    slowest: float
    fastest: float
    backwards: bool = False


def step_name(gait: Gait, step: int) -> str:
    """What the node of a step is called, such as "walk left"; of a gait of one step as the gait is."""
    return f"{gait.name} {gait.steps[step]}" if len(gait.steps) > 1 else gait.name


def gaits_for(
    gaits: tuple[Gait, ...], now: NDArray[np.int32], posture: NDArray[np.int32], speed: NDArray[np.float64]
) -> NDArray[np.int32]:
    """The gait of each of n figures: (n,) int32, -1 for one at rest, and for one whose ``posture`` (n,) has
    to change before it can move.

    A figure goes on with the gait that it has ``now`` (n,; -1: none) while its ``speed`` (n,) [m/s, below 0
    backwards] allows it. Otherwise the first gait of its posture and direction that is fast enough, or else
    the fastest.
    """
    table, chosen = gait_table(gaits), np.empty(len(now), np.int32)
    # of other types the kernel would be compiled once more
    now, posture, speed = (
        np.asarray(now, np.int32),
        np.asarray(posture, np.int32),
        np.asarray(speed, np.float64),
    )
    _choose_all(table, now, posture, speed, chosen)
    return chosen


def gait_table(gaits: tuple[Gait, ...]) -> NDArray[np.float64]:
    """(g, 4) of each gait its posture, slowest, fastest, and 1 for one backwards, as `gait_for` takes it."""
    rows = [[gait.posture, gait.slowest, gait.fastest, float(gait.backwards)] for gait in gaits]
    return np.array(rows, np.float64).reshape(-1, 4)


@kernel
def gait_for(table, now, posture, speed):
    """Kernel of `gaits_for`, for one figure."""
    pace, back = abs(speed), 1.0 if speed < 0.0 else 0.0
    if pace <= AT_REST:
        return -1
    if now >= 0:
        goes_on = table[now, 0] == posture and table[now, 3] == back
        if goes_on and table[now, 1] <= pace <= table[now, 2]:
            return now
    chosen, most = -1, 0.0  # the fastest of those found so far, none of which is fast enough
    for number in range(table.shape[0]):
        if table[number, 0] != posture or table[number, 3] != back:
            continue
        if pace <= table[number, 2]:
            return number
        if table[number, 2] > most:
            chosen, most = number, table[number, 2]
    return chosen


@kernel
def _choose_all(table, now, posture, speed, chosen):
    for n in range(len(now)):
        chosen[n] = gait_for(table, now[n], posture[n], speed[n])


def following(
    postures: tuple[str, ...], gaits: tuple[Gait, ...], least: NDArray[np.float64], node: str, speed: float
) -> str:
    """The node after ``node``, a posture or a step, of a figure that moves at ``speed`` [m/s, below 0
    backwards].

    Of one at rest the posture that it is in, or in which its gait ends; of one that moves the next step, or,
    from a posture in which no such gait begins, the nearest posture in which one does. ``least`` (p, p) [s]:
    between postures, as of `locomotion.postures.posture_graph.PostureGraph`. A node without such a way stays.
    """
    steps = {step_name(gait, k): (g, k) for g, gait in enumerate(gaits) for k in range(len(gait.steps))}
    number, step = steps.get(node, (-1, -1))
    here = gaits[number].posture if number >= 0 else postures.index(node)
    if abs(speed) <= AT_REST:
        return postures[here]
    gait = int(
        gaits_for(gaits, np.array([number], np.int32), np.array([here], np.int32), np.array([speed]))[0]
    )
    if gait >= 0:
        return step_name(gaits[gait], (step + 1) % len(gaits[gait].steps))
    begins = {each.posture for each in gaits if each.backwards == (speed < 0.0)}
    there = min(sorted(begins), key=lambda posture: least[here, posture], default=here)
    return postures[there] if np.isfinite(least[here, there]) else postures[here]
