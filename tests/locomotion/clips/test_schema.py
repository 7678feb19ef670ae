"""Errors of a keyframe file say where its mistake is and what would be right."""

from pathlib import Path

import pytest

from locomotion.clips.clip import load_clip
from locomotion.clips.schema import ClipFile
from locomotion.errors import LocomotionError

GOOD = """
name: nod
cyclic: false
duration: 2.0
speed: 0.0
root: {height: 0.9, pitch: 0}
channels:
  neck_pitch: [[0.0, 0], [0.5, 20], [1.0, 0]]
"""


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


def test_numbers_that_yaml_takes_for_text_are_numbers() -> None:
    """YAML 1.1 reads 1e-1 as text."""
    found = ClipFile.model_validate(
        {
            "duration": "2e0",
            "speed": 0,
            "root": {"height": "9e-1", "pitch": 0},
            "channels": {"neck_pitch": [["1e-1", "2e1"]]},
        }
    )
    assert (found.duration, found.root.height) == (2.0, 0.9)
    assert found.channels == {"neck_pitch": [(0.1, 20.0)]}
