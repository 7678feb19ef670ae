"""Keyframe clips: sampling and the errors of a wrong file."""

from pathlib import Path

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES, build_person
from locomotion.clips.clip import load_clip
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RUN_CLIP

GOOD = """
name: nod
cyclic: false
duration: 2.0
speed: 0.0
root: {height: 0.9, pitch: 0}
channels:
  neck_pitch: [[0.0, 0], [0.5, 20], [1.0, 0]]
"""


def test_run_clip_is_periodic_and_mirrored() -> None:
    clip = load_clip(RUN_CLIP)
    shares = np.linspace(0.0, 1.0, 50, endpoint=False)
    angles, later = clip.sample(shares), clip.sample(shares + 1.0)
    np.testing.assert_allclose(angles, later, atol=1e-12)
    half = clip.sample(shares + 0.5)
    for i, name in enumerate(JOINT_NAMES):
        if name.startswith("right_"):
            np.testing.assert_allclose(
                angles[:, i], half[:, JOINT_NAMES.index("left_" + name[6:])], atol=1e-12
            )


def test_run_clip_stays_within_the_joints() -> None:
    model = build_person()
    angles = load_clip(RUN_CLIP).sample(np.linspace(0.0, 1.0, 200))
    low, high = model.jnt_range[1:].T
    assert (angles >= low - 1e-9).all() and (angles <= high + 1e-9).all()


def test_arms_swing_against_the_legs() -> None:
    angles = load_clip(RUN_CLIP).sample(np.linspace(0.0, 1.0, 100))
    arm, leg = (angles[:, JOINT_NAMES.index(n)] for n in ("right_shoulder_flexion", "right_hip_flexion"))
    assert np.corrcoef(arm, leg)[0, 1] < -0.6


def test_rates_are_the_slope_of_the_samples() -> None:
    clip = load_clip(RUN_CLIP)
    at = np.array([0.13, 0.4, 0.77])
    step = 1e-5
    slope = (clip.sample(at + step) - clip.sample(at - step)) / (2 * step * clip.duration)
    np.testing.assert_allclose(clip.rates(at), slope, rtol=1e-2, atol=0.05)


def test_a_clip_that_does_not_repeat_holds_its_ends(tmp_path: Path) -> None:
    path = tmp_path / "nod.yaml"
    path.write_text(GOOD)
    angles = load_clip(path).sample(np.array([-1.0, 0.5, 2.0]))[:, JOINT_NAMES.index("neck_pitch")]
    np.testing.assert_allclose(np.rad2deg(angles), [0.0, 20.0, 0.0], atol=1e-9)


def test_brackets_within_brackets_are_no_clip(tmp_path: Path) -> None:
    path = tmp_path / "deep.yaml"
    for depth in (500, 50_000):
        path.write_text("[" * depth + "]" * depth)
        with pytest.raises(LocomotionError, match=r"nested (more than 50 levels deep|too deeply for a clip)"):
            load_clip(path)


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match=r"none\.yaml"):
        load_clip(tmp_path / "none.yaml")
