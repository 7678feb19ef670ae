"""Objects in the hands: nodes and arcs that come from one description."""

import numpy as np
import pytest

from locomotion.postures.held_objects import node_name, parts_of
from locomotion.postures.playback import asked_for, at_rest, pose_at
from locomotion.postures.posture_file import check_posture_file, load_postures
from surefoot.files.yamlfile import FileError
from tests.locomotion.postures.test_playback import person
from tests.locomotion.postures.test_posture_file import GRAPH, written

HELD = (
    GRAPH
    + """\
objects:
  lamp:
    states:
      deployed: {seconds: 0.4, joints: {right_elbow_flexion: 90}, in: {stand: {}, bow: {}}}
      in use: {seconds: 0.2, joints: {right_elbow_flexion: 20}, in: {stand: {joints: {neck_yaw: 10}}}}
"""
)


def test_each_state_is_a_node_of_each_posture_that_it_goes_with(tmp_path):
    graph, faults = check_posture_file(written(tmp_path, HELD))
    assert not faults
    assert graph.postures[2:] == ("stand/lamp deployed", "bow/lamp deployed", "stand/lamp in use")
    arcs = {(graph.postures[a], graph.postures[b]) for a, b in zip(graph.start, graph.end, strict=True)}
    assert ("stand/lamp deployed", "stand/lamp in use") in arcs and ("stand", "stand/lamp in use") not in arcs
    assert ("stand/lamp deployed", "bow/lamp deployed") in arcs  # as without it, with the arm as it holds it
    # 0.2 s back to deployed, 0.5 s down
    least = graph.least[graph.postures.index("stand/lamp in use"), graph.postures.index("bow/lamp deployed")]
    assert least == pytest.approx(0.7)


def test_an_object_is_held_all_along_a_change_of_posture():
    graph = person()
    elbow = [7 + k for k in range(39) if np.ptp(graph.poses[[0, 7], 7 + k]) > 0.3]  # of arms around the rifle
    figure = asked_for(graph, at_rest(graph, "stand/rifle deployed", (0, 0, 0)), "kneel/rifle deployed", 0.0)
    poses = np.array([pose_at(graph, figure, now) for now in np.linspace(0.0, 1.2, 30)])
    np.testing.assert_allclose(poses[:, elbow], np.tile(poses[0, elbow], (30, 1)), atol=1e-9)
    assert np.ptp(poses[:, 2]) > 0.2


def test_names_of_nodes_lead_back_to_their_parts():
    graph = person()
    for name in graph.postures:
        posture, held, state = parts_of(name, graph.objects)
        assert node_name(posture, held, state) == name and "/" not in posture
    assert parts_of("kneel/rifle in use", graph.objects) == ("kneel", "rifle", "in use")
    assert node_name("prone", "rifle") == "prone"


@pytest.mark.parametrize(
    ("wrong", "problem"),
    [
        (("bow: {}", "lie: {}"), "no posture is called 'lie'.*valid: stand, bow"),
        (("right_elbow_flexion: 90", "elbow: 90"), "no joint is called 'elbow'"),
        (("in use:", "stowed:"), "every object has the state 'stowed'"),
        (("  stand: {both", "  a/b: {}\n  stand: {both"), "a posture's name has no /"),
    ],
)
def test_mistakes_are_told_with_their_line(tmp_path, wrong, problem):
    with pytest.raises(FileError, match=problem):
        load_postures(written(tmp_path, HELD.replace(*wrong)))


def test_an_arm_beyond_its_range_is_told_at_its_state(tmp_path):
    _, faults = check_posture_file(written(tmp_path, HELD.replace("elbow_flexion: 90", "elbow_flexion: 170")))
    assert any("'bow/lamp deployed'" in str(fault) for fault in faults)
    assert "graph.yaml:10:7: 'stand/lamp deployed': right_elbow_flexion" in str(faults[0])
