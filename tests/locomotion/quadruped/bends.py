"""A path in bends, and an animal of a herd on it."""

import numpy as np

from locomotion.quadruped import Herd, lay_trail
from tests.locomotion.quadruped.scenes import plane

BEND = np.column_stack([
    np.linspace(0.0, 7.0, 141), 0.6 * np.sin(1.3 * np.linspace(0.0, 7.0, 141)), np.zeros(141),
])  # fmt: skip


def follow(body, speed, points=BEND, gait=None):
    ground = plane()
    herd = Herd(ground)
    trail = lay_trail(points, body, ground)
    index = herd.add(body, points[0], trail.heading(0.0))
    herd.follow(index, trail, speed, gait=gait)
    return herd, index, trail
