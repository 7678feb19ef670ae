"""Short moves, footprints, dead ends, many at once, and going on from a saved state."""

import math

import numpy as np
import pytest

import navmesh
from locomotion import Ground, LocomotionError, smooth_route
from locomotion.events import BackedOut
from locomotion.quadruped import (
    Animal,
    Herd,
    Place,
    check_places,
    check_script,
    lay_trail,
    load_body,
    local_motion,
)
from locomotion.quadruped import layout as at
from locomotion.quadruped.following import wrap
from locomotion.quadruped.footprint import at_place, key_balls, script_places
from locomotion.quadruped.local_motion import play_blends
from locomotion.quadruped.manoeuvres import find_manoeuvre, joined
from locomotion.quadruped.script import into_flex
from locomotion.quadruped.turning import turn_script
from tests.locomotion.quadruped.scenes import animal_on, floor, plane, quads, run, wall

DOG = load_body("dog")


# --- local motion


@pytest.mark.parametrize("name", ["dog", "cat", "horse"])
def test_the_table_leads_where_it_says(name):
    table = local_motion(load_body(name))
    rng = np.random.default_rng(1)
    wanted = np.column_stack([rng.uniform(-0.7, 0.7, (200, 2)), rng.uniform(-math.pi, math.pi, 200)])
    weights = np.array([table.look_up(row) for row in wanted])
    miss = play_blends(table.body, weights)[-1] - wanted
    assert np.linalg.norm(miss[:, :2], axis=1).max() < 0.02
    assert np.abs(miss[:, 2]).max() < math.radians(2.0)


def test_a_short_move_ends_where_it_should_with_all_feet_in_place():
    herd = Herd(plane())
    index = herd.add(DOG, (1.0, 1.0, 0.0), 0.5)
    script = local_motion(DOG).script(herd.place(index), (-0.3, 0.4, -1.2))
    herd.play(index, script)
    while not herd.resting(index):
        herd.tick()
    feet = herd.toes(index)
    front, rear = feet[:2, :2].mean(axis=0), feet[2:, :2].mean(axis=0)
    goal = [1.0 - 0.3 * math.cos(0.5) - 0.4 * math.sin(0.5), 1.0 - 0.3 * math.sin(0.5) + 0.4 * math.cos(0.5)]
    assert np.linalg.norm(rear - goal) < 0.02
    assert abs(wrap(math.atan2(*(front - rear)[::-1]) + 0.7)) < math.radians(2.0)


def test_near_goals_are_reached_by_local_motion():
    animal = animal_on(plane())
    animal.go_to((0.5, 0.3, 0.0), facing=0.4)
    assert animal.trail is None and animal.status == "running"
    run(animal)
    assert animal.status == "arrived"
    assert np.linalg.norm(animal.front[:2] - [0.5, 0.3]) < 0.02 and animal.yaw == pytest.approx(0.4, abs=0.02)


def test_out_of_reach_is_refused():
    with pytest.raises(LocomotionError, match="outside of local motion's reach"):
        local_motion(DOG).look_up((2.0, 0.0, 0.0))
    with pytest.raises(LocomotionError, match="finite"):
        local_motion(DOG).look_up((0.0, math.nan, 0.0))


# --- footprint


def test_a_wall_in_the_way_is_seen_and_named():
    ground = Ground.from_arrays(*quads(floor(), wall((1.2, -2.0), (1.2, 2.0))))
    move = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.6, 0.0, 0.0))
    found = check_script(move, DOG, ground)
    assert not found.free and found.part == "head" and found.place[0] == pytest.approx(1.2, abs=0.15)
    assert check_script(move, DOG, plane()).free


def test_an_edge_is_no_ground():
    ground = Ground.from_arrays(*quads(floor(x1=0.9)))
    move = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.8, 0.0, 0.0))
    assert check_script(move, DOG, ground).part == "ground"


def test_samples_are_as_close_as_they_say():
    script = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.3), (0.2, -0.5, 2.5))
    centres = key_balls(script_places(script, DOG), DOG).centres
    assert np.linalg.norm(np.diff(centres, axis=0), axis=2).max() <= 0.021


def test_what_passes_stays_clear_of_random_walls():
    rng = np.random.default_rng(4)
    passed = 0
    for _ in range(60):
        a, b = rng.uniform(-1.2, 1.2, (2, 2))
        ground = Ground.from_arrays(*quads(floor(), wall(a, b)))
        turn = float(rng.uniform(-3.0, 3.0))
        script = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (*rng.uniform(-0.4, 0.4, 2), turn))
        balls = key_balls(script_places(script, DOG), DOG)
        off = balls.centres[:, :, :2] - a
        share = np.clip(off @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        gap = (np.linalg.norm(off - share[..., None] * (b - a), axis=2) - balls.radii).min()
        found = check_script(script, DOG, ground)
        assert found.free == (gap >= 0.0)
        passed += found.free
    assert 5 < passed < 55


# --- dead ends


class GraphPlanner:
    """A planner on a graph."""

    def __init__(self, vertices, faces):
        terrain = navmesh.Terrain.from_arrays(vertices, faces)
        self.graph = navmesh.NodeGraph.build(terrain, DOG.walk_rules(0.08), obstacle_rules=None)

    def way(self, start, goal, direction):
        route = self.graph.find_path(start, goal, radius=DOG.radius)
        if route.status != "complete":
            raise ValueError(route.status)
        return smooth_route(route, DOG.smoothing, direction)

    def room_to_turn(self, points, length):
        return self.graph.room_to_turn(points, length)


def dead_end(width):
    """A room x < 0, and a passage of 2 m off it, closed at x = 2."""
    half = width / 2
    loop = [(-4, -3), (0, -3), (0, -half), (2, -half), (2, half), (0, half), (0, 3), (-4, 3)]
    return quads(floor(), *(wall(a, b) for a, b in zip(loop, loop[1:] + loop[:1], strict=True)))


def test_backs_out_of_a_dead_end_and_turns_where_there_is_room():
    vertices, faces = dead_end(0.5)
    ground = Ground.from_arrays(vertices, faces)
    herd = Herd(ground)
    animal = Animal(herd, herd.add(DOG, (-2.0, 0.3, 0.0), 0.0), GraphPlanner(vertices, faces))
    animal.go_to((1.5, 0.0, 0.0), 1.0)
    run(animal)
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(1.5, abs=0.02)
    animal.go_to((-3.0, 0.5, 0.0), 1.0)
    inside = []
    run(animal, each=lambda: inside.append((animal.position[0], animal.yaw)))
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(-3.0, abs=0.02)
    (backed,) = [event for event in animal.events if isinstance(event, BackedOut)]
    assert backed.distance > 1.0
    assert all(abs(yaw) < 0.3 for x, yaw in inside if x > 0.3)  # it never turns in the passage


def test_without_crumbs_it_finds_its_way_out_by_short_moves():
    vertices, faces = dead_end(0.5)
    herd = Herd(Ground.from_arrays(vertices, faces))
    animal = Animal(herd, herd.add(DOG, (0.9, 0.0, 0.0), 0.0), GraphPlanner(vertices, faces))
    animal.go_to((-3.0, 0.5, 0.0), 1.0)
    free = []

    def look():
        place = herd.place(animal.index)
        free.append(check_places(at_place(place), DOG, herd.ground).free)

    run(animal, each=look)
    assert animal.status == "arrived" and animal.front[0] == pytest.approx(-3.0, abs=0.02)
    assert all(free)


def test_without_room_for_any_move_it_is_told_so_and_stays_as_it_is():
    loop = [(-0.2, -0.2), (1.0, -0.2), (1.0, 0.2), (-0.2, 0.2)]
    walls = (wall(a, b) for a, b in zip(loop, loop[1:] + loop[:1], strict=True))
    animal = animal_on(Ground.from_arrays(*quads(floor(), *walls)))
    before = animal.herd.toes(0)
    with pytest.raises(LocomotionError, match="a dog has no room to turn towards its path"):
        animal.go_to((-3.0, 0.5, 0.0), 1.0)
    assert animal.status == "standing" and not animal.events and animal.trail is None
    animal.herd.tick()
    assert np.array_equal(animal.herd.toes(0), before)


def test_a_manoeuvre_ends_where_the_way_leads_on_and_touches_nothing():
    vertices, faces = dead_end(0.5)
    ground, place = Ground.from_arrays(vertices, faces), Place(0.9, 0.0, 0.0, 0.0)
    trail = lay_trail([[0.9, 0.0, 0.0], [-3.0, 0.0, 0.0]], DOG, ground)
    asked = []

    def leads_on(there):
        asked.append(there)
        return there.x < -0.5

    script = find_manoeuvre(DOG, ground, place, trail, leads_on)
    assert check_script(script, DOG, ground).free
    assert script.end() == asked[-1] and script.end().x < -0.5
    assert np.allclose(script.rows[0, :4], [place.x, place.y, place.z, place.yaw])
    assert find_manoeuvre(DOG, ground, place, trail, lambda there: False) is None


def test_joined_scripts_play_one_after_the_other():
    first = local_motion(DOG).script(Place(0.0, 0.0, 0.0, 0.0), (0.4, 0.0, 0.0))
    second = local_motion(DOG).script(first.end(), (0.0, 0.2, 0.5))
    both = joined([first, second])
    assert both.seconds == pytest.approx(first.seconds + second.seconds, abs=0.03)
    assert both.end() == second.end()
    half = round(first.seconds / both.seconds * (len(both.rows) - 1))
    assert both.rows[half, [at.SX, at.SY]] == pytest.approx([first.end().x, first.end().y], abs=0.01)
    assert np.linalg.norm(np.diff(both.rows[:, [at.SX, at.SY]], axis=0), axis=1).max() < 0.03


# --- many at once, again


def test_an_animal_does_not_care_about_the_others():
    ground = plane()
    bend = np.column_stack([np.linspace(0, 5, 60), np.sin(np.linspace(0, 5, 60)), np.zeros(60)])

    def hashes(count, chosen):
        herd = Herd(ground)
        for k in range(count):
            body = load_body(("dog", "cat", "horse")[k % 3])
            index = herd.add(body, (0.0, 0.5 * k, 0.0), 0.0)
            herd.follow(index, lay_trail(bend + np.array([0.0, 0.5 * k, 0.0]), body, ground), 0.8)
        for _ in range(200):
            herd.tick()
        return [herd.state_hash(k) for k in chosen]

    assert hashes(4, [0, 1, 3]) == hashes(30, [0, 1, 3])


def test_a_restored_animal_goes_on_the_same_way():
    animal = animal_on(plane(), yaw=2.0)
    animal.go_to([(3.0, 1.0, 0.0), (0.5, 0.5, 0.0)], 1.5, facing=1.0)
    for _ in range(130):
        animal.herd.tick()
        animal.tick()
    saved, events = animal.save(), len(animal.events)
    hashes = []
    for _ in range(2):
        run(animal)
        hashes.append((animal.state_hash(), animal.time, len(animal.events)))
        animal.restore(saved)
        assert len(animal.events) == events
    assert hashes[0] == hashes[1]


def test_into_flex_moves_the_front_alone():
    place = Place(1.0, 2.0, 0.0, 0.4)
    script = into_flex(DOG, place, 0.1)
    assert np.ptp(script.rows[:, [at.SX, at.SY, at.SYAW]], axis=0).max() == 0.0
    assert script.end().bend == pytest.approx(0.1)


def test_told_anew_while_it_turns_onto_its_path_it_takes_the_new_one():
    animal = animal_on(plane())
    animal.go_to((3.0, 1.0, 0.0), 1.0)
    assert animal._phase == "flexing"
    for _ in range(5):
        animal.herd.tick()
        animal.tick()
    animal.go_to((-1.0, 4.0, 0.0), 1.0)
    run(animal)
    assert animal.status == "arrived"
    assert np.linalg.norm(animal.front[:2] - (-1.0, 4.0)) < 0.1


@pytest.mark.parametrize("goals", [(), (1.0, 2.0), (0.0, math.nan, 0.0)])
def test_a_goal_that_is_none_is_refused(goals):
    with pytest.raises(LocomotionError, match="goals must be finite"):
        animal_on(plane()).go_to(goals)


def test_a_long_body_without_room_is_not_turned():
    horse, place = load_body("horse"), Place(0.0, 0.0, 0.0, 0.0)
    lane = Ground.from_arrays(*quads(floor(x0=-1.5, x1=3.0, y0=-0.6, y1=0.6)))
    for yaw in (-3.0, -2.0, -1.2, 1.2, 2.0, 3.0):
        assert turn_script(horse, lane, place, yaw) is None
