"""A stretch of a recorded motion becomes a clip of keyframes that a skill can be learned from."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.clip import load_clip
from locomotion.clips.keyframes import keyframes_of, mirrored, save_clip, stretch_of
from locomotion.clips.motion import Motion, lowest_points, motion_of_clip
from locomotion.errors import LocomotionError
from locomotion.skills.jump.skill import JUMP_CLIP


@pytest.fixture(scope="module")
def jump():
    return motion_of_clip(load_clip(JUMP_CLIP))


def test_written_and_read_again_it_is_the_motion_within_a_degree(jump, tmp_path):
    save_clip(keyframes_of(jump), tmp_path / "again.yaml")
    again = load_clip(tmp_path / "again.yaml")
    shares = np.linspace(0.0, 1.0, len(jump.qpos))
    off = np.rad2deg(np.abs(again.sample(shares) - jump.qpos[:, 7:]))
    assert off.max() < 1.6  # what is written is rounded, and joints nearly at zero are left out
    assert (again.name, again.cyclic) == ("jump", False)
    assert again.duration == pytest.approx(jump.duration, abs=1e-3)
    assert again.speed == pytest.approx(3.5, abs=0.01)
    assert np.rad2deg(again.root_pitch) == pytest.approx(3.0, abs=0.1)
    keys = sum(map(len, again.channels.values()))
    assert keys < 0.25 * len(jump.qpos) * len(again.channels)


def test_a_stretch_is_what_lies_between(jump):
    part = stretch_of(jump, 0.3, 0.6)
    first, last = round(0.3 * jump.rate), round(0.6 * jump.rate)
    assert np.array_equal(part.qpos, jump.qpos[first : last + 1])
    assert keyframes_of(part).duration == pytest.approx(0.3, abs=1.0 / jump.rate)
    for begin, end in ((0.5, 0.5), (0.6, 0.3), (-0.1, 0.3), (0.5, 9.0), (0.3, float("nan")), (0.3, 0.3001)):
        with pytest.raises(LocomotionError, match=r"not within|less than a frame"):
            stretch_of(jump, begin, end)


def test_mirrored_the_left_side_does_what_the_right_did_and_it_stands_as_high(jump):
    other = mirrored(jump)
    right, left = (7 + JOINT_NAMES.index(f"{side}_hip_flexion") for side in ("right", "left"))
    assert np.array_equal(other.qpos[:, left], jump.qpos[:, right])
    assert lowest_points(other.qpos) == pytest.approx(lowest_points(jump.qpos), abs=1e-9)
    assert np.array_equal(mirrored(other).qpos, jump.qpos)


def test_a_motion_without_motion_is_refused():
    qpos = np.zeros((5, 7 + len(JOINT_NAMES)))
    qpos[:, 3] = 1.0
    with pytest.raises(LocomotionError, match="nothing to play"):
        keyframes_of(Motion("stands", 60.0, qpos))
