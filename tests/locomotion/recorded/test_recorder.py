"""Making sets of recorded motions."""

import numpy as np

from locomotion.recorded.motion_set import Clip
from locomotion.recorded.recorder import motion_set_of
from locomotion.recorded.skeletons import LEVELS
from locomotion.recorded.takes.take import Take


def standing(count=1):
    qpos = np.zeros((count, 46))
    qpos[:, 2], qpos[:, 3] = 0.9, 1.0
    return qpos


def test_each_level_keeps_its_rate():
    clip = Clip(name="wait", kind="skill", origin="test", seconds=2.0)
    found = motion_set_of([Take(clip, standing(121), np.zeros((121, 2), np.bool_))]).motions
    assert [int(level.count[0]) for level in found.levels] == [121, 61, 31]
    assert [level.channels.shape[1] for level in found.levels] == [39, 22, 17]
    assert len(found.levels) == len(LEVELS)
