"""A skill that takes notes, a ground, and how a person is brought to its end."""

import numpy as np

from locomotion.body.arm_reach import hand_place
from locomotion.body.hand_hold import hold
from locomotion.ground.ground import Ground
from locomotion.human.state import MOVING
from locomotion.skills.interface import foot_distance

STRAIGHT = np.array([[0.0, 0, 0], [15, 0, 0]])


class Recorder:
    """A skill that notes where it starts and goes on running for 0.5 s."""

    affordance, ends = "jump", "running"
    heights = (0.3, 0.5)
    stride = (0.17, 0.09, 0.39)

    def __init__(self, trips=False, holds=False):
        self.distances, self.trips, self.holds = [], trips, holds

    def approach(self, height, depth=0.0):
        return 3.0, 0.6

    def start(self, obstacle, state):
        self.distances.append(foot_distance(state, obstacle))
        return np.zeros(1)

    def tick(self, obstacle, memory, state, data):
        memory[0] += 1
        if self.holds:
            hold(data, 1.0, hand_place(data.qpos, 1.0))
        return bool(memory[0] >= 50)

    def fell(self, memory, state):
        return self.trips and memory[0] > 20


def flat_ground(half=30.0):
    corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0.0]])
    return Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]])


def finish(human, limit=60.0):
    lateral = []
    while human.status in MOVING and human.time < limit:
        human.tick()
        lateral.append(abs(human.lateral_error))
    return np.array(lateral)
