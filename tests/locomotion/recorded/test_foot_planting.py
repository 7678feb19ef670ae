"""Planted feet: they stand still on level ground, slopes and steps, at any speed."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from locomotion.errors import LocomotionError
from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import (
    BALL,
    BEARS,
    FEET,
    HEEL,
    STRIKES,
    Steps,
    footing_at,
    straight_footfalls,
)
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import sample_gait
from locomotion.recorded.skeletons import FULL, LEVELS, LOW, MEDIUM, skeleton

MOTIONS = load_motions()


def on_slope(points):
    normal = np.array([-0.12, 0.05, 1.0])
    heights = 0.12 * points[:, 0] - 0.05 * points[:, 1]
    return heights, np.tile(normal / np.linalg.norm(normal), (len(points), 1))


def on_stairs(points):
    return 0.15 * np.floor(points[:, 0] / 0.6 + 0.5), np.tile([0.0, 0.0, 1.0], (len(points), 1))


def on_level(points):
    return np.zeros(len(points)), np.tile([0.0, 0.0, 1.0], (len(points), 1))


GROUNDS = {"level": on_level, "slope": on_slope, "stairs": on_stairs}


def walked(level, ground, count=160):
    """Soles (n, 2 feet, heel and ball, 3) along a bend at a speed that varies; which feet bear, and the
    number of their footfall."""
    angle = np.linspace(0.0, 1.2, 60)
    path = np.stack([6.0 * np.sin(angle), 6.0 * (1.0 - np.cos(angle)), 0.0 * angle], axis=1)
    path[:, 2] = ground(path)[0]
    steps = Steps(MOTIONS, "walk", path, 1.1 + 0.5 * np.sin(4.0 * angle), ground)
    distances = np.linspace(0.5, 0.9 * steps.length, count)
    phases, places = zip(*(steps.at(distance) for distance in distances), strict=True)
    speeds, gaits = [steps.speed_at(d) for d in distances], np.full(count, MOTIONS.gait("walk"))
    footfalls = np.array([steps.footfalls(phase) for phase in phases])
    sample = sample_gait(MOTIONS, level, gaits, speeds, phases)
    own = skeleton(LEVELS[level])
    bodies = posed(own, *planted(MOTIONS, level, (gaits, speeds, phases), sample, places, footfalls))
    feet = bodies[:, [own.bodies.index(name) for name in FEET]]
    turns = Rotation.from_quat(feet[..., 3:].reshape(-1, 4), scalar_first=True)
    soles = np.stack([turns.apply(end).reshape(count, 2, 3) + feet[..., :3] for end in (HEEL, BALL)], axis=2)
    since = np.array(phases)[:, None] - footing_at(MOTIONS, gaits[0], speeds)[:, :, STRIKES]
    bears = since % 1.0 < footing_at(MOTIONS, gaits[0], speeds)[:, :, BEARS]
    return soles, bears, np.floor(since)


def slides(soles, bears, numbers):
    """How far the end of the sole that a foot stands on moves in each of its stances [m]."""
    found = []
    for side in range(2):
        lowest = soles[:, side, :, 2].min(axis=1)
        for number in np.unique(numbers[:, side]):
            for end in range(2):
                rows = bears[:, side] & (numbers[:, side] == number)
                rows &= soles[:, side, end, 2] < lowest + 0.003
                if rows.sum() > 2:
                    found.append(np.ptp(soles[rows, side, end, :2], axis=0).max())
    return found


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("level", [FULL, MEDIUM])
def test_feet_do_not_slide(level, ground):
    soles, bears, numbers = walked(level, GROUNDS[ground])
    assert max(slides(soles, bears, numbers)) < 0.01
    over = soles[..., 2].min(axis=2) - np.stack(
        [GROUNDS[ground](soles[:, k, 0])[0] for k in range(2)], axis=1
    )
    if ground != "stairs":
        assert np.abs(over[bears]).max() < 0.02


@pytest.mark.parametrize("ground", GROUNDS)
def test_low_figures_slide_little_though_their_hips_do_not_turn(ground):
    assert max(slides(*walked(LOW, GROUNDS[ground]))) < 0.015


@pytest.mark.parametrize("turned", np.linspace(-3.1, 3.1, 9))
def test_a_foot_turns_along_with_a_figure_that_turns_far_while_it_stands(turned):
    walk, still = MOTIONS.gait("walk"), np.zeros(4)
    footfalls = straight_footfalls(MOTIONS, walk, 0.8, 0.2, still)
    moment = [walk], [0.8], [0.2]
    sample = sample_gait(MOTIONS, FULL, *moment)
    channels, _ = planted(MOTIONS, FULL, moment, sample, [[0.0, 0.0, 0.0, turned]], [footfalls])
    hips = [skeleton("full").channels.index(f"{side}_hip_rotation") for side in ("right", "left")]
    assert np.abs(channels[:, hips]).max() < 1.4


def test_a_footfall_does_not_depend_on_when_it_is_asked_for():
    path = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [5.0, 5.0, 0.0]])
    steps = Steps(MOTIONS, "walk", path, [0.8, 1.4, 1.0])
    early, late = steps.footfalls(3.1), steps.footfalls(3.3)
    assert np.array_equal(early[0], late[0])
    later = steps.footfalls(4.1)
    assert np.array_equal(later[0, 0], early[0, 1])


def test_a_path_of_one_point_is_refused():
    with pytest.raises(LocomotionError, match="two points or more"):
        Steps(MOTIONS, "walk", [[0.0, 0.0, 0.0]], [1.0])
