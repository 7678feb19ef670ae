"""The text of a BVH file: what it says, and which line of a broken one is wrong."""

import numpy as np
import pytest

from locomotion.clips.bvh_file import read_bvh_file
from locomotion.errors import LocomotionError
from tests.locomotion.clips.tpose import bvh_text

TEXT = bvh_text([{}, {}])
SMALL = """HIERARCHY
ROOT hip
{
  OFFSET 1 2 3
  CHANNELS 4 Xposition Zposition Yrotation Xrotation
  JOINT knee
  {
    OFFSET 0 -4.5e1 0
    CHANNELS 1 Zrotation

    End Site
    {
      OFFSET 0 -40 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
1 2 3 4 5
-1 -2 -3 -4 6e1
"""


def test_joints_channels_and_frames_are_those_of_the_file(tmp_path):
    path = tmp_path / "small.bvh"
    path.write_text(SMALL)
    found = read_bvh_file(path)
    assert (found.names, found.parents) == (["hip", "knee"], [-1, 0])
    assert found.offsets == [[1.0, 2.0, 3.0], [0.0, -45.0, 0.0]]
    assert found.channels == [["Xposition", "Zposition", "Yrotation", "Xrotation"], ["Zrotation"]]
    assert found.frame_time == 0.04
    assert np.array_equal(found.frames, [[1, 2, 3, 4, 5], [-1, -2, -3, -4, 60]])


def test_a_joint_after_a_closed_one_hangs_on_its_own_parent(tmp_path):
    path = tmp_path / "whole.bvh"
    path.write_text(TEXT)
    found = read_bvh_file(path)
    above = {
        name: found.names[parent]
        for name, parent in zip(found.names, found.parents, strict=True)
        if name != "Hips"
    }
    assert above["LeftFoot"] == "LeftLeg" and above["RightUpLeg"] == "Hips" and above["RightArm"] == "Chest"


@pytest.mark.parametrize(
    ("broken", "says"),
    [
        ("", "1: not a whole BVH file: it ends where HIERARCHY is expected"),
        ("HIERARCHY\nROOT", "2: expected a name after ROOT"),
        ("HIERARCHY\nROOT Hips", "2: not a whole BVH file: it ends where { is expected"),
        (TEXT[: TEXT.index("JOINT Head")], "it ends where } is expected"),
        ("MOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0\n", "must begin with HIERARCHY, not 'MOTION'"),
        (TEXT.replace("HIERARCHY", "TREE"), "must begin with HIERARCHY, not 'TREE'"),
        (TEXT.replace("}", "", 1), "expected JOINT, End Site or }, not 'MOTION'"),
        (TEXT.replace("MOTION", "}\nMOTION"), "expected MOTION"),
        (TEXT.replace("ROOT", "JOINT"), "2: expected ROOT and a name, not 'JOINT Hips'"),
        (TEXT.replace("OFFSET 0 12 0", "OFFSET 0 12"), "expected OFFSET of 'Spine' and three numbers"),
        (TEXT.replace("OFFSET 0 12 0", "OFFSET 0 nan 0"), "the OFFSET of Spine: expected a number .* 'nan'"),
        (TEXT.replace("3 Zrotation", "4 Zrotation", 1), "expected CHANNELS of 'Spine'"),
        (TEXT.replace("3 Zrotation", "3 zrotation", 1), "channel 'zrotation', which is none; valid: Xpos"),
        (TEXT.replace("3 Zrotation", "3 Xrotation", 1), "channel 'Xrotation', twice"),
        (TEXT[: TEXT.index("Frame Time")], "it ends where Frame Time: is expected"),
        (TEXT.replace("Frames: 2", "Frames: 0"), "expected Frames: and how many"),
        (TEXT.replace("Frames: 2", f"Frames: {'9' * 5000}"), "expected Frames: and how many"),
        (TEXT.replace("Frames: 2", "Frames: 1000000"), "take 278 minutes; a capture has at most 10"),
        (TEXT.replace("Frames: 2", "Frames: 100"), "it ends where frame 3 of 100 is expected"),
        (TEXT.replace(" 0.000000000\n", "\n", 1), "frame 1 of 2 has 50 numbers; its joints have 51 channels"),
        (TEXT.replace(" 90.000000000", " 1e39", 1), "Hips Yposition in frame 1 of 2: .* not '1e39'"),
        (TEXT.replace(" 90.000000000", " tall", 1), "Hips Yposition in frame 1 of 2: .* not 'tall'"),
        (TEXT.replace(" 0.000000000\n", " nan\n", 1), "RightFoot Yrotation in frame 1 of 2: .* 'nan'"),
    ],
)
def test_a_broken_file_is_refused_where_it_breaks(tmp_path, broken, says):
    path = tmp_path / "broken.bvh"
    path.write_text(broken)
    with pytest.raises(LocomotionError, match=says):
        read_bvh_file(path)


def test_a_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "bytes.bvh").write_bytes(bytes(range(256)))
    with pytest.raises(LocomotionError, match="not a BVH file"):
        read_bvh_file(tmp_path / "bytes.bvh")


@pytest.mark.parametrize("time", ["0", "-0.03", "nan", "inf", "33.3", "1e-9", "fast", ""])
def test_frames_come_at_a_rate_that_there_is(tmp_path, time):
    path = tmp_path / "odd.bvh"
    path.write_text(TEXT.replace("0.0166667", time))
    with pytest.raises(
        LocomotionError, match=r"odd\.bvh:\d+: expected Frame Time: .* from 0\.0001 to 1, not"
    ):
        read_bvh_file(path)


def test_lines_end_where_they_do_for_who_reads_the_file(tmp_path):
    """A form feed ends no line: two rows with one between them counted as two, and reading never ended."""
    text = TEXT
    head, first, second = text[:-1].rsplit("\n", 2)
    path = tmp_path / "feed.bvh"
    path.write_text(f"{head}\n{first}\f{second}\n")
    with pytest.raises(LocomotionError, match="frame 1 of 2 has 102 numbers"):
        read_bvh_file(path)
