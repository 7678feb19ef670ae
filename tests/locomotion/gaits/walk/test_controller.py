"""Walking: legs, footholds and forces against slow and independent versions; the whole person on rough
ground."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.gaits.run.controller import COM_VELOCITY
from locomotion.ground.ground import Ground
from locomotion.human.state import MOVING
from locomotion.training.gaits.grounds import training_ground
from locomotion.training.gaits.path_trial import draw_path, follow_path, straight_on
from locomotion.training.gaits.walk import KINDS as WALKS
from tests.enough import enough


@pytest.mark.parametrize("kind", ["pushed", "rolling", "ramps", "moguls", "crags"])
def test_walks_along_winding_paths(kind):
    paths = (draw_path(np.random.default_rng([7, k]), **WALKS[kind]) for k in range(6))
    figures = (follow_path(path).figures for path in paths)
    assert enough((f["time"] > 6.0 and f["side_drift"] < 0.5 for f in figures), 5)


def walk_on_slope(slope, direction_deg, speed):
    """A person that has walked 4 m on a plane that rises by ``slope`` towards 0 degrees."""
    corners = np.array([[-50, -50], [50, -50], [50, 50], [-50, 50]], dtype=float)
    corners = np.column_stack([corners, slope * corners[:, 0]])
    ground = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.atan(slope))
    human = Human(ground, clearing=())
    yaw = math.radians(direction_deg)
    way = np.outer(np.linspace(0.0, 4.0, 9), [math.cos(yaw), math.sin(yaw), slope * math.cos(yaw)])
    human.reset(way[0], yaw)
    human.follow(way, speed)
    while human.status in MOVING and human.time < 40.0:
        human.tick()
    return human


@pytest.mark.parametrize("slope", [0.3, 0.5])
@pytest.mark.parametrize("direction_deg", [0, 90, 180])
def test_walks_up_along_and_down_a_slope(slope, direction_deg):
    assert walk_on_slope(slope, direction_deg, 0.5).status == "arrived"


def rests_on_slope(slope, direction_deg):
    """Whether it comes to rest within 5 s of arriving; after 6 s it would be held in any case."""
    human = walk_on_slope(slope, direction_deg, 0.8)
    for _ in range(500):
        human.tick()
    still = bool(np.abs(human.control[COM_VELOCITY]).max() < 0.1)
    return human.status == "arrived" and human.held and still


@pytest.mark.parametrize(("slope", "least"), [(0.2, 7), (0.3, 6), (math.tan(math.radians(20.0)), 6)])
def test_comes_to_rest_at_a_goal_on_a_slope(slope, least):
    assert enough((rests_on_slope(slope, direction) for direction in range(0, 181, 30)), least)


def test_walking_person_goes_on_bit_for_bit_when_restored():
    human, twin = (Human(training_ground("moguls"), clearing=()) for _ in range(2))
    path = draw_path(np.random.default_rng(2), (4.0, 5.0), (0.6, 0.6), 1.0, "moguls").points
    human.reset(path[0], 0.0)
    human.follow(path, 0.6)
    for _ in range(230):
        human.tick()
    saved = human.save_state()
    human.body_transforms()
    for _ in range(200):
        human.tick()
    twin.restore_state(saved)
    for _ in range(200):
        twin.tick()
    assert twin.state_hash() == human.state_hash()


def test_turns_round_on_the_spot():
    human = Human(None, clearing=())
    human.reset((0, 0, 0), 0.0)
    human.follow([[0, 0, 0], [-3, 0, 0]], 0.8)
    farthest = 0.0
    while human.status in MOVING and human.time < 20.0:
        human.tick()
        farthest = max(farthest, human.position[0])
    assert human.status == "arrived" and farthest < 0.3


def test_a_walking_person_that_is_told_to_go_back_turns_round_and_arrives():
    for seed in range(8):
        rng = np.random.default_rng(seed)
        human = Human(None, clearing=())
        human.reset((0, 0, 0), 0.0)
        human.follow([[0, 0, 0], [30, 0, 0]], 1.5)
        while human.time < 3.5 + 0.2 * seed:
            human.tick()
        x, y, _ = human.position
        assert np.linalg.norm(human.velocity) > 1.0
        human.follow([[x, y, 0], [x - 3.0, rng.uniform(-1, 1), 0]], 1.5)
        while human.status in MOVING:
            human.tick()
        assert human.status == "arrived"


def stays_up_while_told_elsewhere(seed, speed):
    rng = np.random.default_rng(seed)
    human = Human(None, clearing=(), rehearsals=0)
    human.reset((0, 0, 0), 0.0)
    told = 0.0
    while human.time < 20.0 and human.status in ("standing", "walking"):
        if human.time >= told:
            human.follow(straight_on(human.position, human.yaw + rng.uniform(-1.0, 1.0)), speed)
            told = human.time + rng.uniform(0.5, 2.5)
        human.tick()
    return human.status == "walking"


@pytest.mark.parametrize(("speed", "least"), [(1.25, 11), (2.0, 9)])
def test_a_walking_person_that_is_told_elsewhere_again_and_again_stays_up(speed, least):
    """Half of such walks ended in a fall when people turned as fast in a walk as on the spot."""
    assert enough((stays_up_while_told_elsewhere(seed, speed) for seed in range(12)), least)
