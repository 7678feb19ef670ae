"""Worlds: time, agents, events, determinism, saving."""

import dataclasses

import numpy as np
import pytest

import navmesh
from locomotion.rehearsal.lookahead import Lookahead
from locomotion.skills.jump.skill import load_jump_skill
from runtime import Blocked, Departed, Event, RuntimeInputError, World
from runtime.bodies.figure import rotate, turn
from runtime.evaluation.courses import make_course
from runtime.planning.rules import person_walk_rules


def test_steps_of_any_length_make_whole_ticks(graph):
    world = World(graph)
    made = sum(world.step(1 / 60) for _ in range(60))
    assert made == 100
    assert world.time == pytest.approx(1.0)
    assert world.step(0.004) == 0
    assert world.step(0.004) == 0
    assert world.step(0.004) == 1
    assert world.step(0.0) == 0
    assert sum(world.step(1e-4) for _ in range(1000)) == 10


def test_refuses_what_is_no_seed_listener_or_state(graph):
    for seed in (-1, 1.5, "one", None, True):
        with pytest.raises(RuntimeInputError, match="seed must be a whole number"):
            World(graph, seed=seed)
    world = World(graph)
    for callback, kind in ((5, Event), (print, int), (print, "Arrived")):
        with pytest.raises(RuntimeInputError, match="listen takes a function and a class"):
            world.listen(callback, kind)
    for state in (None, {}, world):
        with pytest.raises(RuntimeInputError, match="from what save gave"):
            world.restore(state)
    for agent in (None, "human1"):
        with pytest.raises(RuntimeInputError, match="an Agent is removed"):
            world.remove(agent)
    with pytest.raises(RuntimeInputError, match="expected an Event, got 'Arrived'"):
        world.report("Arrived")
    assert world.events == []
    for skills in (None, 5, "hop.yaml", [5]):
        with pytest.raises(RuntimeInputError, match="skills must be a list of files"):
            World(graph, skills=skills)


@pytest.mark.parametrize("dt", [-0.01, np.nan, np.inf, "1", None])
def test_refuses_a_bad_step(graph, dt):
    with pytest.raises(RuntimeInputError, match="dt must be"):
        World(graph).step(dt)


def test_people_rehearse_as_much_as_their_world_says(graph, monkeypatch):
    def fails(body):
        yield
        return 0.0, []

    monkeypatch.setattr(Lookahead, "go_on", lambda *_: None)  # all at the moment
    with pytest.raises(RuntimeInputError, match="rehearsals must be"):
        World(graph, rehearsals=-1)
    course = make_course([("jump", 0.4, 0.0)], [10.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    tried = []
    for most in (0, 1, 3):
        world = World(terrain, rehearsals=most)
        human = world.spawn("human", (0.0, 0.0, 0.0)).human
        seen = []
        choose = human.decider.best
        human.decider.best = lambda body, choices, do, goes, seen=seen, choose=choose: choose(
            body, choices, lambda body, choice: (seen.append(choice), do(body, choice)), fails
        )
        world.agents["human1"].go_to((20.0, 0.0, 0.4), speed=3.0)
        while not seen and world.time < 12.0:
            world.step(0.01)
        tried.append(len(seen))
    assert tried == [0, 1, 3]


def test_how_time_is_cut_does_not_matter(graph):
    hashes = set()
    for cuts in ([0.01] * 60, [0.6], [0.25, 0.05, 0.3]):
        world = World(graph, seed=5)
        world.spawn("human", (2.0, 3.0, 0.0)).go_to((9.0, 3.0, 0.0), speed=3.0)
        for dt in cuts:
            world.step(dt)
        hashes.add((world.time, *(agent.human.state_hash() for agent in world.agents.values())))
    assert len(hashes) == 1


def test_the_seed_is_part_of_the_state(graph):
    assert World(graph, seed=1).state_hash() == World(graph, seed=1).state_hash()
    assert World(graph, seed=1).state_hash() != World(graph, seed=2).state_hash()


def test_a_restored_world_goes_on_the_same_way(graph):
    world = World(graph, seed=5)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    agent.go_to((9.0, 3.0, 0.0), speed=3.0)
    world.step(0.5)
    saved = world.save()
    world.random.random()
    world.step(0.5)
    first = world.state_hash(), world.events
    world.restore(saved)
    world.random.random()
    world.step(0.5)
    assert (world.state_hash(), world.events) == first


def test_pose_is_ready_for_a_skeleton(graph):
    world = World(graph)
    pose = world.spawn("human", (2.0, 3.0, 0.0), facing=1.0).pose
    n = len(pose.names)
    assert pose.transforms.shape == (n, 7) and pose.transforms.dtype == np.float64
    assert pose.names[0] == "pelvis" and pose.parents[0] == -1
    assert all(0 <= parent < child for child, parent in enumerate(pose.parents) if child > 0)
    assert np.linalg.norm(pose.transforms[:, 3:], axis=1) == pytest.approx(1.0)
    assert pose.local.shape == (n, 7) and pose.local[0] == pytest.approx(pose.transforms[0])
    for child in range(1, n):  # parents first: the chain of local transforms gives the ones in the world
        above, own = pose.transforms[pose.parents[child]], pose.local[child]
        assert above[:3] + rotate(above[3:], own[:3]) == pytest.approx(pose.transforms[child, :3])
        assert turn(above[3:], own[3:]) == pytest.approx(pose.transforms[child, 3:])
    assert pose.transforms[0, :2] == pytest.approx([2.0, 3.0], abs=0.2)


def test_events_are_typed_and_drained(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    assert agent.go_to((9.0, 3.0, 0.0)) == "walking"
    (event,) = world.events
    assert (
        isinstance(event, Departed) and event.agent == "ada" and event.length == pytest.approx(7.0, abs=0.5)
    )
    assert event.to_dict()["kind"] == "Departed"
    assert world.events == []


def test_goes_through_several_points(graph):
    world = World(graph)
    agent = world.spawn("human", (1.0, 3.0, 0.0))
    agent.go_to([(6.0, 1.5, 0.0), (11.0, 4.5, 0.0)])
    (plan,) = agent.plans
    assert np.min(np.linalg.norm(plan.points - [6.0, 1.5, 0.0], axis=1)) < 1e-6
    assert plan.points[-1] == pytest.approx([11.0, 4.5, 0.0])


@pytest.mark.parametrize(
    ("goal", "reason"), [((18.0, 3.0, 0.0), "no way leads there"), ((50.0, 3.0, 0.0), "not near a place")]
)
def test_an_unreachable_goal_blocks(graph, goal, reason):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    assert agent.go_to(goal) == "blocked" == agent.status
    (event,) = world.events
    assert isinstance(event, Blocked) and reason in event.reason and event.goal == goal


@pytest.mark.parametrize(("body", "offer"), [("human", "jump "), ("walker", "no skills")])
def test_an_obstacle_that_no_skill_clears_is_named(body, offer, monkeypatch):
    whole = load_jump_skill()
    low = {name: getattr(whole, name)[:2] for name in ("heights", "table", "references")}
    monkeypatch.setattr(
        "locomotion.skills.jump.kind.load_jump_skill", lambda: dataclasses.replace(whole, **low)
    )
    course = make_course([("jump", 0.65, 0.0)], [8.0])
    terrain = navmesh.Terrain.from_arrays(course.vertices, course.faces)
    world = World(navmesh.NodeGraph.build(terrain, person_walk_rules()))
    agent = world.spawn(body, (1.0, 0.0, 0.0))
    assert agent.go_to((12.0, 0.0, 0.65)) == "blocked"
    event = world.events[-1]
    assert isinstance(event, Blocked) and f"lead over jump 0.65 m; there are {offer}" in event.reason


@pytest.mark.parametrize("body", ["human", "dog"])
def test_blended_poses_move_evenly_between_ticks(graph, body):
    world = World(graph)
    agent = world.spawn(body, (2.0, 3.0, 0.0))
    agent.go_to((9.0, 3.0, 0.0), speed=1.2)
    assert (agent.blended_pose.transforms == agent.pose.transforms).all()
    world.step(2.0)
    before = agent.pose
    world.step(0.01)
    after = agent.pose
    assert world.blend == pytest.approx(0.0, abs=1e-6)
    assert agent.blended_pose.transforms == pytest.approx(before.transforms, abs=1e-6)
    moved = np.linalg.norm(after.transforms[:, :3] - before.transforms[:, :3], axis=1)
    assert moved.max() > 1e-3
    for share in (0.25, 0.5, 0.75):
        world.step(0.0025)
        assert world.blend == pytest.approx(share)
        blend = agent.blended_pose.transforms
        straight = before.transforms[:, :3] + share * (after.transforms[:, :3] - before.transforms[:, :3])
        assert np.linalg.norm(blend[:, :3] - straight, axis=1).max() < 0.05 * moved.max()
        assert np.linalg.norm(blend[:, 3:], axis=1) == pytest.approx(1.0)
    assert (agent.pose.transforms == after.transforms).all()


def test_looking_does_not_change_the_run(graph):
    hashes = set()
    for looks in (False, True):
        world = World(graph)
        agents = [world.spawn(body, (2.0, y, 0.0)) for body, y in (("human", 2.0), ("dog", 4.0))]
        for agent in agents:
            agent.go_to((9.0, 3.0, 0.0), speed=3.0)
        for _ in range(120):
            world.step(1 / 60)
            if looks:
                assert all(np.isfinite(a.pose.local).all() for a in agents)
                assert all(np.isfinite(a.blended_pose.transforms).all() for a in agents)
        hashes.add(world.state_hash())
    assert len(hashes) == 1


def test_removed_agents_are_gone_and_the_others_go_on_as_without_them(graph):
    hashes = set()
    for more in (False, True):
        world = World(graph)
        if more:
            others = [world.spawn(body, (5.0, 1.0, 0.0), name=body) for body in ("dog", "human", "cat")]
        dog = world.spawn("dog", (2.0, 3.0, 0.0), name="rex")
        human = world.spawn("human", (2.0, 4.5, 0.0), name="ada")
        if more:
            others[0].go_to((9.0, 1.0, 0.0), speed=1.0)
        for agent in (dog, human):
            agent.go_to((9.0, 3.0, 0.0), speed=1.0)
        world.step(0.5)
        if more:
            for other in others:
                other.remove()
            with pytest.raises(RuntimeInputError, match="not in this world"):
                others[0].remove()
        assert list(world.agents) == ["rex", "ada"]
        assert np.isfinite(dog.blended_pose.transforms).all()
        world.step(1.5)
        hashes.add((world.state_hash(), dog.pose.transforms.tobytes()))
        assert world.spawn("dog", (5.0, 1.0, 0.0)).name == "dog3"
        assert world.spawn("dog", (6.0, 2.0, 0.0)).name == "dog4"
    assert len(hashes) == 1


def test_callbacks_hear_what_polling_tells(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    heard: list[Event] = []
    departures: list[Departed] = []
    stop = world.listen(heard.append)
    world.listen(departures.append, Departed)
    agent.go_to((4.0, 3.0, 0.0), speed=1.2)
    assert heard == []  # told by step, at the end of a tick
    while agent.moving:
        world.step(0.1)
    polled = world.events
    assert [event.kind for event in polled] == ["Departed", "Arrived"]
    assert heard == polled and departures == polled[:1]
    stop()
    agent.go_to((6.0, 3.0, 0.0), speed=1.2)
    world.step(0.1)
    assert len(heard) == 2 and len(departures) == 2


def test_a_callback_can_send_the_agent_on(graph):
    world = World(graph)
    agent = world.spawn("human", (2.0, 3.0, 0.0))
    blocked: list[Blocked] = []

    def again(event):
        blocked.append(event)
        agent.go_to((50.0, 3.0, 0.0))  # is blocked again, which is told in the next tick

    world.listen(again, Blocked)
    agent.go_to((50.0, 3.0, 0.0))
    assert world.step(0.05) == 5
    assert len(blocked) == 5


def test_an_error_in_a_callback_comes_out_and_the_world_goes_on(graph):
    world, quiet = World(graph), World(graph)
    for each in (world, quiet):
        agent = each.spawn("human", (2.0, 3.0, 0.0))
        agent.go_to((9.0, 3.0, 0.0), speed=3.0)

    def fail(event):
        raise ZeroDivisionError

    def misuse(event):
        world.step(0.01)

    heard: list[Event] = []
    stop = world.listen(fail)
    world.listen(heard.append)
    agent = world.agents["human1"]
    agent.go_to((8.0, 3.0, 0.0), speed=3.0)
    quiet.agents["human1"].go_to((8.0, 3.0, 0.0), speed=3.0)
    with pytest.raises(ZeroDivisionError):
        world.step(0.1)
    assert world.time == pytest.approx(0.01)
    stop()
    world.step(0.1)
    quiet.step(0.2)
    assert world.time == pytest.approx(0.2) and world.state_hash() == quiet.state_hash()
    world.listen(misuse)
    agent.go_to((7.0, 3.0, 0.0), speed=3.0)
    with pytest.raises(RuntimeInputError, match="may not step"):
        world.step(0.01)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"body": "goose"}, "valid: 'human'"),
        ({"at": (50.0, 3.0, 0.0)}, "not near a place"),
        ({"at": (2.0, 3.0)}, "finite"),
        ({"facing": np.nan}, "finite"),
        ({"facing": "north"}, "facing must be a finite number"),
        ({"at": "here"}, "finite"),
        ({"at": [(4.0, 3.0, 0.0)]}, "one point"),
        ({"body": None}, "must be text"),
        ({"name": 5}, "must be text"),
        ({"name": ""}, "must be text"),
        ({"body": "walker", "radius": "wide"}, "radius must be a finite number"),
        ({"name": "ada"}, "taken"),
    ],
)
def test_refuses_a_bad_spawn(graph, change, says):
    world = World(graph)
    world.spawn("human", (2.0, 3.0, 0.0), name="ada")
    with pytest.raises(RuntimeInputError, match=says):
        world.spawn(**{"body": "human", "at": (4.0, 3.0, 0.0), **change})


def test_refuses_a_bad_goal_and_a_bad_level(graph):
    agent = World(graph).spawn("human", (2.0, 3.0, 0.0))
    for point in ((1.0, 2.0), (1.0, np.nan, 0.0), (), None, "there", ("1", "2", "0"), [[[1.0, 2.0, 3.0]]]):
        with pytest.raises(RuntimeInputError, match="finite"):
            agent.go_to(point)
    for speed in (None, "fast", np.nan, 0.0, -1.0, True):
        with pytest.raises(RuntimeInputError, match="speed must be"):
            agent.go_to((4.0, 3.0, 0.0), speed=speed)
    with pytest.raises(RuntimeInputError, match="facing must be"):
        agent.go_to((4.0, 3.0, 0.0), facing="north")
    with pytest.raises(RuntimeInputError, match="Terrain or a NodeGraph"):
        World("level.obj")  # type: ignore[arg-type]


@pytest.mark.parametrize("body", ["human", "walker", "dog"])
def test_a_removed_agent_says_so_whatever_it_is_asked(graph, body):
    world = World(graph)
    empty, agent, other = world.save(), *(world.spawn(body, (x, 3.0, 0.0)) for x in (2.0, 6.0))
    agent.remove()
    for use in (
        agent.stop,
        lambda: agent.go_to((4.0, 3.0, 0.0)),
        lambda: agent.plan((4.0, 3.0, 0.0)),
        lambda: agent.position,  # its place among its kind is another's now
        lambda: agent.status,
        lambda: agent.pose,
        lambda: agent.human,
    ):
        with pytest.raises(RuntimeInputError, match=f"{body}1 has been removed from its world"):
            use()
    world.restore(empty)
    with pytest.raises(RuntimeInputError, match=f"{body}2 has been removed from its world"):
        other.stop()
