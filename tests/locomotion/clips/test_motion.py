"""Motions of the person, pose by pose, and their files."""

import numpy as np
import pytest

from locomotion.clips.clip import load_clip
from locomotion.clips.motion import Motion, load_motion, lowest_points, motion_of_clip
from locomotion.clips.motion_check import check_motion
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RUN_CLIP


def test_a_clip_of_keyframes_is_a_motion_on_the_ground(tmp_path):
    clip = load_clip(RUN_CLIP)
    motion = motion_of_clip(clip)
    assert motion.grounded and motion.duration == pytest.approx(clip.duration)
    assert np.abs(lowest_points(motion.qpos)).max() < 1e-9
    assert motion.qpos[-1, 0] == pytest.approx(clip.speed * clip.duration)
    assert check_motion(motion) == []
    motion.save(tmp_path / "run.npz")
    again = load_motion(tmp_path / "run.npz")
    assert (again.name, again.rate, again.grounded) == (motion.name, motion.rate, True)
    assert np.array_equal(again.qpos, motion.qpos)
    for rate, turned in ((0.0, motion.qpos), (np.inf, motion.qpos), (60.0, motion.qpos.astype(np.float32))):
        Motion("odd", rate, turned).save(tmp_path / "odd.npz")
        with pytest.raises(
            LocomotionError, match=r"odd\.npz: not a whole motion.* (1 to 10000 Hz|float64|not finite)"
        ):
            load_motion(tmp_path / "odd.npz")
    whole = (tmp_path / "run.npz").read_bytes()
    (tmp_path / "run.npz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(LocomotionError, match=r"run\.npz"):
        load_motion(tmp_path / "run.npz")
