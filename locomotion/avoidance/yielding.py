"""Giving way: how a body that follows a path avoids others.

A body that needs room to turn cannot take any velocity at any time, as optimal reciprocal collision avoidance
requires (`locomotion.crowd`). It chooses among its options: slower paces, and paths that swing out to one
side ahead, as sharply as it can turn, and come back. Each option is predicted for `HORIZON` seconds along
with the others' predictions, and the cheapest is taken; of equal ones, that to the right. Bodies choose one
after the other, knowing the others' choices, so that two do not step aside to the same side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import allocating_kernel, kernel

__all__ = ["HORIZON", "SPACING", "Course", "first_meeting", "foretell", "meetings"]

HORIZON = 4.5
"""[s] length of a prediction."""
STEP = 0.1
"""[s] between predicted places."""
SPACING = 0.1
"""[m] between the points of a course."""
COUNT = round(HORIZON / STEP)
TURNING_SPEED = 0.5
"""[m/s] below which a body starts to turn on the spot."""
AT_FIRST = 10
"""Steps within which a body can hardly change where it is."""
AT_ONCE = 1.0 / STEP
"""[1/s] eagerness of a body that changes its speed as hard as it can until the end."""
HARD = 0.5
"""[m/s] from which a body that runs into another bears all the blame."""


@dataclass(frozen=True)
class Course:
    """What a body that follows a path is about to do.

    Attributes:
        points: (k, 3) float64 [m] the path from the body on, every `SPACING`.
        speeds: (k,) float64 [m/s] at which it wants to pass them if nobody is in the way.
        speed: [m/s] now.
        pace: present share of ``speeds``.
        length: [m] from its rearmost point, which follows the path, to its front.
        reach: [m] by which it extends beyond the last point at the end.
        radius: [m].
        acceleration, braking: [m/s²] at most.
        eagerness: [1/s] factor from a difference of speed to one of these, up to `AT_ONCE`.
        slowest: [m/s] its slowest speed short of a halt; 0: it halts as easily as it slows down.
        sharpest: [1/m] sharpest curve it can take.
        begins: [m] ahead where a change of its path may begin.
        aside: whether its path may be changed.
        whole: whether the last point is its goal.
        stops: [m] it needs for a stop.
        turns: [s] that it turns on the spot, once slow enough, before it goes on.
        nose: [m] of ``length`` in front of its foremost disc.
    """

    points: NDArray[np.float64]
    speeds: NDArray[np.float64]
    speed: float
    pace: float
    length: float
    reach: float
    radius: float
    acceleration: float
    braking: float
    eagerness: float
    slowest: float
    sharpest: float
    begins: float
    aside: bool
    whole: bool
    stops: float
    turns: float = 0.0
    nose: float = 0.0


@kernel
def foretell(
    points, speeds, speed, pace, slowest, acceleration, braking, eagerness, length, reach, turns, places
):  # fmt: skip
    """Write where a body is every `STEP` from now on into ``places`` (COUNT, discs, 2): its discs lie from
    its rear to its front. points (k, 2+), speeds (k,): as in `Course`."""
    count, discs = places.shape[0], places.shape[1]
    last = points.shape[0] - 1
    end, arc = last + reach / SPACING, 0.0
    for k in range(count):
        for d in range(discs):
            ahead = arc + (length * d / (discs - 1) if discs > 1 else 0.0)
            at = min(max(ahead / SPACING, 0.0), end)
            i = min(int(at), max(last - 1, 0))
            w = at - i
            j = min(i + 1, last)
            places[k, d, 0] = (1.0 - w) * points[i, 0] + w * points[j, 0]
            places[k, d, 1] = (1.0 - w) * points[i, 1] + w * points[j, 1]
        wanted = max(pace * speeds[min(int(arc / SPACING), last)], slowest) if pace > 0.0 else 0.0
        if turns > 1e-9:
            wanted = 0.0
            if speed <= TURNING_SPEED:
                turns -= STEP
        change = min(max(eagerness * (wanted - speed), -braking), acceleration) * STEP
        before, speed = speed, max(speed + change, 0.0)
        arc = min(arc + 0.5 * (before + speed) * STEP, max(end * SPACING - length, 0.0))


@kernel
def first_meeting(own, own_radius, others, other_radius, room):
    """The number of the first step at which a disc of ``own`` (n, d, 2) comes nearer to one of ``others``
    (n, m, 2) than both radii and ``room`` [m], and nearer than if it stayed where it is; n when none does.
    The first at which it touches one, and how deep it comes to lie in one, as a share of both radii, less
    where it is slower than `HARD`: who all but stands is run into, and is not to run itself for that; the
    foremost of several discs is its head, which gives in. Who is run into from behind, or where it stands,
    has not come near. Discs that lie in each other from the beginning do not count: those of a long body, so
    that the one in front gets away; one alone only for `AT_FIRST` steps, in which it can halt."""
    count = own.shape[0]
    first, touches, deepest = count, count, 0.0
    body, long = max(own.shape[1] - 1, 1), own.shape[1] > 1
    for k in range(1, count):
        for d in range(own.shape[1]):
            for m in range(others.shape[1]):
                x, y = own[k, d, 0] - others[k, m, 0], own[k, d, 1] - others[k, m, 1]
                both = own_radius + other_radius[m]
                far = x * x + y * y
                if far >= (both + room) * (both + room):
                    continue
                x, y = own[k - 1, d, 0] - others[k, m, 0], own[k - 1, d, 1] - others[k, m, 1]
                if far < x * x + y * y - 1e-9:
                    x, y = own[0, d, 0] - others[0, m, 0], own[0, d, 1] - others[0, m, 1]
                    if x * x + y * y < both * both and (long or k < AT_FIRST):
                        continue
                    first = min(first, k)
                    if far < both * both:
                        touches = min(touches, k)
                        if d < body:
                            x, y = own[k, d, 0] - own[k - 1, d, 0], own[k, d, 1] - own[k - 1, d, 1]
                            hard = min(math.sqrt(x * x + y * y) / (HARD * STEP), 1.0)
                            deepest = max(deepest, hard * (1.0 - math.sqrt(far) / both))
    return first, touches, deepest


@allocating_kernel
def meetings(places, velocities, heights, followers, slack, storey):
    """Which of the bodies at ``places`` (n, 2) [m] come near to each of ``followers`` (f,) if all go straight
    on: (f, n) bool."""
    n = places.shape[0]
    near = np.zeros((followers.size, n), np.bool_)
    for f in range(followers.size):
        i = followers[f]
        for j in range(n):
            if j == i or abs(heights[j] - heights[i]) > storey:
                continue
            x, y = places[j, 0] - places[i, 0], places[j, 1] - places[i, 1]
            vx, vy = velocities[j, 0] - velocities[i, 0], velocities[j, 1] - velocities[i, 1]
            speed = vx * vx + vy * vy
            when = 0.0
            if speed > 1e-9:
                when = min(max(-(x * vx + y * vy) / speed, 0.0), HORIZON)
            x, y = x + when * vx, y + when * vy
            near[f, j] = x * x + y * y < slack * slack
    return near
