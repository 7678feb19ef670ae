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


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("neck_pitch", "nose_pitch", "8:3: no joint is called 'nose_pitch'; did you mean 'neck_pitch'"),
        ("[1.0, 0]]", "[0.4, 0]]", "neck_pitch: shares must grow, .* 0.4 follows 0.5"),
        ("[1.0, 0]]", "[0.5000000001, 0]]", "grow"),
        ("[1.0, 0]]", "[1.0, .nan]]", r"neck_pitch\[2\]\[1\]: must be a number .* degrees, not nan"),
        ("[1.0, 0]]", "[1.0, 1080]]", "from -360 to 360 degrees, not 1080"),
        ("[1.0, 0]]", "[1.5, 0]]", "from 0 to 1 .share of the duration., not 1.5"),
        ("[1.0, 0]]", "[1.0, 0, 0]]", "at most 2"),
        ("[1.0, 0]]", "5]", r"must be a pair \[share of the duration, degrees\], not 5"),
        ("[0.5, 20]", f"[0.5, {'9' * 400}]", r"9{30,}\.\.\. has 400 characters"),
        ("[0.5, 20]", f"[0.5, {'9' * 5000}]", r"9{30,}\.\.\. has 5000 characters"),
        ("[[0.0, 0], [0.5, 20], [1.0, 0]]", "[]", "0 keyframes; at least 1"),
        ("\n  neck_pitch: [[0.0, 0], [0.5, 20], [1.0, 0]]", " {}", "channels"),
        ("duration: 2.0", "duration: -1", "duration"),
        (
            "duration: 2.0",
            "duration: 2000 ",
            "4:11: duration: must be a number from 0.001 to 120 s, not 2000",
        ),
        ("duration: 2.0", "duration: 1.0e+9", "from 0.001 to 120 s"),
        ("duration: 2.0", f"duration: {'9' * 400}", "has 400 characters"),
        ("duration: 2.0", "duration: true", "from 0.001 to 120 s, not True"),
        ("speed: 0.0", "speed: 350", "speed: must be a number from 0 to 20 m/s, not 350"),
        ("height: 0.9", "height: 92", "root.height: must be a number from 0 to 3 m, not 92"),
        ("pitch: 0", "pitch: 1.0e+6", "root.pitch: must be a number from -180 to 180 degrees, not 1000000"),
        ("height: 0.9, ", "height: 0.9, heigth: 0.9, ", "root.heigth: unknown key; did you mean 'height'"),
        ("height: 0.9, ", "height: 0.9, height: 0.9, ", "'height' appears twice here"),
        ("speed: 0.0", "speed: 0.0\nspeed: 1.0", "6:1: 'speed' appears twice here"),
        ("name: nod", "nam: nod", "unknown key; did you mean 'name'"),
        ("cyclic: false", "cyclic: [", "YAML"),
        ("cyclic: false", 'cyclic: "no"', "cyclic: Input should be a valid boolean, not 'no'"),
        ("cyclic: false", "mirrored: 1", "mirrored: Input should be a valid boolean, not 1"),
        ("cyclic: false", "mirrored: true", "mirrored clip is cyclic"),
        ("cyclic: false", "cyclic: true", "last share must be below 1"),
        ("speed: 0.0\n", "", "speed: missing"),
    ],
)
def test_wrong_files_are_refused(tmp_path: Path, old: str, new: str, says: str) -> None:
    path = tmp_path / "clip.yaml"
    assert old in GOOD
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(LocomotionError, match=says):
        load_clip(path)


def test_numbers_that_yaml_takes_for_text_are_numbers(tmp_path: Path) -> None:
    path = tmp_path / "nod.yaml"
    path.write_text(GOOD.replace("[0.5, 20]", "[1e-1, 2e1]"))
    assert load_clip(path).sample(np.array([0.1]))[0, JOINT_NAMES.index("neck_pitch")] == np.deg2rad(20.0)


def test_brackets_within_brackets_are_no_clip(tmp_path: Path) -> None:
    path = tmp_path / "deep.yaml"
    for depth in (500, 50_000):
        path.write_text("[" * depth + "]" * depth)
        with pytest.raises(LocomotionError, match=r"nested (more than 50 levels deep|too deeply for a clip)"):
            load_clip(path)


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LocomotionError, match=r"none\.yaml"):
        load_clip(tmp_path / "none.yaml")
