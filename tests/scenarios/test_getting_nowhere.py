"""Whoever gets nowhere says so within 10 s, with a reason, and does something else."""

import numpy as np
import pytest
import trimesh

import navmesh
from locomotion.body_events import WentBack
from runtime import Arrived, Blocked, Departed, Hindered, Stuck, World
from runtime.planning.rules import person_walk_rules
from runtime.traffic.waiting_and_deadlock import ANOTHER_WAY, PATIENCE, Headway


def graph_of(*blocks):
    """Of boxes from their low to their high corners."""
    mesh = trimesh.util.concatenate([trimesh.creation.box(bounds=each) for each in blocks])
    terrain = navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces)
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


@pytest.fixture(scope="module")
def gap_and_platform():
    """A floor of 16 m, a gap of 0.9 m, and 8.5 m behind it a platform of 0.4 m that one has to jump onto."""
    return graph_of(
        ((0, 0, -0.3), (16, 20, 0)), ((16.9, 0, -0.3), (40, 20, 0)), ((25.4, 5, 0), (33, 15, 0.4)),
        ((15, 0, -4), (18, 20, -3.8)),
    )  # fmt: skip


def events_until_it_stops(world, agent, limit):
    """What is told; fails if it gets no nearer to its goal and says nothing for longer than 11 s."""
    events, told, nearest = world.events, world.time, np.inf
    while agent.moving and world.time < limit:
        world.step(0.1)
        new = world.events
        events += new
        left = agent.driver.left
        if new or left < nearest - 0.25:
            told, nearest = world.time, left if new else min(left, nearest)
        assert world.time - told < 11.0
    return events


@pytest.mark.parametrize("y", [7.3, 11.0, 13.6])
def test_a_platform_behind_a_gap_is_run_up_to_straight_on(gap_and_platform, y):
    world = World(gap_and_platform)
    agent = world.spawn("human", (3.0, 10.4, 0.0))
    gap, jump = agent.plan((30.0, y, 0.4)).obstacles
    assert (gap.affordance, jump.affordance) == ("gap", "jump")
    assert abs(gap.position[1] - jump.position[1]) < 0.01
    # without regard to it the route steps aside between the two
    plain = gap_and_platform.find_path((3.0, 10.4, 0.0), (30.0, y, 0.4), skills=agent.skills)
    lanes = gap_and_platform.links.edge[[use.link for use in plain.links], 1]
    assert abs(lanes[1] - lanes[0]) > 0.5 or y == 11.0


@pytest.mark.parametrize(("speed", "y"), [(3.3, 7.3), (2.0, 13.6)])
def test_a_person_comes_onto_a_platform_behind_a_gap(gap_and_platform, speed, y):
    world = World(gap_and_platform)
    agent = world.spawn("human", (3.0, 10.4, 0.0))
    agent.go_to((30.0, y, 0.4), speed=speed)
    events = events_until_it_stops(world, agent, 150.0)
    assert isinstance(events[-1], Arrived)


def test_a_person_that_stands_before_a_platform_does_not_pace(gap_and_platform):
    world = World(gap_and_platform)
    agent = world.spawn("human", (19.0, 10.4, 0.0))
    agent.go_to((30.0, 8.0, 0.4), speed=3.3)
    events = events_until_it_stops(world, agent, 60.0)
    assert isinstance(events[-1], Arrived)


def test_a_platform_without_room_for_a_run_up_is_no_way_and_the_reason_says_so():
    # 3.2 m of floor all around it, inside walls
    parts = [((0, 0, -0.3), (12, 12, 0)), ((3.2, 3.2, 0), (8.8, 8.8, 0.5))]
    parts += [((-0.2, -0.2, 0), (12.2, 0, 2.5)), ((-0.2, 12, 0), (12.2, 12.2, 2.5))]
    parts += [((-0.2, 0, 0), (0, 12, 2.5)), ((12, 0, 0), (12.2, 12, 2.5))]
    world = World(graph_of(*parts))
    agent = world.spawn("human", (1.0, 1.0, 0.0))
    assert agent.go_to((6.0, 6.0, 0.5)) == "blocked"
    blocked = world.events[-1]
    assert isinstance(blocked, Blocked)
    assert "jump of 0.50 m" in blocked.reason and "run-up" in blocked.reason


def test_turning_back_at_a_goal_it_does_not_go_past_it():
    world = World(graph_of(((-10, -5, -0.3), (30, 5, 0))))
    agent = world.spawn("human", (5.0, 0.0, 0.0))
    for speed_of in (1.0, -1.0):
        plan = agent.plan([(5.0 + 5.0 * speed_of, 0.0, 0.0), (5.0 - 5.0 * speed_of, 0.0, 0.0)])
        assert np.max(speed_of * (plan.points[:, 0] - 5.0)) < 5.05


def _goes_back(world, agent):
    human = agent.human
    human.events.append(WentBack(human.time, tuple(agent.position), "jump", 0.4, 5.0))
    world.step(0.01)
    return world.events


def test_who_goes_back_again_and_again_says_so_tries_another_way_and_is_stuck_in_the_end(gap_and_platform):
    world = World(gap_and_platform)
    agent = world.spawn("human", (19.0, 10.4, 0.0))
    agent.go_to((30.0, 8.0, 0.4), speed=3.3)
    world.step(1.0)
    first, events = agent.plans[-1], world.events
    events = _goes_back(world, agent)
    assert [type(event) for event in events] == [Hindered]
    assert agent.way is first
    events = _goes_back(world, agent)
    assert [type(event) for event in events] == [Hindered, Departed]
    others = agent.plans[-1].obstacles  # the same platform from another side
    assert abs(others[0].normal[0]) < 0.5 < abs(first.obstacles[0].normal[0])
    while agent.status != "stuck" and world.time < 3.0:
        events = _goes_back(world, agent)
    assert isinstance(events[-1], Stuck) and "run-up" in events[-1].reason


def test_headway_counts_from_the_last_step_towards_the_goal():
    headway = Headway().seen(20.0, 1.0)
    assert not headway.late(1.0 + PATIENCE - 0.1) and headway.late(1.0 + PATIENCE)
    headway = headway.seen(19.9, 5.0)  # hardly nearer
    assert headway.late(1.0 + PATIENCE)
    headway = headway.seen(19.0, 5.0)
    assert not headway.late(1.0 + PATIENCE)
    assert headway.seen(30.0, 9.0) == headway  # farther off
    assert not headway.desperate(5.0 + ANOTHER_WAY - 0.1) and headway.desperate(5.0 + ANOTHER_WAY)


def test_who_is_held_in_place_says_so_within_ten_seconds():
    world = World(graph_of(((-5, -5, -0.3), (25, 5, 0))))
    agent = world.spawn("human", (0.0, 0.0, 0.0))
    agent.go_to((20.0, 0.0, 0.0), speed=1.4)
    agent.human.follower.pace = 0.0
    events = []
    for _ in range(120):
        agent.human.follower.pace = 0.0
        world.step(0.1)
        events += world.events
    assert [type(event) for event in events] == [Departed, Hindered]
    assert events[-1].time <= 10.5 and events[-1].reason == "others are in its way"


def test_what_it_knows_of_its_standstill_is_saved_and_restored():
    graph = graph_of(((-5, -5, -0.3), (25, 5, 0)))
    world = World(graph)
    agent = world.spawn("human", (0.0, 0.0, 0.0), name="ada")
    agent.go_to((20.0, 0.0, 0.0), speed=1.4)
    for _ in range(80):
        agent.human.follower.pace = 0.0
        world.step(0.1)
    other = World(graph)
    other.restore(world.save())
    world.events, other.events  # noqa: B018 - read, and so emptied
    for _ in range(40):
        for each in (world, other):
            each.agents["ada"].human.follower.pace = 0.0
            each.step(0.1)
    told = world.events
    assert [type(event) for event in told] == [Hindered] and told == other.events
    assert world.state_hash() == other.state_hash()


def crates_in_a_corridor(*tops):
    """Crates (x from, x to, height) one on or behind the other, from wall to wall."""
    length, room = max(to for _, to, _ in tops) + 3.0, 3.2
    crates = [((begin, 0, -0.2), (to, room, high)) for begin, to, high in tops]
    walls = [((0, -0.3, -1), (length, 0, 3)), ((0, room, -1), (length, room + 0.3, 3))]
    return graph_of(((0, 0, -1), (length, room, 0)), *crates, *walls)


@pytest.mark.parametrize(
    ("first", "second", "speed"), [((13.9, 29.0, 0.36), (22.9, 28.5, 0.77), 1.4),
                                   ((12.6, 30.0, 0.35), (23.8, 29.0, 0.71), 3.3)]
)  # fmt: skip
def test_onto_a_crate_on_a_crate_nobody_goes_back_more_than_once(first, second, speed):
    world = World(crates_in_a_corridor(first, second))
    agent = world.spawn("human", (2.0, 1.6, 0.0))
    agent.go_to((second[1] - 1.0, 1.6, second[2]), speed=speed)
    events = events_until_it_stops(world, agent, 60.0)
    assert isinstance(events[-1], Arrived)
    goings_back = [each for each in events if isinstance(each, Hindered) and "goes back" in each.reason]
    assert len(goings_back) <= 1


def test_behind_a_crate_it_can_go_back_to_where_it_has_landed():
    graph = crates_in_a_corridor((12.6, 30.0, 0.35), (23.8, 29.0, 0.71))
    agent = World(graph).spawn("human", (2.0, 1.6, 0.0))
    crate, other = agent.plan((28.0, 1.6, 0.71)).obstacles
    assert crate.depth > 8.0  # of the whole crate
    assert crate.far_side == crate.arc_length < other.arc_length - 8.0
