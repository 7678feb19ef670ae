"""Sampling recorded motion: stateless, the same at any frame rate, smooth from speed to speed."""

import numpy as np
import pytest

from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.sampling import (
    mixed,
    placed_roots,
    sample_clips,
    sample_clips_slowly,
    sample_gait,
    sample_gait_slowly,
    stride_of,
)
from locomotion.recorded.skeletons import FULL, LEVELS, LOW

MOTIONS = load_motions()


@pytest.mark.parametrize("level", range(len(LEVELS)))
def test_clips_are_read_as_the_slow_version_reads_them(level):
    rng = np.random.default_rng(11 + level)
    clips = rng.integers(0, len(MOTIONS.clips), 60)
    seconds = rng.uniform(-1.0, 5.0, 60)
    for fast, slow in zip(
        sample_clips(MOTIONS, level, clips, seconds),
        sample_clips_slowly(MOTIONS, level, clips, seconds),
        strict=True,
    ):
        assert np.abs(fast - slow).max() < 1e-9


@pytest.mark.parametrize("level", range(len(LEVELS)))
def test_gaits_are_read_as_the_slow_version_reads_them(level):
    rng = np.random.default_rng(21 + level)
    gaits = rng.integers(0, len(MOTIONS.gaits), 60)
    speeds, phases = rng.uniform(0.0, 6.0, 60), rng.uniform(-2.0, 9.0, 60)
    for fast, slow in zip(
        sample_gait(MOTIONS, level, gaits, speeds, phases),
        sample_gait_slowly(MOTIONS, level, gaits, speeds, phases),
        strict=True,
    ):
        assert np.abs(fast - slow).max() < 1e-9


def test_the_same_time_gives_the_same_pose_to_the_bit_at_any_frame_rate():
    rng = np.random.default_rng(5)
    clip = MOTIONS.clip("stand to kneel")
    alone = {}
    for step in (1 / 20, 1 / 33, 1 / 60, 1 / 144, None):
        steps = rng.exponential(0.02, 400) if step is None else np.full(200, step)
        times = np.concatenate([np.cumsum(steps), np.arange(1, 20) / 8.0])
        channels, roots = sample_clips(MOTIONS, FULL, np.full(len(times), clip), times)
        for time, *pose in zip(times[-19:].tolist(), channels[-19:], roots[-19:], strict=True):
            seen = np.concatenate(pose).tobytes()
            assert alone.setdefault(time, seen) == seen


def test_a_cycle_goes_on_where_it_began_one_stride_ahead():
    for clip, about in enumerate(MOTIONS.clips):
        if about.kind != "cycle":
            continue
        times = np.array([0.1, 0.1 + about.seconds])
        channels, roots = sample_clips(MOTIONS, FULL, [clip, clip], times)
        assert np.abs(channels[1] - channels[0]).max() < 1e-9
        x, y, turn = about.travel
        ahead = placed_roots(roots[:1], [[x, y, 0.0, turn]])[0]
        if abs(turn) < 1e-9:
            assert np.abs(ahead - roots[1]).max() < 1e-9


def test_a_gait_slows_to_the_posture_at_rest_and_quickens_without_a_jump():
    walk = MOTIONS.gait("walk")
    speeds = np.linspace(0.0, 1.9, 2000)
    channels, roots = sample_gait(MOTIONS, LOW, np.full(2000, walk), speeds, np.full(2000, 0.3))
    stand = MOTIONS.levels[LOW].channels[MOTIONS.levels[LOW].first[MOTIONS.clip("stand")]]
    assert np.abs(channels[0] - stand).max() < 1e-12
    assert np.abs(np.diff(channels[100:], axis=0)).max() < 0.01
    assert np.abs(np.diff(roots[100:], axis=0)).max() < 0.01


def test_strides_grow_with_the_speed_as_those_of_people_do():
    speeds = np.linspace(0.05, 1.8, 200)
    strides = stride_of(MOTIONS, np.full(200, MOTIONS.gait("walk")), speeds)
    assert (np.diff(strides) > 0.0).all()
    assert (np.diff(speeds / strides) > -0.05).all()  # and so does their rate, all but everywhere
    assert 1.1 < strides[np.searchsorted(speeds, 1.2)] < 1.5


def test_placing_a_root_turns_and_moves_it():
    root = np.array([[1.0, 0.0, 0.9, 1.0, 0.0, 0.0, 0.0]])
    placed = placed_roots(root, [[10.0, 20.0, 3.0, np.pi / 2]])[0]
    assert np.allclose(placed, [10.0, 21.0, 3.9, np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])


def test_between_two_samples_the_ends_are_the_samples():
    a = sample_clips(MOTIONS, LOW, [0, 1], [0.0, 0.0])
    b = sample_clips(MOTIONS, LOW, [2, 3], [0.0, 0.0])
    for share, end in ((0.0, a), (1.0, b)):
        got = mixed(a, b, [share, share])
        assert np.allclose(got[0], end[0])
        assert np.allclose(got[1], end[1])
