"""Grounds, and people who are pushed over, for the tests of falls."""

import math

import numpy as np

from locomotion import MOVING, Ground, Human
from locomotion.body_events import Event

WAY = np.array([[x, 0.0, 0.0] for x in np.arange(0.0, 30.0)])


def plane(slope: float) -> Ground:
    """A square of 80 m that rises towards x."""
    half, rise = 40.0, 40.0 * slope
    corners = [[-half, -half, -rise], [half, -half, rise], [half, half, rise], [-half, half, -rise]]
    return Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.atan(slope))


def push_over(human: Human, direction: float, speed: float) -> None:
    """Let it go for 3 s, then push its chest for 0.25 s."""
    human.events.clear()
    human.reset((0, 0, 0), 0.0)
    human.follow(WAY, speed)
    for tick in range(325):
        pushed = tick >= 300
        force = 650.0 * np.array([math.cos(direction), math.sin(direction), 0.0])
        human.data.xfrc_applied[human.index.chest, :3] = force if pushed else 0.0
        human.tick()
    human.data.xfrc_applied[:] = 0.0


def go_on(human: Human, seconds: float, until: type[Event] | None = None) -> None:
    for _ in range(round(100 * seconds)):
        if human.status not in MOVING or (until and any(isinstance(event, until) for event in human.events)):
            return
        human.tick()
