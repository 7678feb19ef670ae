"""A world of which only what is around its players is loaded."""

import dataclasses
import shutil
from itertools import pairwise

import numpy as np
import pytest

import navmesh
from navmesh.streaming.choosing import HOLD
from runtime import (
    Arrived,
    Blocked,
    Departed,
    Fell,
    Lost,
    RuntimeInputError,
    Stuck,
    Waiting,
    World,
    WorldState,
)
from runtime.planning.level import Level
from runtime.planning.planning import NoWay
from runtime.world.streaming import CHANGES, EVERY, Streaming, StreamingState
from surefoot.files.archive import ArchiveError
from tests.runtime.strip import END, ISLAND, START, strip, strip_folder

BODIES = ("human", "dog", "walker")
SPEED = 4.0


def advance(world, seconds, until=lambda: False):
    """Step until a condition holds, and see to it that nobody is where nothing is loaded; the events."""
    events = []
    for _ in range(round(seconds / 0.1)):
        world.step(0.1)
        events += world.events
        for agent in world.agents.values():
            assert world.graph.project(agent.position[None])[0][0] >= 0, f"{agent} stands on nothing"
        if until():
            break
    assert not [event for event in events if isinstance(event, Lost | Stuck)]
    return events


def told(events, agent):
    return [type(event) for event in events if event.agent == agent.name and not isinstance(event, Fell)]


def chunks_at(x, radius):
    """Chunks of 10 m that are at most so far from a place on the strip."""
    return {f"{k:02}" for k in range(12) if max(10.0 * k - x, x - 10.0 * (k + 1), 0.0) <= radius}


@pytest.mark.parametrize("body", BODIES)
def test_a_player_goes_to_a_place_that_is_not_loaded(body):
    world = World(strip(), seed=1)
    agent = world.spawn(body, START)
    world.players = [agent]
    assert agent.go_to(END, speed=SPEED) in ("walking", "running")
    progress, most, events = [], 0, []
    while agent.moving and world.time < 90.0:
        events += advance(world, 0.5)
        progress.append(agent.progress)
        most = max(most, len(world.loaded))
        assert chunks_at(agent.position[0], 15.0) <= set(world.loaded)
        assert set(world.loaded) <= chunks_at(agent.position[0], 45.0)
    assert agent.status == "arrived" and agent.progress == pytest.approx(1.0, abs=0.6 / 112.0)
    assert np.linalg.norm(agent.position - END) < 0.6
    assert told(events, agent)[:1] == [Departed] and told(events, agent)[-1] == Arrived
    assert Arrived not in told(events, agent)[:-1] and Waiting not in told(events, agent)
    departed = next(event for event in events if isinstance(event, Departed))
    assert departed.goal == END and departed.length == pytest.approx(112.0, abs=2.0)
    assert most < 10 and "00" not in world.loaded
    # refining changes the length that is left by what is taken as straight until it is loaded
    assert all(b > a - 0.03 for a, b in pairwise(progress))
    assert np.interp(0.5, progress, np.arange(len(progress))) == pytest.approx(0.5 * len(progress), rel=0.2)


@pytest.mark.parametrize("body", BODIES)
def test_others_wait_where_nothing_more_is_loaded_and_go_on_when_it_is(body):
    world = World(strip(), seed=1)
    agent = world.spawn(body, START)
    agent.go_to([(8.0, 5.0, 0.0), END], speed=SPEED)
    events = advance(world, 30.0, lambda: agent.status == "waiting")
    assert told(events, agent) == [Departed, Waiting] and not agent.moving
    assert events[-1].goal == END
    assert 15.0 < agent.position[0] < 30.0 and 0.1 < agent.progress < 0.3
    advance(world, 2.0)
    here, loaded = agent.position, world.loaded
    world.players = [(5.0, 5.0, 0.0)]
    events = advance(world, 3.0)
    assert agent.status == "waiting" and not told(events, agent)
    assert np.linalg.norm(agent.position - here) < 0.1 and set(loaded) <= set(world.loaded)
    world.players = [(60.0, 5.0, 0.0)]
    events = advance(world, 60.0, lambda: agent.status == "waiting" and agent.position[0] > 60.0)
    assert told(events, agent)[0] == Departed and told(events, agent)[-1] == Waiting
    world.players = [END]
    events = advance(world, 30.0, lambda: agent.status == "arrived")
    assert told(events, agent) == [Departed, Arrived]
    assert np.linalg.norm(agent.position - END) < 0.6


def test_one_that_cannot_set_out_waits_and_one_that_is_told_to_stop_does_not():
    world = World(strip(), seed=1)
    agent = world.spawn("walker", (22.0, 5.0, 0.0))
    agent.go_to(END)
    advance(world, 20.0, lambda: agent.status == "waiting")
    agent.go_to(END)  # it may go some metres farther than the last coarse waypoint
    advance(world, 20.0, lambda: agent.status == "waiting")
    for _ in range(3):
        assert agent.go_to(END) == "waiting"
    with pytest.raises(NoWay, match="not loaded yet"):
        agent.plan(END)
    agent.stop()
    assert agent.status == "arrived"
    while world.keep_around(END):
        pass
    assert not agent.moving


@pytest.mark.parametrize("body", BODIES)
def test_a_far_goal_that_no_way_leads_to_is_answered_at_once(body):
    world = World(strip(), seed=1)
    agent = world.spawn(body, START)
    assert agent.go_to([END, ISLAND]) == "blocked"
    (blocked,) = world.events
    assert isinstance(blocked, Blocked) and blocked.goal == ISLAND and "no way leads there" in blocked.reason
    assert agent.go_to((5.0, 300.0, 0.0)) == "blocked"
    assert "not near a place" in world.events[0].reason


@pytest.mark.parametrize("body", BODIES)
def test_nobody_loses_the_ground_under_its_feet(body):
    world = World(strip(), seed=1)
    agent = world.spawn(body, START)
    world.players = [END]
    events = advance(world, 6.0)
    assert not events and agent.position[2] == pytest.approx(0.0, abs=0.02)
    assert chunks_at(START[0], HOLD) <= set(world.loaded) and chunks_at(END[0], 25.0) <= set(world.loaded)
    assert "05" not in world.loaded
    agent.remove()
    world.step(2.0)
    assert set(world.loaded) == chunks_at(END[0], 25.0)


def test_ground_and_graph_change_together_at_counted_moments():
    world = World(strip(), seed=1)
    agent = world.spawn("human", START)
    world.players = [(60.0, 5.0, 0.0)]
    before, changed = world.loaded, []
    for tick in range(400):
        world.step(0.01)
        if world.loaded != before:
            changed.append(tick)
            assert 1 <= len(set(before) ^ set(world.loaded)) <= CHANGES
            before = world.loaded
        assert agent.ground is Level.of(world.graph).ground
        assert {chunk.name for chunk in world.graph.terrain.chunks} == set(world.loaded)
    assert changed[:3] == [EVERY, 2 * EVERY, 3 * EVERY]


def test_a_person_who_runs_does_not_notice_that_chunks_far_away_come_and_go():
    def run(changes):
        world = World(strip((60.0, 5.0, 0.0), radius=56.0), seed=2)
        person = world.spawn("human", START)
        person.go_to((30.0, 5.0, 0.0), speed=3.3)
        if changes:
            world.players = [(32.0, 5.0, 0.0)]
        places = []
        for _ in range(45):
            world.step(0.2)
            places.append(person.position)
        return np.array(places), world.loaded

    (still, before), (changing, after) = run(False), run(True)
    assert len(after) < len(before) and still[-1, 0] > 20.0
    assert np.abs(still - changing).max() < 1e-9


@pytest.mark.parametrize("detail", ["full", "low"])
def test_one_who_plays_recorded_motion_goes_on_after_a_change_of_detail(detail):
    world = World(strip(), seed=1)
    agent = world.spawn("human", START, detail=detail)
    world.players = [agent]
    agent.go_to(END, speed=3.0)
    events = advance(world, 8.0)
    agent.detail = "physics"
    events += advance(world, 8.0, lambda: agent.level == "physics")
    agent.detail = detail
    events += advance(world, 60.0, lambda: agent.status == "arrived")
    assert told(events, agent) == [Departed, Arrived] and agent.level == detail


def test_a_player_whose_next_waypoint_is_out_of_its_reach_has_it_loaded_all_the_same():
    world = World(strip(radius=6.0), seed=1)
    agent = world.spawn("walker", START)
    world.players = [agent]
    agent.go_to(END, speed=SPEED)
    advance(world, 90.0, lambda: agent.status == "arrived")
    assert agent.status == "arrived" and len(world.loaded) < 8


def test_several_worlds_of_one_open_world_do_not_disturb_each_other():
    open_world = strip()
    before = open_world.loaded
    one, two = World(open_world), World(open_world)
    one.keep_around(END, 100)
    assert open_world.loaded == two.loaded == before != one.loaded
    assert one.level_digest == two.level_digest == open_world.digest


# --- the same run again
def crowded(**options):
    """A world in which people, a dog and walkers go to and fro between what is loaded and what is not."""
    world = World(strip(), seed=3, **options)
    agents = [
        world.spawn(body, (x, y, 0.0)) for body, x, y in (("human", 4, 3), ("dog", 5, 6), ("walker", 8, 8))
    ]
    world.players = [agents[0], START]
    agents.append(world.spawn("walker", (20.0, 2.0, 0.0)))
    for agent in agents:
        agent.go_to([(14.0, 5.0, 0.0), END, START], speed=1.5 if agent.body == "human" else SPEED)
    return world


def test_a_run_is_the_same_with_another_thread_and_from_a_file(tmp_path):
    world, threaded = crowded(), crowded(threads=2)
    moments = []
    for _ in range(18):
        world.step(0.7)
        moments.append((world.save(), world.state_hash()))
    threaded.step(18 * 0.7)
    assert threaded.state_hash() == world.state_hash() and threaded.loaded == world.loaded
    changing = next(k for k, (state, _) in enumerate(moments) if state.streaming.changed)
    waiting = next(
        k for k, (state, _) in enumerate(moments) if any(each.errand.waits for each in state.agents.values())
    )
    for moment in (changing, waiting, 17):
        state, seen = moments[moment]
        state.write(tmp_path / "state.npz")
        other = World(strip(END), seed=9)
        other.spawn("walker", END)
        other.restore(WorldState.read(tmp_path / "state.npz"))
        assert other.state_hash() == seen and other.loaded == state.streaming.loaded
        assert [agent.name for agent in other.players[:1]] == ["human1"]
        for _ in range(17 - moment):
            other.step(0.7)
        assert other.state_hash() == world.state_hash()
    people = dict(world.agents)
    world.restore(moments[3][0])
    assert world.agents == people and world.state_hash() == moments[3][1]


def test_the_hash_tells_of_what_is_loaded_and_who_plays():
    world = World(strip())
    agent = world.spawn("walker", START)
    seen = {world.state_hash()}
    world.players = [agent]
    seen.add(world.state_hash())
    world.keep_around(END, 1)
    seen.add(world.state_hash())
    agent.go_to(END)
    seen.add(world.state_hash())
    assert len(seen) == 4


def streaming(state, **changes):
    return dataclasses.replace(state, streaming=dataclasses.replace(state.streaming, **changes))


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda state: streaming(state, loaded=("no",)), "does not have"),
        (lambda state: streaming(state, changed=("no",)), "does not have"),
        (lambda state: streaming(state, loaded=()), "nobody can stand"),
        (lambda state: streaming(state, players=("nobody",)), "none of its agents"),
        (lambda state: streaming(state, players=((0.0, np.inf, 0.0),)), "not finite"),
        (lambda state: dataclasses.replace(state, streaming=None), "does not say what"),
    ],
)
def test_a_state_that_does_not_fit_is_refused_and_nothing_changes(damage, message):
    world = crowded()
    world.step(1.0)
    before = world.state_hash()
    with pytest.raises(RuntimeInputError, match=message):
        world.restore(damage(world.save()))
    assert world.state_hash() == before


def test_waits_and_ways_that_nobody_has_are_refused():
    world = crowded()
    world.step(6.0)
    state = world.save()
    for name, agent in state.agents.items():
        for errand in (
            dataclasses.replace(agent.errand, beyond=None, waits=True),
            dataclasses.replace(agent.errand, length=np.inf),
        ):
            agents = {**state.agents, name: dataclasses.replace(agent, errand=errand)}
            with pytest.raises(RuntimeInputError):
                world.restore(dataclasses.replace(state, agents=agents))


# --- what is refused
def test_what_does_not_fit_an_open_world_is_refused():
    with pytest.raises(RuntimeInputError, match="nothing that one can walk on is loaded"):
        World(navmesh.OpenWorld(strip_folder(), 20.0))
    world = World(strip())
    with pytest.raises(RuntimeInputError, match="is not loaded; call keep_around"):
        world.spawn("walker", END)
    with pytest.raises(RuntimeInputError, match=r"bodies of up to 0.5 m; bake it with radii=\(..., 0.8\)"):
        world.spawn("walker", START, radius=0.8)
    with pytest.raises(RuntimeInputError, match="is as it was baked"):
        world.change_level({"00": None})
    for players in (None, "ada", [(1.0, 2.0)], [[(1.0, 2.0, 3.0)] * 2], ["ada"]):
        with pytest.raises(RuntimeInputError, match="player"):
            world.players = players
    with pytest.raises(RuntimeInputError, match="not in this world"):
        world.players = [World(strip()).spawn("walker", START)]
    with pytest.raises(navmesh.NavmeshError, match="changes = 0"):
        world.keep_around(START, 0)
    assert world.players == () and world.loaded == ("00", "01", "02")


def test_a_level_that_is_loaded_as_a_whole_has_no_chunks_around_players():
    world = World(strip().graph)
    assert world.players == () and world.loaded == ()
    with pytest.raises(RuntimeInputError, match=r"make the world of a navmesh\.OpenWorld"):
        world.keep_around(START)
    with pytest.raises(RuntimeInputError, match=r"make the world of a navmesh\.OpenWorld"):
        world.players = []


def test_the_last_ground_is_not_dropped():
    world = World(strip())
    before = world.loaded
    assert world.keep_around((0.0, 5000.0, 0.0), 100) == {} and world.loaded == before
    world.players = [(0.0, 5000.0, 0.0)]
    world.step(5.0)
    assert world.loaded


def test_a_chunk_that_cannot_be_read_stops_the_step_and_the_world_can_go_on(tmp_path):
    folder = shutil.copytree(strip_folder(), tmp_path / "strip.world")
    open_world = navmesh.OpenWorld(folder, 25.0)
    open_world.keep_around(START, 100)
    world = World(open_world)
    agent = world.spawn("walker", START)
    (folder / "chunk-00004.npz").unlink()
    world.players = [(40.0, 5.0, 0.0)]
    with pytest.raises(ArchiveError, match="chunk-00004"):
        world.step(3.0)
    assert agent.go_to((20.0, 5.0, 0.0)) == "walking"
    world.players = []
    world.step(30.0)
    assert agent.status == "arrived"


def test_what_was_begun_is_forgotten_when_the_host_changes_chunks_itself():
    streaming = Streaming(strip())
    streaming.players = (END,)
    assert streaming.turn({}) is None and streaming.save().changed
    level, found = streaming.keep_around(START, 1, {})
    assert level is None and not found and streaming.save().changed
    level, found = streaming.keep_around(END, 1, {})
    assert level is not None and list(found) == ["11"]
    assert streaming.save() == StreamingState(("00", "01", "02", "11"), (END,), ())
