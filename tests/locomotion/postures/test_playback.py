"""Playing posture graphs: by elapsed time, without a jump, whatever is asked for when."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from benchmarks.posture_graphs import random_graph
from locomotion.errors import LocomotionError
from locomotion.postures.places import placed
from locomotion.postures.playback import asked_for, at_rest, pose_at, settled
from locomotion.postures.posture_file import load_postures

PERSON = Path(__file__).resolve().parents[3] / "locomotion" / "data" / "postures" / "person.yaml"


@cache
def person():
    return load_postures(PERSON)


def requests(rng, graph, count=20):
    """Random postures at random times [s]."""
    times = np.cumsum(rng.exponential(0.7, count))
    return list(zip(times.tolist(), rng.choice(graph.postures, count).tolist(), strict=True))


def played(graph, asked, times):
    """Poses at ``times``, with every request made at its own time in between."""
    playback, poses, asked = at_rest(graph, graph.postures[0], (1.0, 2.0, 0.5)), [], list(asked)
    for now in times:
        while asked and asked[0][0] <= now:
            at, posture = asked.pop(0)
            try:
                playback = asked_for(graph, playback, posture, at)
            except LocomotionError:
                assert posture not in graph.postures or not np.isfinite(
                    graph.least[playback.posture, graph.postures.index(posture)]
                )
        poses.append(pose_at(graph, playback, now))
    return np.array(poses), playback


@pytest.mark.parametrize("seed", range(8))
def test_nothing_jumps_between_frames_whatever_is_asked_for(seed):
    rng, graph = np.random.default_rng(seed), person()
    poses, _ = played(graph, requests(rng, graph), np.arange(0.0, 20.0, 1 / 60))
    assert np.degrees(np.abs(np.diff(poses[:, 7:], axis=0))).max() < 5.0
    assert np.linalg.norm(np.diff(poses[:, :3], axis=0), axis=1).max() < 0.05
    turned = np.abs((poses[1:, 3:7] * poses[:-1, 3:7]).sum(axis=1))
    assert np.degrees(2.0 * np.arccos(np.minimum(turned, 1.0))).max() < 8.0


@pytest.mark.parametrize("seed", range(5))
def test_the_pose_at_a_time_does_not_depend_on_how_often_it_is_asked_for(seed):
    rng, graph = np.random.default_rng(seed), random_graph(np.random.default_rng(seed))
    asked, when = requests(rng, graph), np.array([3.3, 7.1, 15.0])
    seen = []
    for dt in (1 / 20, 1 / 33, 1 / 144, 9.0):
        times = np.union1d(np.arange(0.0, 15.0, dt), when)
        poses, _ = played(graph, asked, times)
        seen.append(poses[np.isin(times, when)])
    for poses in seen[:-1]:
        np.testing.assert_array_equal(poses, seen[-1])


def test_a_request_takes_the_least_time_and_ends_in_the_posture():
    graph = person()
    for there, posture in enumerate(graph.postures):
        if posture == "dead":
            continue
        playback = asked_for(graph, at_rest(graph, "stand", (0, 0, 0)), posture, 5.0)
        least = graph.least[0, there]
        almost = settled(graph, playback, 5.0 + least - 1e-6)
        assert posture == "stand" or almost.arc >= 0
        done = settled(graph, playback, 5.0 + least + 1e-6)
        assert done.arc < 0 and graph.postures[done.posture] == posture
        np.testing.assert_allclose(pose_at(graph, done, 60.0)[7:], graph.poses[there, 7:], atol=1e-12)


def test_who_changes_their_mind_turns_back_on_the_way_if_that_is_quicker():
    graph = person()
    playback = asked_for(graph, at_rest(graph, "stand", (0, 0, 0)), "kneel", 0.0)
    before = pose_at(graph, playback, 0.3)
    back = asked_for(graph, playback, "stand", 0.3)
    after = pose_at(graph, back, 0.3)
    after[3:7] *= np.sign(after[3:7] @ before[3:7])
    np.testing.assert_allclose(after, before, atol=1e-9)
    assert settled(graph, back, 0.6 + 1e-6).arc < 0
    np.testing.assert_allclose(pose_at(graph, back, 2.0), graph.poses[0], atol=1e-9)
    on = asked_for(graph, asked_for(graph, playback, "all-fours", 0.8), "kneel", 0.9)
    assert settled(graph, on, 1.0 + 1e-6).arc < 0


@pytest.mark.parametrize("seed", range(20))
def test_from_any_moment_there_is_a_way_to_the_fatal_posture(seed):
    rng, graph = np.random.default_rng(seed), person()
    asked = requests(rng, graph, 6)
    now = asked[-1][0] + float(rng.uniform(0.0, 2.0))
    _, playback = played(graph, asked, [now])
    before = pose_at(graph, playback, now)
    dying = asked_for(graph, playback, "dead", now)
    np.testing.assert_allclose(pose_at(graph, dying, now), before, atol=1e-12)
    frames = np.array([pose_at(graph, dying, now + k / 60) for k in range(120)])
    assert np.degrees(np.abs(np.diff(frames[:, 7:], axis=0))).max() < 5.0
    lying = placed(graph.poses[graph.fatal], dying.place)
    np.testing.assert_allclose(frames[-1], lying, atol=1e-9)


def test_what_cannot_be_is_refused_and_nothing_changes():
    graph = person()
    playback = at_rest(graph, "stand", (0, 0, 0))
    with pytest.raises(LocomotionError, match="valid: stand, crouch"):
        asked_for(graph, playback, "crawl", 0.0)
    with pytest.raises(LocomotionError, match="no way from 'dead' to 'stand'"):
        asked_for(graph, asked_for(graph, playback, "dead", 0.0), "stand", 3.0)
    with pytest.raises(LocomotionError, match="valid"):
        at_rest(graph, "crawl", (0, 0, 0))
