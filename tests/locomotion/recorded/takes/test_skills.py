"""Skills as clips."""

import numpy as np

from locomotion.postures.places import placed
from locomotion.recorded.motion_set import Clip, load_motions
from locomotion.recorded.takes.skills import take_of_ticks


def test_ticks_become_a_take_that_begins_at_the_origin():
    qpos = np.zeros((101, 46))
    qpos[:, 0], qpos[:, 2], qpos[:, 3] = np.linspace(0.0, 2.0, 101), 0.9, 1.0
    somewhere = np.array([placed(frame, np.array([5.0, -3.0, 2.5])) for frame in qpos])
    forces = np.where(np.arange(101)[:, None] < 50, [300.0, 0.0], [0.0, 300.0])
    clip = Clip(name="go", kind="skill", origin="test", seconds=5.0)
    take = take_of_ticks(clip, somewhere, forces)
    assert take.clip.seconds == 1.0 and len(take.qpos) == 61
    assert np.allclose(take.clip.travel, [2.0, 0.0, 0.0])
    assert np.allclose(
        take.qpos[:, :3], np.stack([np.linspace(0, 2, 61), 0 * take.qpos[:, 0], 0.9 + 0 * take.qpos[:, 0]], 1)
    )
    assert take.stance[0].tolist() == [True, False] and take.stance[-1].tolist() == [False, True]


def test_the_package_has_every_skill_with_its_obstacle():
    motions = load_motions()
    for name in ("jump", "vault", "drop", "gap"):
        ahead, height, depth = motions.clips[motions.clip(name)].obstacle
        assert 0.0 < ahead < motions.clips[motions.clip(name)].travel[0]
        assert height > 0.0 or depth > 0.0
    for way in ("forward", "backward"):
        clip = motions.clip(f"get up after a fall {way}")
        heights = motions.levels[0].roots[motions.levels[0].first[clip] :][: motions.levels[0].count[clip], 2]
        assert heights.min() < 0.4 and heights[-1] > 0.7
