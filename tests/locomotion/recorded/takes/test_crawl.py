"""Crawling."""

import numpy as np

from locomotion.clips.motion import Motion, lowest_points
from locomotion.clips.motion_check import check_motion
from locomotion.data import POSTURES
from locomotion.postures.posture_file import load_postures
from locomotion.recorded.takes.crawl import CRAWLS, crawl_cycles
from locomotion.recorded.takes.take import mirrored


def test_a_crawl_is_symmetric_stays_on_the_ground_and_within_the_joints_ranges():
    graph = load_postures(POSTURES / "person.yaml")
    takes = crawl_cycles(graph.poses[graph.postures.index("prone")])
    assert [take.clip.speed for take in takes] == list(CRAWLS)
    for take in takes:
        assert np.allclose(take.qpos, np.roll(mirrored(take.qpos), len(take.qpos) // 2, axis=0))
        assert np.abs(lowest_points(take.qpos[::10])).max() < 1e-9
        assert not [
            fault for fault in check_motion(Motion("", 60.0, take.qpos[::5])) if fault.kind == "joint"
        ]
        assert np.degrees(np.abs(np.diff(take.qpos[:, 7:], axis=0)).max()) < 10.0
