"""A person that gets up after a fall, and one that goes on hands and feet where it is too steep to walk."""

import math

import numpy as np
import pytest

from locomotion import MOVING, Ground, Human
from locomotion.body.arm_reach import HAND_RADIUS
from locomotion.events import Arrived, Event, Fell, GotUp
from locomotion.human.human import STRAYED
from locomotion.paths.follower import PathFollower
from locomotion.paths.table import TrackingLimits
from locomotion.paths.tracking import make_path

WAY = np.array([[x, 0.0, 0.0] for x in np.arange(0.0, 30.0)])


def plane(slope: float) -> Ground:
    """A square of 80 m that rises towards x."""
    half, rise = 40.0, 40.0 * slope
    corners = [[-half, -half, -rise], [half, -half, rise], [half, half, rise], [-half, half, -rise]]
    return Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.atan(slope))


def push_over(human: Human, direction: float, speed: float) -> None:
    """Let it go for 3 s, then push its chest for 0.25 s."""
    human.events.clear()
    human.reset((0, 0, 0), 0.0)
    human.follow(WAY, speed)
    for tick in range(325):
        pushed = tick >= 300
        force = 650.0 * np.array([math.cos(direction), math.sin(direction), 0.0])
        human.data.xfrc_applied[human.index.chest, :3] = force if pushed else 0.0
        human.tick()
    human.data.xfrc_applied[:] = 0.0


def go_on(human: Human, seconds: float, until: type[Event] | None = None) -> None:
    for _ in range(round(100 * seconds)):
        if human.status not in MOVING or (until and any(isinstance(event, until) for event in human.events)):
            return
        human.tick()


def test_gets_up_again_however_it_was_pushed_over():
    human, down = Human(None, clearing=(), gets_up=True), []
    for k in range(12):
        push_over(human, k * math.pi / 6, (1.2, 3.0)[k % 2])
        go_on(human, 5.0, Fell)
        if not any(isinstance(event, Fell) for event in human.events):
            continue
        go_on(human, 40.0, GotUp)
        up = [event for event in human.events if isinstance(event, GotUp)]
        down.append(up[0].seconds if up else math.inf)
        if up:
            assert human.data.xmat[human.index.chest].reshape(3, 3)[2, 2] > 0.7, "it stands"
    assert len(down) >= 8, "hard enough a push"
    assert max(down) < 40.0 and np.mean(np.array(down) <= 15.0) >= 0.75


def test_gets_up_where_a_level_with_steep_ground_is_level():
    """Hands and feet stick to what holds a body at 38 degrees; nobody came up from them."""
    corners = [[-40.0, -40.0, 0.0], [40.0, -40.0, 0.0], [40.0, 40.0, 0.0], [-40.0, 40.0, 0.0]]
    ground = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.radians(38.0))
    assert ground.steep
    human = Human(ground, clearing=(), gets_up=True)
    for direction in (0.0, 2.0, 4.0):
        push_over(human, direction, 3.0)
        go_on(human, 5.0, Fell)
        go_on(human, 40.0, GotUp)
        assert any(isinstance(event, GotUp) for event in human.events)


def test_hands_and_forearms_do_not_sink_into_the_ground_in_a_fall():
    human = Human(None, clearing=(), gets_up=True)
    names = [f"{side}_{part}" for side in ("right", "left") for part in ("hand", "forearm")]
    arms = [human.index.bodies[name] for name in names]
    for direction in (0.0, math.pi, 5.0 * math.pi / 3.0):
        push_over(human, direction, 3.0)
        go_on(human, 5.0, Fell)
        deepest = 0.0
        for _ in range(200):
            human.tick()
            contact = human.data.contact
            of_arms = np.isin(human.model.geom_bodyid[contact.geom.max(axis=1)], arms)
            deepest = min(deepest, contact.dist[of_arms].min(initial=0.0))
        assert -HAND_RADIUS < deepest < -0.005, "it has put them down"


def test_goes_on_to_its_goal_after_a_fall():
    human, arrived = Human(None, clearing=(), gets_up=True), 0
    for direction in (0.5, 2.2, 4.0, 5.5):
        push_over(human, direction, 1.2)
        go_on(human, 90.0)
        assert any(isinstance(event, Fell) for event in human.events)
        arrived += isinstance(human.events[-1], Arrived)
    assert arrived >= 3


@pytest.mark.parametrize("slope", [0.5, 0.7])
def test_who_has_got_up_on_a_slope_does_not_fall_again_at_once(slope):
    human, rng, again, up = Human(plane(slope), clearing=(), gets_up=True), np.random.default_rng(3), 0, 0
    for k in range(10):
        way = 2.0 * math.pi * k / 10.0
        ahead = np.linspace(0.0, 12.0, 40)[:, None] * np.array([math.cos(way), math.sin(way), 0.0])
        ahead[:, 2] = slope * ahead[:, 0]
        human.events.clear()
        human.reset((0, 0, 0), way)
        human.follow(ahead, 1.0)
        human.data.qvel[:3] += 2.5 * rng.normal(size=3)
        human.data.qvel[3:6] += 5.0 * rng.normal(size=3)
        go_on(human, 2.0, Fell)
        if not any(isinstance(event, Fell) for event in human.events):
            continue
        go_on(human, 40.0, GotUp)
        fell = len(human.events)
        up += isinstance(human.events[-1], GotUp)
        go_on(human, 2.0)
        again += any(isinstance(event, Fell) for event in human.events[fell:])
    assert up >= 5, "hard enough a push"
    assert again <= 1


def test_who_gets_up_beside_its_path_is_not_lost_before_it_can_be_told_another():
    human = Human(None, clearing=(), gets_up=True)
    push_over(human, 2.2, 1.2)
    go_on(human, 5.0, Fell)
    human.data.qpos[1] += 2.0 * STRAYED
    go_on(human, 40.0, GotUp)
    assert isinstance(human.events[-1], GotUp) and human.status == "walking"
    assert abs(human.lateral_error) > STRAYED


def test_who_was_carried_back_along_its_way_has_its_time_to_make_headway():
    way = PathFollower()
    limits = TrackingLimits((0.3, 1.2))
    way.begin(make_path(WAY, 1.0, limits, 0.0), 0)
    for tick in range(2000):
        way.track(np.zeros(6), 0.01 * tick, 0.0, 1.0, tick, np.zeros(4))
    assert way.arc == pytest.approx(19.99)
    way.go_on_from(np.array([6.0, 0.3, 0.0]), 3000)
    assert way.arc == pytest.approx(6.0, abs=0.06)
    for tick in range(3000, 4200):
        way.track(np.zeros(6), 6.0 + 0.01 * (tick - 3000), 0.3, 1.0, tick, np.zeros(4))
        assert way.without_headway(tick) < 0.5


def test_without_that_a_fall_is_the_end():
    human = Human(None, clearing=())
    push_over(human, 1.6, 1.2)
    go_on(human, 10.0)
    for _ in range(150):
        human.tick()
    assert human.status == "fallen" and human.held


def test_a_saved_person_gets_up_in_the_same_way():
    human, twin = Human(None, clearing=(), gets_up=True), Human(None, clearing=(), gets_up=True)
    push_over(human, 2.5, 1.2)
    go_on(human, 5.0, Fell)
    for _ in range(300):
        human.tick()
    assert human.status == "getting up" and human.gait_now == "scramble"
    twin.restore_state(human.save_state())
    for _ in range(400):
        human.tick()
        twin.tick()
    assert twin.state_hash() == human.state_hash()


@pytest.mark.parametrize("slope", [0.6, 0.85])
def test_scrambles_into_every_direction_over_a_steep_plane(slope):
    human, kept = Human(plane(slope), clearing=(), gets_up=True), 0
    for degrees in (0, 45, 90, 135, 180):
        way = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
        points = np.array([[*(k * way), slope * k * way[0]] for k in np.arange(0.0, 10.0, 0.5)])
        human.events.clear()
        human.reset(points[0], math.radians(degrees))
        human.follow(points, 3.0)
        assert human.status == "scrambling"
        go_on(human, 10.0, Fell)
        kept += not any(isinstance(event, Fell) for event in human.events) and human.arc_length > 1.0
        assert abs(human.lateral_error) < 0.3
    assert kept >= 4
