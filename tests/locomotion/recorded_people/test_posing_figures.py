"""One kernel poses all figures as sampling, style, and planting do one after the other."""

import numpy as np
import pytest

from locomotion.body.traits import PACE
from locomotion.recorded.foot_planting import planted
from locomotion.recorded.individual import styled
from locomotion.recorded.sampling import sample_gait
from locomotion.recorded.skeletons import FULL, LEVELS, LOW, MEDIUM, skeleton
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.drawing import drawn
from locomotion.recorded_people.figure_tables import figure_tables
from locomotion.recorded_people.posing_figures import pose_figures
from tests.locomotion.recorded_people.test_people import crowd_of, played


def step_by_step(people, level):
    """Channels and roots of all, who walk or stand, by the functions for many figures."""
    rows, motions, own = people.rows, people.motions, skeleton(LEVELS[level])
    moves = rows[:, at.GAIT] >= 0.0
    gaits = np.array(
        [motions.gait(people.gaits[int(gait)].name if gait >= 0.0 else "walk") for gait in rows[:, at.GAIT]]
    )
    speeds = np.where(moves, np.abs(rows[:, at.SPEED]) * rows[:, at.TRAITS][:, PACE], 0.0)
    late = rows[:, at.LATE] * [people.cadence(k) for k in range(len(rows))]
    phases = rows[:, at.PHASE] + late
    sample = styled(own, sample_gait(motions, level, gaits, speeds, phases % 1.0), rows[:, at.TRAITS])
    since = (rows[:, at.PHASE, None] - [0.0, 0.5]) % 1.0 + late[:, None]
    since = np.where(moves[:, None], np.minimum(since, 1.0), 0.0)  # a foot does not strike before its tick
    steps = rows[:, at.STEPS].reshape(-1, 2, 3, 6)[:, :, :2]
    moments = gaits, speeds, phases
    return planted(motions, level, moments, sample, rows[:, at.PLACE], steps, since)


@pytest.mark.parametrize("level", [FULL, MEDIUM, LOW])
def test_all_are_posed_as_step_by_step(level):
    people, persons = crowd_of(6, level)
    for person in persons[:5]:
        person.go_to([(9.0 + person.index, 6.0, 0.0)], 0.9 + 0.2 * person.index, None)
    played(people, persons[0], 2.0)
    people.rows[:, at.FADE_SECONDS] = 0.0
    channels, roots = step_by_step(people, level)
    everybody = np.arange(6)
    wanted = skeleton(LEVELS[level]).as_qpos(channels, roots)
    np.testing.assert_allclose(people.qpos(everybody), wanted, atol=1e-9)
    np.testing.assert_allclose(people.transforms(everybody), drawn(LEVELS[level], channels, roots), atol=1e-9)


def test_a_figure_is_posed_alike_alone_and_among_others():
    people, persons = crowd_of(4)
    for person in persons:
        person.go_to([(9.0 + person.index, 6.0, 0.0)], 1.2, None)
    played(people, persons[0], 0.5)  # while they change from one motion to another
    figures = figure_tables(people.motions, people.graph, people.gaits)
    together, alone = np.empty((4, 46)), np.empty((1, 46))
    apart = np.empty(4, np.bool_)
    pose_figures(figures, np.arange(4), people.rows, people.crowd.rows, (0.004, people.dt), together, apart)
    for k in range(4):
        pose_figures(figures, np.array([k]), people.rows, people.crowd.rows, (0.004, people.dt), alone, apart)
        assert alone[0].tobytes() == together[k].tobytes()


def test_turns_come_as_often_as_motion_is_kept_and_in_equal_parts():
    people, _ = crowd_of(10)
    for _ in range(14):
        for x in range(10):
            people.add((2.0 + x, 5.0, 0.0), 0.0, LOW, np.random.default_rng(1))
    everybody = np.arange(len(people))
    due = np.array([people.due(everybody, k / 60.0, (k + 1) / 60.0) for k in range(60)])
    assert due[:, :10].all() and set(due[:, 10:].sum(axis=0)) <= {14, 15, 16}
    assert np.ptp(due[:, 10:].sum(axis=1)) < 0.05 * len(everybody)


@pytest.mark.parametrize("speed", [2.1, 3.5])
def test_one_who_sets_out_runs_only_to_get_fast(speed):
    people, (ada,) = crowd_of(1)
    ada.go_to([(18.0, 5.0, 0.0)], speed, None)
    walked = []
    for _ in range(200):
        people.tick()
        if people.rows[ada.index, at.GAIT] == 0.0:
            walked.append(people.rows[ada.index, at.SPEED])
    # nobody walks much faster than 2.2 m/s, though the first step of a run waits for the end of a walk's
    assert people.gaits[0].name == "walk" and max(walked) < 2.5
    assert (people.rows[ada.index, at.GAIT] == 0.0) == (speed < 2.2)
