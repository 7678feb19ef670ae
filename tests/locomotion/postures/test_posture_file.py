"""Posture files: what they make, and what is said where one is wrong."""

import numpy as np
import pytest

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import Motion
from locomotion.postures.arcs import pose_of
from locomotion.postures.posture_file import check_posture_file, load_postures
from surefoot.files.yamlfile import FileError

GRAPH = """\
postures:
  stand: {both: {shoulder_abduction: 8}}
  bow: {both: {shoulder_abduction: 8}, joints: {waist_pitch: 40}}
arcs:
  - {from: stand, to: bow, seconds: 0.5, keys: [{at: 0.5, like: bow, joints: {waist_pitch: 10}}]}
  - {from: bow, to: stand, backwards: true}
"""


KEYED = "seconds: 0.5, keys: [{at: 0.5, like: bow, joints: {waist_pitch: 10}}]"


def written(tmp_path, text):
    file = tmp_path / "graph.yaml"
    file.write_text(text)
    return file


def test_a_file_becomes_a_graph(tmp_path):
    graph = load_postures(written(tmp_path, GRAPH))
    assert graph.name == "graph" and graph.postures == ("stand", "bow") and graph.fatal == -1
    waist = 7 + JOINT_NAMES.index("waist_pitch")
    np.testing.assert_allclose(np.degrees(graph.poses[:, waist]), [0.0, 40.0])
    assert graph.seconds.tolist() == [0.5, 0.5] and graph.backwards.tolist() == [False, True]
    frames = graph.frames[: graph.count[0]]
    assert np.degrees(frames[(len(frames) - 1) // 2, waist]) == pytest.approx(10.0)
    np.testing.assert_allclose(frames[[0, -1], 7:], graph.poses[:, 7:], atol=1e-12)


def test_the_part_that_it_stands_on_stays_in_its_place(tmp_path):
    text = GRAPH.replace("joints: {waist_pitch: 40}", "joints: {left_hip_flexion: 60, left_knee_flexion: 60}")
    graph = load_postures(
        written(tmp_path, text.replace("seconds: 0.5", "seconds: 0.5, standing_on: left_foot"))
    )
    assert graph.moves[0, 0] < -0.05  # the pelvis moves back over the foot
    np.testing.assert_allclose(graph.moves[1, :2], -graph.moves[0, :2], atol=1e-12)


def test_a_recorded_motion_is_an_arc_wherever_it_was_recorded(tmp_path):
    frames = np.tile(pose_of({"right_shoulder_abduction": 8, "left_shoulder_abduction": 8}, 0, 0), (31, 1))
    waist = 7 + JOINT_NAMES.index("waist_pitch")
    frames[:, waist] = np.radians(np.linspace(0, 40, 31))
    frames[:, :2] = np.array([5.0, -3.0]) + np.linspace(0, 1, 31)[:, None] * [0.0, 0.6]
    frames[:, 3], frames[:, 6] = np.cos(np.pi / 4), np.sin(np.pi / 4)  # towards +y
    Motion("bow", 30.0, frames).save(tmp_path / "bow.npz")
    text = GRAPH.replace(KEYED, "motion: bow.npz")
    graph, faults = check_posture_file(written(tmp_path, text))
    assert not faults
    assert graph.seconds[0] == pytest.approx(1.0)
    np.testing.assert_allclose(graph.moves[0], [0.6, 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("to: bow", "to: bough", ":5:23: no posture is called 'bough'; valid: stand, bow"),
        ("waist_pitch: 40", "waist_pich: 40", r"no joint is called 'waist_pich'; did you mean 'waist_pitch'"),
        ("shoulder_abduction: 8}, j", "sholder_abduction: 8}, j", "no joint is called 'right_sholder_abd"),
        ("waist_pitch: 40", "waist_pitch: 400", ":3:62: "),
        ("to: bow, seconds: 0.5", "to: stand, seconds: 0.5", "an arc leads to another posture"),
        ("at: 0.5", "at: 1.5", ":5:"),
        ("seconds: 0.5", "seconds: 0", ":5:"),
        ("seconds: 0.5", "seconds: 0.5, standing_on: leftfoot", "no part is called 'leftfoot'; did you mean"),
        ("to: stand, backwards: true", "to: stand", "an arc has seconds, or a motion, or is backwards"),
        ("from: bow, to: stand", "from: stand, to: bow", "there is no arc from 'bow' to 'stand'"),
        ("seconds: 0.5, keys", "motion: bow.npz, keys", "keys go with seconds"),
        ("arcs:", "fatal: dead\narcs:", ":4:8: no posture is called 'dead'"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_place(tmp_path, old, new, says):
    assert old in GRAPH
    with pytest.raises(FileError, match=says):
        load_postures(written(tmp_path, GRAPH.replace(old, new, 1)))
