"""Small uses of everything that has kernels, to compile them ahead of time."""

import math
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

import navmesh
import pathsmooth
from locomotion import MOVING, Ground, Human
from locomotion.body_events import GotUp
from locomotion.gaits.policy.skill import load_policy
from locomotion.gaits.run.layout import new_state
from locomotion.preconditions.features import FEATURES, SITE, describe
from locomotion.preconditions.moments import PLAN
from locomotion.preconditions.svm import Machine, odds_into
from locomotion.skills.registry import skill_kinds
from navmesh.areas.areas import checked_costs
from navmesh.areas.cheap_routes import priced_route
from navmesh.areas.pricing import priced_of
from navmesh.graph.open_to_body import doors_of

__all__ = ["FIRST_USES", "one_of_each", "tiny_level"]

_EDGE = 12.0  # [m]
_PUSH = 650.0  # [N] enough to make anybody fall


def tiny_level() -> navmesh.Terrain:
    """A floor of 12 x 4 m, long enough for a run-up, before a platform of 0.4 m; a wall with a door in it."""
    corners: list[tuple[float, float, float]] = []
    faces: list[list[int]] = []

    def quad(*ends: tuple[float, float, float]) -> None:
        faces.extend([len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3)))
        corners.extend(ends)

    def wall(x0: float, x1: float, y0: float, y1: float, z: float) -> None:
        quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))
        around = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        for (ax, ay), (bx, by) in zip(around, around[1:] + around[:1], strict=True):
            quad((ax, ay, 0.0), (bx, by, 0.0), (bx, by, z), (ax, ay, z))

    quad((0.0, 0.0, 0.0), (_EDGE, 0.0, 0.0), (_EDGE, 8.0, 0.0), (0.0, 8.0, 0.0))
    quad((_EDGE, 0.0, 0.4), (18.0, 0.0, 0.4), (18.0, 8.0, 0.4), (_EDGE, 8.0, 0.4))
    quad((_EDGE, 8.0, 0.0), (_EDGE, 0.0, 0.0), (_EDGE, 0.0, 0.4), (_EDGE, 8.0, 0.4))
    wall(0.0, 2.5, 4.0, 4.3, 2.5)
    wall(3.6, _EDGE, 4.0, 4.3, 2.5)
    return navmesh.Terrain.from_arrays(np.array(corners), np.array(faces), name="warm-up level")


def _navigate() -> None:
    from navmesh.graph.packed_surface import pack_surface, unpack_surface
    from runtime.planning.rules import person_walk_rules

    terrain = tiny_level()
    # with room around: an update that reaches most of a level builds it anew
    graph = navmesh.NodeGraph.build(terrain, person_walk_rules(), extent=[(-40, -40, 0), (60, 60, 0)])
    surface = graph.surface
    unpack_surface(pack_surface(surface), surface.resolution, surface.shape)  # as `save` and `load` do
    places = graph.random_points(np.random.default_rng(0), 4, radius=0.3)
    graph.find_path(places[0], places[1], radius=0.3)
    graph.find_paths(places[:2], places[2:], radius=0.3)
    search = graph.begin_path(places[0], places[1], radius=0.3)
    while not search.advance(8):
        pass
    search.finish()
    for ask in (graph.project, graph.clearance_at, graph.nearest_edge, graph.nearest_node):
        ask(places)
    graph.containing_node(places)
    graph.cast_ray(places[:2], places[2:], 0.3)
    graph.reachable_nodes(places[0], 0.3)
    graph.room_to_turn(places, 1.0)
    zoned = graph.with_zones({name: [(x, 1, 0), (x, 2, 0)] for name, x in (("door", 2.0), ("wing", 2.5))})
    zoned.block("door")
    zoned.find_path(places[0], places[1], radius=0.3)
    zoned.without_zones()
    crate = [[4.0, 6.0, 0.5], [5.0, 6.0, 0.5], [5.0, 7.0, 0.5], [4.0, 7.0, 0.5]]
    graph.update({"crate": navmesh.Terrain.from_arrays(np.array(crate), np.array([[0, 1, 2], [0, 2, 3]]))})


def _change_a_little() -> None:
    """An update that reaches only some of a level: one of several islands."""
    from runtime.planning.rules import person_walk_rules

    def floor(x0: float, x1: float, y0: float, y1: float, z: float) -> navmesh.Terrain:
        corners = [[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]
        return navmesh.Terrain.from_arrays(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]))

    islands = {f"island{k}": floor(12.0 * k, 12.0 * k + 8.0, 0.0, 5.0, 0.0) for k in range(12)}
    graph = navmesh.NodeGraph.build(navmesh.join_chunks(islands), person_walk_rules())
    start, goal = (1.0, 2.5, 0.0), (7.0, 2.5, 0.0)
    graph.find_path(start, goal, radius=0.3)
    graph = graph.update({"crate": floor(3.5, 4.5, 2.0, 3.0, 0.7)})
    graph.find_path(start, goal, radius=0.3)


def _walk_through_an_open_world() -> None:
    with tempfile.TemporaryDirectory() as folder:
        kept = Path(folder) / "level.world"
        navmesh.bake_open_world(tiny_level(), kept, side=10.0)
        world = navmesh.OpenWorld(kept, radius=5.0)
        world.keep_around((1.0, 1.0, 0.0))
        world.route((1.0, 1.0, 0.0), (11.0, 6.0, 0.0), 0.3)


def _find_by_costs() -> None:
    bare = tiny_level()
    in_mud = bare.vertices[bare.faces].mean(axis=1)[:, 1] > 4.0
    painted = navmesh.Terrain.from_arrays(
        bare.vertices, bare.faces, materials=np.where(in_mud, "mud", "grass"), name=bare.name
    )
    graph = navmesh.NodeGraph.build(painted)
    start, goal = (1.0, 1.0, 0.0), (1.0, 7.0, 0.0)
    for cost in (3.0, np.inf):
        graph.find_path(start, goal, costs={"mud": cost})
    search = graph.begin_path(start, goal, costs={"mud": 3.0})
    while not search.advance(8):
        pass
    search.finish()
    doors = doors_of(graph, 0.3, None, None)
    priced = priced_of(graph, doors, checked_costs(graph, {"mud": 3.0}))
    priced_route(graph, graph.find_path(start, goal), priced)


def _smooth() -> None:
    corner = np.array([[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 6.0, 0.0]])
    begun = pathsmooth.solve(pathsmooth.Problem.from_corridor(corner, corner, np.full(3, 4.0)))
    for room, bound in ((3.9, None), (4.0, 0.8)):
        like = pathsmooth.Problem.from_corridor(corner, corner, np.full(3, room), max_curvature=bound)
        pathsmooth.solve(like, warm=begun)
    ahead = np.array([1.0, 0.0])
    centers = np.outer(np.arange(4.0) * 4.2, [1.0, 0.0, 0.0])
    back = pathsmooth.Problem.from_corridor(
        centers[[0, -1]], centers, np.full(4, 3.5), 0.25, -ahead, ahead, max_curvature=1.0
    )
    pathsmooth.solve(back)  # turns round, on a searched path


def _run_and_jump() -> None:
    from runtime.world.world import World

    world = World(tiny_level())
    agent = world.spawn("human", (1.5, 2.0, 0.0))
    agent.go_to((16.5, 2.0, 0.4), speed=3.0)
    while agent.moving and world.time < 15.0:
        world.step(0.1)


def _brake() -> None:
    human = Human(None, clearing=(), rehearsals=0)
    human.reset((0.0, 0.0, 0.0), 0.0, 3.0)
    human.brake(1.0)
    human.tick()


def _clear() -> None:
    from runtime.evaluation.courses import make_course, run_course

    obstacles = [(kind.affordance, kind.usual, 0.3) for kind in skill_kinds()]
    run_course(make_course(obstacles, [13.0] * len(obstacles)))


def _ask_for_odds() -> None:
    features = np.zeros((1, len(FEATURES)))
    describe(new_state(), np.zeros(len(PLAN)), 0.0, 0.0, 0.0, np.zeros(len(SITE)), features[0])
    zero, one = np.zeros(1), np.ones(1)
    machine = Machine(np.zeros(1, np.int32), zero, one, zero, one, np.zeros((1, 1)), one, np.zeros(4))
    odds_into(*machine, features, np.empty(1))


def _fall_and_get_up() -> None:
    for slope in (0.0, 0.9):
        half, rise = 30.0, 30.0 * slope
        corners = [[-half, -half, -rise], [half, -half, rise], [half, half, rise], [-half, half, -rise]]
        ground = Ground.from_arrays(corners, [[0, 1, 2], [0, 2, 3]], max_slope=math.atan(slope))
        human = Human(ground, clearing=(), gets_up=True)
        human.reset((0.0, 0.0, 0.0), 0.0)
        human.follow(np.array([[x, 0.0, slope * x] for x in np.arange(0.0, 12.0, 0.5)]), 1.0)
        for tick in range(1500):
            pushed = 50 <= tick < 75
            human.data.xfrc_applied[human.index.chest, :2] = (0.0, _PUSH) if pushed else (0.0, 0.0)
            human.tick()
            up = any(isinstance(event, GotUp) for event in human.events)
            if human.status not in MOVING or (up and tick > 800):
                break


def _animals() -> None:
    from runtime.world.world import World

    world = World(tiny_level())
    world.spawn("dog", (1.5, 1.0, 0.0)).go_to((7.5, 3.0, 0.0), speed=1.5)
    world.spawn("dog", (8.0, 1.5, 0.0)).go_to((1.5, 2.5, 0.0), speed=1.5)
    world.spawn("dog", (11.2, 4.8, 0.0), facing=-1.0).go_to((8.0, 6.0, 0.0), speed=1.0)  # in a corner
    world.spawn("human", (5.0, 3.0, 0.0)).go_to((1.5, 2.0, 0.0), speed=1.2)
    world.step(1.0)
    saved = world.save()
    for agent in world.agents.values():
        agent.stop()
    world.step(0.5)
    world.restore(saved)
    world.step(7.0)


def _crowds() -> None:
    from runtime.world.world import World

    world = World(tiny_level())
    world.spawn("human", (5.0, 3.0, 0.0)).go_to((1.5, 2.0, 0.0), speed=1.2)
    for k in range(6):
        walker = world.spawn("walker", (1.0 + 0.8 * k, 1.0, 0.0), radius=0.25)
        walker.go_to((3.0, 6.5, 0.0), speed=1.5)
    recorded = world.spawn("human", (7.0, 1.0, 0.0), detail="low")
    recorded.go_to((7.0, 5.0, 0.0), speed=1.5)
    world.step(1.0)
    for detail in ("full", "physics", "low"):
        recorded.detail = detail
        world.step(1.0)
    world.step(5.0)
    recorded.take_posture("kneel")
    world.step(0.5)
    world.transforms()


def one_of_each(seconds: float = 1.0) -> None:
    """Let a body of each kind that is registered set out."""
    from runtime.bodies.registry import body_kinds
    from runtime.world.world import World

    world, kinds = World(tiny_level()), [kind for kind in body_kinds() if kind.spawned]
    for y, kind in zip(np.linspace(1.0, 3.0, len(kinds)), kinds, strict=True):
        world.spawn(kind.names[0], (1.5, y, 0.0)).go_to((4.5, y, 0.0), speed=1.0)
    world.step(seconds)


def _playtest() -> None:
    from runtime.playtest import playtest

    terrain = tiny_level()
    with tempfile.TemporaryDirectory() as folder:
        level = Path(folder) / "level.obj"
        lines = [f"v {x} {y} {z}" for x, y, z in terrain.vertices]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in terrain.faces]
        level.write_text("\n".join(lines), encoding="utf-8")
        playtest(level, bots=6, seconds=20.0)


def _draw() -> None:
    from runtime.bodies.figure import Shapes
    from runtime.views.render import Camera, Triangles, render

    terrain = tiny_level()
    place, size = np.array([[6.0, 4.0, 0.0, 1.0, 0.0, 0.0, 0.0]]), np.full((1, 3), 0.5)
    ball = Shapes(place, size, np.array([True]), np.ones((1, 3)))
    camera = Camera(np.array([0.0, 0.0, 8.0]), np.array([6.0, 4.0, 0.0]))
    render(Triangles(terrain.vertices, terrain.faces), [ball], camera, (8, 6))


def _walk_as_learned() -> None:
    from locomotion.training.policies.trial import PolicyTrial
    from runtime.world.world import World

    PolicyTrial(load_policy()).tick()
    world = World(tiny_level(), walk="learned")
    world.spawn("human", (1.5, 2.0, 0.0)).go_to((9.0, 2.0, 0.0), speed=1.3)
    world.step(3.0)


def _play_recorded() -> None:
    from locomotion.postures.step_order import gaits_for
    from locomotion.recorded.foot_planting import planted
    from locomotion.recorded.motion_set import load_motions
    from locomotion.recorded.posing import posed
    from locomotion.recorded.sampling import sample_clips, sample_gait
    from locomotion.recorded.skeletons import FULL, skeleton
    from locomotion.recorded_people.drawing import drawn
    from locomotion.recorded_people.people import RecordedPeople

    motions, zero = load_motions(), np.zeros(1)
    frame = sample_clips(motions, FULL, [0], zero)
    posed(skeleton("full"), *frame)
    drawn("full", *frame)
    walk, place = motions.gait("walk"), np.zeros(4)
    sample, footfalls = sample_gait(motions, FULL, [walk], zero, zero), np.zeros((1, 2, 2, 6))
    planted(motions, FULL, ([walk], zero, zero), sample, [place], footfalls)
    terrain = tiny_level()
    ground = Ground.from_arrays(terrain.vertices, terrain.faces)
    people = RecordedPeople(navmesh.NodeGraph.build(terrain), ground=ground)
    people.add(terrain.vertices.mean(axis=0), 0.0, FULL, np.random.default_rng(0))
    people.tick()
    one = np.zeros(1, np.int64)
    people.transforms(one)
    people.due(one, 0.0, 1.0)
    none = np.full(1, -1, np.int32)
    gaits_for((), none, none, zero)


def _show_a_character() -> None:
    from locomotion import Rig
    from locomotion.characters.bone_names import bones_of_parts
    from locomotion.characters.own_person import person_skeleton

    skeleton, level = person_skeleton(), tiny_level()
    rig = Rig(skeleton, bones_of_parts(skeleton, "surefoot"))
    ground = Ground.from_arrays(level.vertices, level.faces)
    rig.local(rig.pose_motion(rig.rest[None], [0.0], rig.names, ground))


FIRST_USES: dict[str, Callable[[], None]] = {
    "navigation": _navigate,
    "walking and getting up": _fall_and_get_up,
    "smoothing": _smooth,
    "characters": _show_a_character,
    "skills": _clear,
    "braking": _brake,
    "area costs": _find_by_costs,
    "animals": _animals,
    "crowds": _crowds,
    "updates": _change_a_little,
    "open worlds": _walk_through_an_open_world,
    "playtests": _playtest,
    "learned walk": _walk_as_learned,
    "running and jumping": _run_and_jump,
    "recorded motion": _play_recorded,
    "pictures": _draw,
    "odds": _ask_for_odds,
    "bodies": one_of_each,
}
"""Label and function of each use, the longest first. None before "area costs" needs what the one before it
does: processes that compile the same wait for each other."""
