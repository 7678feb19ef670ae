"""Turning on the spot."""

import numpy as np

from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.sampling import sample_clips
from locomotion.recorded.skeletons import FULL


def test_turns_stay_where_they_are_and_face_where_they_say():
    motions = load_motions()
    for name, sign in (("turn left", 1.0), ("turn right", -1.0)):
        gait = motions.gait(name)
        for clip in motions.cycles[motions.gait_first[gait] : motions.gait_first[gait + 1]]:
            about = motions.clips[clip]
            times = np.linspace(0.0, 2.0 * about.seconds, 50)
            _, roots = sample_clips(motions, FULL, np.full(50, clip), times)
            assert np.linalg.norm(roots[:, :2], axis=1).max() < 0.15
            turned = np.unwrap(2.0 * np.arctan2(roots[:, 6], roots[:, 3]))
            assert np.isclose(turned[-1] - turned[0], sign * 2.0 * about.speed * about.seconds, atol=0.02)
