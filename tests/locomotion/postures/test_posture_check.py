"""What is found wrong with a posture graph, and where in its file."""

import pytest

from locomotion.clips.motion import Motion
from locomotion.postures.posture_file import check_posture_file, load_postures
from tests.locomotion.postures.test_playback import PERSON
from tests.locomotion.postures.test_posture_file import GRAPH, KEYED, written


def test_nothing_is_wrong_with_the_package_s_own_postures():
    graph, faults = check_posture_file(PERSON)
    assert faults == []
    assert {"stand", "crouch", "kneel", "prone", "sit", "dead"} <= set(graph.postures)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("arcs:", "  alone: {}\narcs:", "'alone' cannot be reached: no arc leads to it"),
        ("  - {from: bow, to: stand, backwards: true}", "", "'bow' cannot be left"),
        ("waist_pitch: 40", "waist_pitch: 80", "waist_pitch is up to 30 deg beyond its range"),
        ("like: bow, joints: {waist_pitch: 10}", "both: {hip_flexion: 60, shoulder_abduction: 8}", "sinks"),
    ],
)
def test_a_fault_is_found_where_it_is(tmp_path, old, new, says):
    assert old in GRAPH
    text = GRAPH.replace(old, new, 1)
    if says == "sinks":  # the other leg is stretched into the ground
        text = text.replace("seconds: 0.5", "seconds: 0.5, standing_on: pelvis")
        text = text.replace(
            "both: {hip_flexion: 60", "joints: {left_ankle_flexion: -50}, both: {hip_flexion: 0"
        )
    file = written(tmp_path, text)
    _, faults = check_posture_file(file)
    assert any(says in str(fault) and str(fault).startswith(f"{file}:") for fault in faults), faults


def test_a_recording_that_does_not_end_in_its_posture_is_found(tmp_path):
    graph = load_postures(written(tmp_path, GRAPH))
    Motion("half", 60.0, graph.frames[: graph.count[0] // 2]).save(tmp_path / "half.npz")
    text = GRAPH.replace(KEYED, "motion: half.npz")
    _, faults = check_posture_file(written(tmp_path, text))
    assert any("does not meet 'bow' where it ends: waist_pitch is" in str(fault) for fault in faults)
