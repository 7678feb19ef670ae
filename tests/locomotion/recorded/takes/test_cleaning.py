"""Cycles without the slide of the simulation."""

import numpy as np

from locomotion.recorded.footfalls import sole_centres
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.posing import posed
from locomotion.recorded.skeletons import FULL, skeleton
from locomotion.recorded.takes.cleaning import backwards, cleaned
from locomotion.recorded.takes.take import Take


def walk():
    motions = load_motions()
    level, clip = motions.levels[FULL], motions.clip("walk 1.25")
    rows = slice(level.first[clip], level.first[clip] + level.count[clip])
    qpos = np.hstack([level.roots[rows], level.channels[rows]])
    return Take(motions.clips[clip], qpos, level.stance[rows])


def slid(take):
    full = skeleton("full")
    places = posed(full, take.qpos[:, 7:], take.qpos[:, :7])[:, full.bodies.index("right_foot")]
    places[:, 0] += take.clip.travel[0] * np.arange(len(places)) / len(places)
    centres, _ = sole_centres(places)
    return np.ptp(centres[np.flatnonzero(take.stance[:, 0])[1:-1], 0])


def test_feet_that_slid_stand_still():
    take = walk()
    take.qpos[:, 0] += 0.02 * np.sin(2 * np.pi * np.arange(len(take.qpos)) / len(take.qpos))
    assert slid(take) > 0.02
    assert slid(cleaned([take])[0]) < 0.005


def test_a_cycle_played_backwards_goes_back_with_feet_that_stand():
    take = backwards(walk(), "walk backwards")
    assert take.clip.travel[0] == -walk().clip.travel[0]
    assert take.stance[1, 0]
    assert slid(take) < 0.01
