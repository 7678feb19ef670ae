"""When a person changes its gait, and what it does where no rehearsal goes well."""

import numpy as np
import pytest

from locomotion.gaits.brake import BRAKING
from locomotion.gaits.limits import RUN_ENTRY, SHORT_ENTRY
from locomotion.ground.ground import Ground
from locomotion.human import gait_changes
from locomotion.human.human import Human
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.rehearsal.choices import SLIPPERY_SLOWINGS, SLOWINGS
from locomotion.rehearsal.trials import ComesToRest
from tests.locomotion.gaits.runners import running
from tests.locomotion.human.people import Recorder

FIELD = np.array([[-5.0, -9.0, 0.0], [70.0, -9.0, 0.0], [70.0, 9.0, 0.0], [-5.0, 9.0, 0.0]])


def test_one_whose_braking_does_not_go_well_runs_on_for_a_moment_and_slows_down(monkeypatch):
    def falls(self, body):
        yield
        return 0.0, []

    monkeypatch.setattr(ComesToRest, "__call__", falls)
    human = running(300)
    human.stop()
    gaits = []
    for _ in range(60):
        human.tick()
        gaits.append(human.gait_now)
    assert gaits[0] == "run" and gaits[-1] == "slow run" and not human.on_feet.brakes
    assert 35 <= gaits.count("run") <= 45


def test_one_that_has_to_wait_for_others_brakes():
    human = running(300)
    human.give_way(0.0, None)
    human.tick()
    assert human.on_feet.brakes and human.on_feet.slowing > 2.0
    assert human.prospect().braking == BRAKING
    for _ in range(350):
        human.tick()
    assert human.status == "walking" and np.linalg.norm(human.velocity[:2]) < 0.1
    human.give_way(1.0, None)
    while human.gait_now != "run":
        assert human.status == "walking" and human.time < 20.0
        human.tick()
    assert not human.on_feet.brakes


@pytest.mark.parametrize("ticks", [20, 40, 60])
def test_told_to_go_on_while_it_brakes_it_comes_to_a_stand_first(ticks):
    human, least = running(300), np.inf
    human.give_way(0.0, None)
    for _ in range(ticks):
        human.tick()
    assert human.on_feet.brakes
    human.give_way(1.0, None)
    while human.gait_now != "run" or human.on_feet.slowing > 0.0:
        assert human.status in ("running", "walking") and human.time < 20.0
        human.tick()
        least = min(least, float(np.linalg.norm(human.velocity[:2])))
    assert least < 0.25


def with_an_obstacle(away, beside=0.0, rehearsals=16):
    """A person that stands on the plane ``beside`` its path, with an obstacle ``away`` ahead."""
    human = Human(None, clearing=[Recorder()], rehearsals=rehearsals)
    human.reset((0, beside, 0), 0.0)
    obstacle = ObstacleAhead(away, "jump", 0.4, np.array([away, 0, 0.4]), np.array([-1.0, 0, 0]))
    human.follow([[0, 0, 0], [away + 15.0, 0, 0]], 3.0, [obstacle])
    return human


def walking_speed_before_it_runs(human):
    speed = 0.0
    while human.gait_now == "walk":
        assert human.status == "walking" and human.time < 20.0
        speed = float(np.linalg.norm(human.velocity[:2]))
        human.tick()
    return speed


def holds(monkeypatch, score):
    """Let rehearsals of a run-up go as ``score`` says of the body that has set off."""

    def clears(body):
        yield
        return score(body), []

    monkeypatch.setattr(gait_changes, "_CLEARS", clears)


def test_with_little_room_one_that_rehearses_begins_to_run_while_it_walks_slowly(monkeypatch):
    holds(monkeypatch, lambda body: 1.0)
    near, far, unrehearsed = with_an_obstacle(5.0), with_an_obstacle(9.0), with_an_obstacle(5.0, rehearsals=0)
    assert SHORT_ENTRY <= walking_speed_before_it_runs(near) < RUN_ENTRY - 0.2
    assert walking_speed_before_it_runs(far) >= RUN_ENTRY - 0.1
    assert walking_speed_before_it_runs(unrehearsed) >= RUN_ENTRY - 0.1


def test_what_holds_only_in_part_is_not_begun_slowly(monkeypatch):
    holds(monkeypatch, lambda body: 0.5)
    assert walking_speed_before_it_runs(with_an_obstacle(5.0)) >= RUN_ENTRY - 0.1


def test_with_little_room_the_run_may_begin_faster_than_the_walk(monkeypatch):
    human = with_an_obstacle(5.0)
    holds(monkeypatch, lambda body: float(body.on_feet.speed > 1.1))  # its reference's first speed
    assert walking_speed_before_it_runs(human) < 0.9 and human.on_feet.speed > 1.1


def test_nobody_begins_a_run_up_far_beside_the_path(monkeypatch):
    holds(monkeypatch, lambda body: 1.0)
    human = with_an_obstacle(12.0, beside=1.9)
    monkeypatch.setattr(gait_changes, "run_entry_speed", lambda *_: RUN_ENTRY)  # it could at any moment
    beside = []
    while human.gait_now == "walk":
        assert human.time < 20.0
        human.tick()
        beside.append(abs(human.lateral_error))
    assert beside[0] > 1.8 and beside[-1] < 1.55


def test_on_slippery_ground_it_slows_down_gently():
    ways = []
    for friction in (0.9, 0.45):
        human = running(300, rehearsals=0, ground=Ground.from_arrays(FIELD, [[0, 1, 2], [0, 2, 3]]))
        assert human.ground is not None
        human.ground.friction = friction
        human.stop()
        human.tick()
        ways.append(human.on_feet.slowing)
    assert ways == [SLOWINGS[0], SLIPPERY_SLOWINGS[0]] and ways[1] < 0.75
