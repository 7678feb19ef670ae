"""Posture graphs as clips."""

import numpy as np

from locomotion.data import POSTURES
from locomotion.postures.posture_file import load_postures
from locomotion.recorded.takes.arcs import arc_name, posture_takes


def test_each_posture_and_each_arc_that_is_no_opposite_becomes_a_clip():
    graph = load_postures(POSTURES / "person.yaml")
    takes = {take.clip.name: take for take in posture_takes(graph, "keys")}
    assert set(graph.postures) < set(takes)
    for arc in range(len(graph.start)):
        take = takes[arc_name(graph, arc)]
        source = arc if not graph.backwards[arc] else graph.opposite[arc]
        assert take.clip.seconds == graph.seconds[source]
        assert np.allclose(take.clip.travel, graph.moves[source])
        assert np.allclose(take.qpos[0], graph.frames[graph.first[source]])
