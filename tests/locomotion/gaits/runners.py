"""People who run, for the tests of how they come to a stand."""

import numpy as np

from locomotion import Ground, Human

WAY = np.array([[0.0, 0.0, 0.0], [60.0, 0.0, 0.0]])


def running(ticks: int, speed: float = 3.0, rehearsals: int = 16, ground: Ground | None = None) -> Human:
    human = Human(ground, clearing=(), rehearsals=rehearsals)
    human.reset(WAY[0], 0.0, speed)
    human.follow(WAY, speed)
    for _ in range(ticks):
        human.tick()
    return human


def way_of_stop(human: Human) -> float:
    """Tick until it rests; how far it comes [m]."""
    begun, far = human.com, 0.0
    human.stop()
    while not human.held:
        human.tick()
        far = max(far, float(human.com[0] - begun[0]))
    return far
