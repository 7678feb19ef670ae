"""Which step follows: the locomotion part of a posture graph.

Its nodes are steps, in which a figure never stays: as long as it moves, one step follows the other, left and
right by turns. So nothing has to be searched for; what follows depends on the speed alone (Granieri, Crabtree
and Badler 1995, figure 3). A gait begins in a posture and ends in it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["AT_REST", "Gait", "following", "gaits_for", "step_name"]

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
    chosen = np.full(len(now), -1, np.int32)
    pace, back = np.abs(speed), speed < 0.0
    most = np.zeros(len(now))  # the fastest limit among what was found, where none is fast enough
    fits = np.zeros(len(now), np.bool_)
    for number, gait in enumerate(gaits):
        can = (posture == gait.posture) & (back == gait.backwards) & (pace > AT_REST)
        enough = can & (pace <= gait.fastest) & ~fits
        fastest_yet = can & ~fits & (gait.fastest > most)
        chosen[enough | fastest_yet] = number
        most[fastest_yet] = gait.fastest
        fits |= enough
    for number, gait in enumerate(gaits):
        goes_on = (now == number) & (posture == gait.posture) & (back == gait.backwards) & (pace > AT_REST)
        chosen[goes_on & (pace >= gait.slowest) & (pace <= gait.fastest)] = number
    return chosen


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
