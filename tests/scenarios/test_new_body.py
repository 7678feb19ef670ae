"""A new kind of body takes files of its own and one call: a disc that slides along its path, made here."""

import hashlib
from collections import deque

import numpy as np
import pytest

import navmesh
from locomotion import body_events as bodily
from runtime import Arrived, Blocked, Departed, Lost, RuntimeInputError, World, WorldState
from runtime.bodies.figure import Figure, Shapes
from runtime.bodies.kinds.kind import BodyKind
from runtime.bodies.protocol import PLANS_KEPT, Driver, Population, recall
from runtime.bodies.registry import body_kinds, body_names, kind_of, register, unregister
from runtime.missions.mission import load_mission, mission_schema
from runtime.missions.run import run_mission
from runtime.planning.planning import Beginning, make_plan, way_holds
from runtime.planning.rules import person_walk_rules
from runtime.playtest import playtest
from runtime.server.messages import REQUEST
from runtime.traces.recording import Recorder
from runtime.traces.trace import Trace
from runtime.views.view import write_page
from surefoot.files.yamlfile import FileError
from tests.small_level import MISSION, obj_text

RADIUS, HIGH, TICK = 0.25, 0.1, 0.01  # [m], [m], [s]


class Disc(Driver):
    """Slides along its path at one speed."""

    def __init__(self, level, place, facing):
        self.level, self.place, self.yaw = level, np.array(place), facing
        self.radius, self.figure = RADIUS, disc_figure()
        self.events, self.plans = [], deque(maxlen=PLANS_KEPT)
        self.state, self.ticks, self.arc, self.speed = "standing", 0, 0.0, 0.0

    simulated = property(lambda self: self)
    time = property(lambda self: self.ticks * TICK)
    status = property(lambda self: self.state)
    position = property(lambda self: self.place.copy())
    facing = property(lambda self: self.yaw)
    left = property(lambda self: self.plans[-1].length - self.arc if self.plans else 0.0)

    @property
    def goals_left(self):
        return 1

    def transforms(self):
        return np.array([[*self.place, np.cos(0.5 * self.yaw), 0.0, 0.0, np.sin(0.5 * self.yaw)]])

    def plan(self, goals):
        return make_plan(self.level.graph, Beginning(self.place), list(goals), RADIUS, {})

    def go_to(self, goals, speed, facing):
        plan = self.plan(goals)
        self.plans.append(plan)
        self.state, self.arc, self.speed = "walking", 0.0, speed
        return plan

    def stop(self):
        self.state = "standing"

    def way_holds(self):
        return way_holds(self.level.graph, self.plans[-1], RADIUS, self.arc)

    def tick(self):
        self.ticks += 1
        if self.state != "walking":
            return
        points = self.plans[-1].points
        steps = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(steps)])
        self.arc = min(self.arc + self.speed * TICK, float(along[-1]))
        there = np.array([np.interp(self.arc, along, points[:, k]) for k in range(3)])
        if np.linalg.norm(there[:2] - self.place[:2]) > 0.0:
            self.yaw = float(np.arctan2(*(there - self.place)[1::-1]))
        self.place = there
        if self.arc >= along[-1]:
            self.state = "arrived"
            self.events.append(bodily.Arrived(self.time, tuple(there.tolist()), 0.0))

    def change_level(self):
        if self.level.graph.find_path(self.place, self.place, radius=RADIUS).status != "complete":
            self.state = "lost"
            self.events.append(bodily.LostGround(self.time, tuple(self.place.tolist())))

    def save(self):
        numbers = (self.state, self.ticks, self.arc, self.speed, self.yaw)
        return numbers, self.place.copy(), tuple(self.plans)[-1:]

    def restore(self, state):
        (self.state, self.ticks, self.arc, self.speed, self.yaw), place, plans = state
        self.place = place.copy()
        recall(self.plans, plans)
        self.events.clear()

    def state_hash(self):
        numbers, place, _ = self.save()
        return hashlib.sha256(repr(numbers).encode() + place.tobytes()).hexdigest()


class Discs(Population):
    """All discs of a world."""

    def __init__(self, level):
        self.level, self.drivers = level, []

    def spawn(self, body, place, facing, radius):
        self.drivers.append(Disc(self.level, place, facing))
        return self.drivers[-1]

    def revive(self, body, state):
        driver = self.spawn(body, np.zeros(3), 0.0, RADIUS)
        driver.restore(state)
        return driver

    def remove(self, driver):
        self.drivers.remove(driver)

    def in_the_way(self):
        rows = [[*each.place, 0.0, 0.0, RADIUS] for each in self.drivers]
        return np.array(rows).reshape(-1, 6)

    def change_level(self):
        for each in self.drivers:
            each.change_level()

    def tick(self):
        for each in self.drivers:
            each.tick()


class DiscKind(BodyKind):
    """The entry of the registry."""

    names = ("toy",)
    bot_speed = 2.0

    def radius(self, body):
        return RADIUS

    def walk_rules(self, body):
        return navmesh.WalkRules(headroom=0.5, max_step=0.1)

    def figure(self, body):
        return disc_figure()

    def populate(self, around):
        return Discs(around.level)


def disc_figure():
    shapes = Shapes(
        place=np.array([[0.0, 0.0, HIGH, 1.0, 0.0, 0.0, 0.0]]),
        size=np.array([[RADIUS, RADIUS, HIGH]]),
        round=np.array([True]),
        colour=np.array([[0.2, 0.6, 0.9]]),
    )
    return Figure(("disc",), np.array([-1], np.int32), np.zeros(1, np.int32), shapes)


@pytest.fixture
def toy():
    """The toy's kind, known for as long as a test runs."""
    kind = DiscKind()
    register(kind)
    yield kind
    unregister(kind)
    assert "toy" not in body_names()


@pytest.fixture(scope="module")
def terrain(tmp_path_factory):
    path = tmp_path_factory.mktemp("new_body") / "level.obj"
    path.write_text(obj_text())
    return navmesh.Terrain.load(path)


@pytest.fixture(scope="module")
def floor(terrain):
    return navmesh.NodeGraph.build(terrain, person_walk_rules())


def test_a_world_runs_saves_and_restores_it(toy, floor, tmp_path):
    world = World(floor)
    disc = world.spawn("toy", (2.0, 3.0, 0.0), facing=1.0)
    assert (disc.name, disc.radius, disc.status) == ("toy1", RADIUS, "standing")
    assert repr(disc) == "<Agent 'toy1': a toy, standing at [2.0, 3.0, 0.0]>"
    assert disc.simulated(Disc).place[0] == 2.0 and disc.skills == {}
    with pytest.raises(RuntimeInputError, match="is a toy, not a Human"):
        _ = disc.human
    assert disc.go_to((18.0, 3.0, 0.0)) == "blocked" and disc.go_to((9.0, 3.0, 0.0), 2.0) == "walking"
    world.step(1.0)
    assert np.allclose(disc.position, (4.0, 3.0, 0.0), atol=0.1) and 0.2 < disc.progress < 0.4
    assert np.array_equal(disc.blended_pose.transforms, disc.pose.transforms)
    saved = world.save()
    saved.write(tmp_path / "state.npz")
    world.step(4.0)
    ends = world.state_hash(), [type(event) for event in world.events]
    assert ends[1][0] is Blocked and ends[1][-1] is Arrived and disc.status == "arrived"
    for state in (saved, WorldState.read(tmp_path / "state.npz")):
        other = World(floor)
        other.restore(state)
        other.step(4.0)
        assert (other.state_hash(), [type(event) for event in other.events]) == ends
    world.remove(disc)
    assert not len(world.save().agents)


def test_it_stops_where_its_level_changes(toy):
    def floor(x0, x1):
        corners = [(x0, 0, 0), (x1, 0, 0), (x1, 6, 0), (x0, 6, 0)]
        return navmesh.Terrain.from_arrays(corners, [(0, 1, 2), (0, 2, 3)])

    chunks = navmesh.join_chunks({"near": floor(0.0, 6.0), "far": floor(6.0, 12.0)})
    world = World(navmesh.NodeGraph.build(chunks, person_walk_rules()))
    disc = world.spawn("toy", (2.0, 3.0, 0.0))
    disc.go_to((10.0, 3.0, 0.0), speed=1.0)
    world.step(1.0)
    world.change_level({"far": None})
    assert disc.status == "blocked" and not disc.moving
    world.change_level({"near": None, "far": floor(6.0, 12.0)})
    world.step(0.1)
    assert [type(event) for event in world.events] == [Departed, Blocked, Lost]
    assert disc.status == "lost"


def test_walkers_go_round_it(toy, floor):
    world = World(floor)
    world.spawn("toy", (5.0, 3.0, 0.0))
    walker = world.spawn("walker", (2.0, 3.0, 0.0))
    walker.go_to((9.0, 3.0, 0.0), speed=1.5)
    nearest = np.inf
    while walker.moving and world.time < 15.0:
        world.step(0.1)
        nearest = min(nearest, float(np.linalg.norm(walker.position[:2] - [5.0, 3.0])))
    assert walker.status == "arrived" and RADIUS + walker.radius - 0.05 < nearest < 1.0


def test_it_is_drawn(toy, floor, tmp_path):
    world = World(floor)
    world.spawn("toy", (2.0, 3.0, 0.0), name="puck").go_to((4.0, 3.0, 0.0))
    recorder = Recorder(world)
    for _ in range(5):
        recorder.sample()
        world.step(0.1)
    recorder.trace({}).write(tmp_path / "trace.npz")
    trace = Trace.read(tmp_path / "trace.npz")
    (agent,) = trace.agents
    assert agent.figure.bodies == ("disc",) and agent.poses[-1, 0, 0] > 2.5
    write_page(trace, tmp_path / "run.html")
    assert "puck" in (tmp_path / "run.html").read_text()


def test_a_mission_uses_it(toy, tmp_path):
    (tmp_path / "level.obj").write_text(obj_text())
    (tmp_path / "mission.yaml").write_text(MISSION.replace("body: human", "body: toy"))
    loaded = load_mission(tmp_path / "mission.yaml")
    assert loaded.rules().headroom == 0.5
    result = run_mission(loaded)
    assert result.held and result.trace.agents[0].figure.bodies == ("disc",)
    assert '"toy"' in str(mission_schema()).replace("'", '"')


def test_a_playtest_uses_it(toy, tmp_path):
    (tmp_path / "level.obj").write_text(obj_text())
    outcome = playtest(tmp_path / "level.obj", bots=2, seconds=10.0, seed=1, body="toy")
    assert outcome.report.character["radius"] == RADIUS and outcome.report.character["speed"] == 2.0
    assert outcome.report.coverage[-1][1] > 0.1
    assert not list(outcome.tally.clusters())


def test_clients_of_a_server_can_ask_for_it(toy):
    REQUEST.validate_python({"type": "spawn", "id": 1, "world": "w", "body": "toy", "at": (2.0, 3.0, 0.0)})
    assert "toy" in str(REQUEST.json_schema())


def test_without_its_kind_it_is_unknown(toy, floor, tmp_path):
    before = World(floor)
    unregister(toy)
    try:
        with pytest.raises(RuntimeInputError, match="body 'toy': valid: 'human'"):
            World(floor).spawn("toy", (2.0, 3.0, 0.0))
        with pytest.raises(RuntimeInputError, match="body 'toy': valid: 'human'"):
            before.spawn("toy", (2.0, 3.0, 0.0))
        (tmp_path / "level.obj").write_text(obj_text())
        (tmp_path / "mission.yaml").write_text(MISSION.replace("body: human", "body: toy"))
        with pytest.raises(FileError, match="'cat' or 'horse', not 'toy'"):
            load_mission(tmp_path / "mission.yaml")
        with pytest.raises(RuntimeInputError, match="'toy': valid:"):
            playtest(tmp_path / "level.obj", bots=0, body="toy")
        late = World(floor)
    finally:
        register(toy)
    with pytest.raises(RuntimeInputError, match="registered after this world was made"):
        late.spawn("toy", (2.0, 3.0, 0.0))


def test_only_new_words_are_registered(toy):
    def named(*words):
        kind = DiscKind()
        kind.names = words
        return kind

    for words, says in (
        (("dog",), "'dog' is taken"),
        (("toy",), "'toy' is taken"),
        (("new", "a toy"), "'a toy': expected a word"),
        (("toy.yaml",), "expected a word"),
        ((), "at least one name"),
    ):
        with pytest.raises(RuntimeInputError, match=says):
            register(named(*words))
    for kind in (kind_of("human"), kind_of("my/dog.yaml"), DiscKind()):
        with pytest.raises(RuntimeInputError, match="come with the package or"):
            unregister(kind)
    assert body_kinds()[-1] is toy and kind_of("toy") is toy
