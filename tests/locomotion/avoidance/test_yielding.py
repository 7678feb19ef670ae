"""Foretelling, meetings and what a body can do about them."""

import numpy as np
import pytest

from locomotion.avoidance.yielding import (
    AT_ONCE,
    COUNT,
    HARD,
    STEP,
    Course,
    first_meeting,
    foretell,
    meetings,
)

ALONG = np.column_stack([0.1 * np.arange(200), np.zeros(200), np.zeros(200)])


def course(**changes):
    usual = {
        "points": ALONG, "speeds": np.full(200, 1.5), "speed": 1.5, "pace": 1.0, "length": 0.5, "reach": 0.0,
        "radius": 0.12, "acceleration": 2.0, "braking": 2.0, "eagerness": AT_ONCE, "slowest": 0.0,
        "sharpest": 1.0, "begins": 0.6, "aside": True, "whole": False, "stops": 0.6,
    }  # fmt: skip
    return Course(**{**usual, **changes})


def places(of, pace, discs=3):
    found = np.empty((COUNT, discs, 2))
    foretell(
        of.points, of.speeds, of.speed, pace, of.slowest, of.acceleration, of.braking, of.eagerness,
        of.length, of.reach, of.turns, found,
    )  # fmt: skip
    return found


def test_a_body_is_foretold_on_its_path():
    at_speed = places(course(), 1.0)
    assert at_speed[:, 0, 0] == pytest.approx(1.5 * STEP * np.arange(COUNT), abs=1e-9)
    assert at_speed[:, 2, 0] - at_speed[:, 0, 0] == pytest.approx(0.5, abs=1e-9)
    stopping = places(course(), 0.0)
    assert (
        stopping[-1, 0, 0] == pytest.approx(1.5**2 / (2.0 * 2.0), abs=0.1)
        and stopping[-1, 0, 0] == stopping[-9, 0, 0]
    )
    running = places(course(slowest=1.0), 0.3)
    assert np.diff(running[:, 0, 0])[-1] == pytest.approx(1.0 * STEP)
    halting = places(course(slowest=1.0), 0.0)
    assert np.diff(halting[:, 0, 0])[-1] == 0.0
    short = places(course(points=ALONG[:21]), 1.0)
    assert short[-1, 2] == pytest.approx([2.0, 0.0])


def test_a_body_ends_with_its_head_beyond_its_goal():
    reaches = places(course(points=ALONG[:21], reach=0.3), 1.0)
    assert reaches[-1, :, 0] == pytest.approx([1.8, 2.05, 2.3], abs=1e-6)


def test_a_body_slackens_as_it_does():
    """Its speed dies away, if it is less eager than its brakes are strong."""
    slow = course(speed=0.5, eagerness=2.0)
    assert places(slow, 0.0)[-1, 0, 0] == pytest.approx(0.5 / 2.0, abs=0.05)
    assert places(course(speed=0.5), 0.0)[-1, 0, 0] == pytest.approx(0.5**2 / 4.0, abs=0.05)


def test_the_first_meeting_is_that_of_every_pair():
    random = np.random.default_rng(3)
    for _ in range(200):
        own = np.cumsum(random.normal(0.0, 0.1, (COUNT, 3, 2)), axis=0)
        others = np.cumsum(random.normal(0.0, 0.1, (COUNT, 4, 2)), axis=0)
        others[:, :, 0] += 1.0
        radii = random.uniform(0.1, 0.4, 4)
        away = np.linalg.norm(own[:, :, None] - others[:, None], axis=3)
        stayed = np.linalg.norm(own[:-1, :, None] - others[1:, None], axis=3)
        comes = (np.vstack([np.full((1, 3, 4), -1.0), stayed]) > away) & (away[0] >= 0.2 + radii)
        near, touches = comes & (away < 0.25 + radii), comes & (away < 0.2 + radii)
        steps = [np.append(np.flatnonzero(each.any(axis=(1, 2))), COUNT)[0] for each in (near, touches)]
        moved = np.linalg.norm(np.diff(own, axis=0, prepend=own[:1]), axis=2)
        hard = np.minimum(moved / (HARD * STEP), 1.0)
        deep = np.where(touches, hard[:, :, None] * (1.0 - away / (0.2 + radii)), 0.0)
        depth = deep[:, :-1].max()  # of all but the head
        assert first_meeting(own, 0.2, others, radii, 0.05) == (*steps, pytest.approx(depth))


def test_who_is_run_into_does_not_meet_anybody():
    stands, comes = np.zeros((COUNT, 1, 2)), np.zeros((COUNT, 1, 2))
    comes[:, 0, 0] = np.linspace(3.0, 0.0, COUNT)
    radius = np.array([0.3])
    assert first_meeting(stands, 0.3, comes, radius, 0.1) == (COUNT, COUNT, 0.0)
    near, touches, depth = first_meeting(comes, 0.3, stands, radius, 0.1)
    assert 0 < near < touches < COUNT and depth == 1.0


def test_who_lies_in_another_gets_away():
    ahead, behind = np.zeros((COUNT, 2, 2)), np.zeros((COUNT, 2, 2))
    ahead[:, :, 0] = 0.1 * np.arange(COUNT)[:, None] + [0.0, 0.5]
    behind[:, :, 0] = [-0.4, 0.1]
    radii = np.array([0.12, 0.12])
    assert first_meeting(ahead, 0.12, behind, radii, 0.08)[1] == COUNT


def test_who_comes_near():
    spots = np.array([[0.0, 0.0], [6.0, 0.0], [0.0, 9.0], [1.0, 0.0]])
    velocities = np.array([[1.5, 0.0], [-1.5, 0.0], [0.0, 1.0], [1.5, 0.0]])
    near = meetings(spots, velocities, np.array([0.0, 0.0, 0.0, 5.0]), np.array([0]), 2.0, 1.5)
    assert near.tolist() == [[False, True, False, False]]
