"""A good file of every kind that Surefoot reads, with functions to read and use it, for
`benchmarks.file_fuzz`."""

import dataclasses
import hashlib
import json
import shutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import navmesh
from examples.make_characters import STOUT, write_character
from locomotion import Rig
from locomotion.characters.bone_names import load_bone_names
from locomotion.clips.clip import load_clip
from locomotion.clips.motion import load_motion, motion_of_clip
from locomotion.clips.motion_check import check_motion
from locomotion.clips.retargeting import load_mapping
from locomotion.data import CHARACTERS
from locomotion.gaits.brake import load_brake_skill
from locomotion.gaits.run.skill import RUN_CLIP, load_run_skill
from locomotion.gaits.slow_down import load_slow_down_skill
from locomotion.gaits.speed_up import load_speed_up_skill
from locomotion.gaits.walk.skill import load_walk_skill
from locomotion.quadruped import load_body
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.sampling import sample_clips
from locomotion.skills.description import load_description
from locomotion.skills.drop_roll.skill import load_drop_roll_skill
from locomotion.skills.jump.skill import Jump, load_jump_skill
from locomotion.skills.leap.kind import LEAP_DESCRIPTION
from locomotion.skills.vault.skill import load_vault_skill
from locomotion.training.search.checkpoint import claim
from locomotion.training.search.cma_es import CmaEs
from locomotion.training.search.loop import Stage, read_search, write_search
from navmesh.streaming.world_folder import INDEX, WorldIndex, read_chunk, read_index, write_world
from runtime import World, WorldState
from runtime.bodies.pose import Pose
from runtime.missions.mission import load_mission
from runtime.playtest.fault import Fault, Sighting
from runtime.playtest.observation import Crossing, Journey
from runtime.playtest.plan import LoadedPlan
from runtime.playtest.report import Report, Setup, read_report, write_report
from runtime.traces.recording import Recorder
from runtime.traces.trace import Trace

__all__ = ["KINDS", "Kind", "content", "level"]

_HERE = Path(__file__).parent.parent
_TAGS = """\
version: 1
add:
  - {name: bar, affordance: vault, position: [6.0, 2.0, 0.8], run_towards_deg: 0, height: 0.8, depth: 0.2,
     width: 1.0}
change:
  - {at: [4.0, 4.0, 0.4], within: 0.3, set: {name: block, width: 0.9}}
remove:
  - tag: jump@5.0,4.0,0.4/180
"""
_PLAN = """\
character: {radius: 0.3, height: 1.8, speed: 3.0, skills: {jump: [0.1, 0.5]}}
spawns: [{name: west, at: [1, 1, 0]}]
places: [{name: east, at: [7, 7, 0]}]
routes: [{from: west, to: east, at_most: 20}]
"""


def level() -> navmesh.Terrain:
    """A floor of 8 m with a block of 0.4 m on it."""
    floor = [[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0]]
    block = [[4, 3, 0], [5, 3, 0], [5, 5, 0], [4, 5, 0], [4, 3, 0.4], [5, 3, 0.4], [5, 5, 0.4], [4, 5, 0.4]]
    sides = [[4, 5, 6], [4, 6, 7]]
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        sides += [[a, b, b + 4], [a, b + 4, a + 4]]
    faces = np.array([[0, 1, 2], [0, 2, 3], *(np.array(sides) + 4)])
    return navmesh.Terrain.from_arrays(np.array(floor + block, float), faces, name="fuzz")


@dataclass(frozen=True)
class Kind:
    """``make`` writes a good file; ``read`` reads it, ``use`` goes on with what was read."""

    ending: str
    make: Callable[[Path], None]
    read: Callable[[Path], Any]
    use: Callable[[Any], Any] = lambda read: None


def content(value: Any) -> str:
    """Digest of everything in ``value``: equal for what is equally good."""
    hasher = hashlib.sha256()

    def add(value: Any) -> None:
        if isinstance(value, np.ndarray):
            hasher.update(repr((value.dtype.str, value.shape)).encode())
            hasher.update(np.ascontiguousarray(value).tobytes())
        elif dataclasses.is_dataclass(value) and not isinstance(value, type):
            for field in dataclasses.fields(value):
                if field.repr and field.name not in ("located", "meta"):
                    add(getattr(value, field.name))
        elif isinstance(value, Mapping):
            for key, each in value.items():
                hasher.update(str(key).encode("utf-8", "surrogatepass"))
                add(each)
        elif isinstance(value, list | tuple):
            hasher.update(f"{len(value)}".encode())
            for each in value:
                add(each)
        elif hasattr(value, "model_dump"):
            add(value.model_dump())
        else:
            hasher.update(repr(value).encode("utf-8", "surrogatepass"))

    add(value)
    return hasher.hexdigest()


# --- graphs
def _make_graph(path: Path) -> None:
    navmesh.NodeGraph.build(level()).save(path)


def _use_graph(graph: navmesh.NodeGraph) -> None:
    skills = {"jump": (0.1, 0.7), "drop": (0.1, 2.0), "vault": (0.6, 1.0), "gap": (0.4, 2.0)}
    rng = np.random.default_rng(1)
    for radius in (0.1, 0.3, 0.45):
        graph.find_path((1.0, 4.0, 0.0), (7.0, 4.0, 0.0), radius)
        graph.find_path((1.0, 1.0, 0.0), (4.5, 4.0, 0.4), radius, skills)
        starts, goals = rng.uniform(0, 8, (2, 20, 3)) * [1, 1, 0]
        graph.find_paths(starts, goals, radius)
    points = rng.uniform(-1, 9, (50, 3))
    graph.nearest_edge(points), graph.nearest_node(points), graph.containing_node(points)
    graph.cast_ray(points, points[::-1], 0.2), graph.room_to_turn(points, 1.0)
    graph.random_points(rng, 10), graph.reachable_nodes((1.0, 1.0, 0.0))


# --- open worlds
def _make_world(path: Path) -> None:
    with TemporaryDirectory() as place:
        folder = navmesh.bake_open_world(level(), Path(place) / "world", (0.2, 0.4), 10.0)
        shutil.copy(folder / INDEX, path)


def _read_world(path: Path) -> WorldIndex:
    with TemporaryDirectory() as folder:
        shutil.copy(path, Path(folder) / INDEX)
        return read_index(folder)


def _use_world(index: WorldIndex) -> None:
    skills = {"jump": (0.1, 0.7), "drop": (0.1, 2.0)}
    rng = np.random.default_rng(1)
    with TemporaryDirectory() as folder:
        write_world(Path(folder), index, dict.fromkeys(index.names, level()))
        world = navmesh.OpenWorld(folder)
        for start, goal in rng.uniform(0, 8, (20, 2, 3)):
            world.route(start, goal, world.radii[0], skills)


def _make_chunk(path: Path) -> None:
    with TemporaryDirectory() as place:
        folder = navmesh.bake_open_world({"level": level()}, Path(place) / "world")
        shutil.copy(folder / "chunk-00000.npz", path)


def _read_chunk(path: Path) -> navmesh.Terrain:
    with TemporaryDirectory() as place:
        folder = navmesh.bake_open_world({"level": level()}, Path(place) / "world")
        shutil.copy(path, folder / "chunk-00000.npz")
        return read_chunk(folder, read_index(folder), 0)


# --- states of worlds
_graph: list[navmesh.NodeGraph] = []


def _world() -> World:
    if not _graph:
        _graph.append(navmesh.NodeGraph.build(level(), World(level()).graph.rules))
    return World(_graph[0], seed=1)


def _make_state(path: Path) -> None:
    world = _world()
    for body, y in (("human", 1.5), ("dog", 6.5), ("walker", 7.3), ("walker", 0.7)):
        world.spawn(body, at=(1.5, y, 0)).go_to((7, y, 0), speed=1.5)
    world.spawn("human", at=(1, 4, 0), name="jumper").go_to((7.2, 4.0, 0.0), speed=3.0)
    world.step(1.5)
    world.save().write(path)


def _use_state(state: WorldState) -> None:
    world = _world()
    world.restore(state)
    world.step(0.15)
    for agent in world.agents.values():
        repr((agent.pose, agent.status, agent.progress, agent.position, agent.facing))
    world.save()


# --- traces
def _make_trace(path: Path) -> None:
    world = _world()
    world.spawn("human", at=(1, 4, 0), name="ada").go_to((7.2, 4.0, 0.0), speed=3.0)
    world.spawn("dog", at=(2, 6, 0), name="rex").go_to((6, 6, 0), speed=1.0)
    recorder = Recorder(world)
    for _ in range(12):
        world.step(0.1)
        recorder.sample()
    recorder.trace({"held": True, "expectations": [{"agent": "ada", "held": True}]}).write(path)


def _use_trace(trace: Trace) -> None:
    for agent in trace.agents:
        for pose in agent.poses[:3]:
            agent.figure.posed(pose)
            repr(Pose(agent.figure.bodies, agent.figure.parents, pose.astype(np.float64)).local)


# --- what was learned
def _saved(load: Callable[[], Any]) -> Callable[[Path], None]:
    return lambda path: load().save(path)


def _copy(source: Path) -> Callable[[Path], None]:
    return _written(source.read_text(encoding="utf-8"))


def _use_jump(family: Any) -> None:
    skill = Jump(family, load_run_skill())
    skill.approach(0.3)


def _make_motion(path: Path) -> None:
    motion_of_clip(load_clip(RUN_CLIP)).save(path)


_STAGES = (Stage("one", 3, 0.5, np.array([1.0, 0.0, 2.0])), Stage("two", 2, 0.5, np.ones(3)))


def _make_search(path: Path) -> None:
    search = CmaEs(np.zeros(2), 0.5, np.array([1.0, 2.0]))
    search.tell(search.ask(np.random.default_rng(0)), np.arange(32.0))
    write_search(path, "fuzz", 0, np.zeros(3), search)


def _read_search(path: Path) -> Any:
    stage, parameters, search = read_search(path, "fuzz", _STAGES, np.zeros(3))
    return stage, parameters, search.arrays()


# --- text
def _written(text: str) -> Callable[[Path], None]:
    return lambda path: path.write_text(text, encoding="utf-8")


def _make_mission(path: Path) -> None:
    text = (_HERE / "examples/missions/guard.yaml").read_text(encoding="utf-8")
    path.write_text(text.replace("../levels/courtyard.obj", "level.obj"), encoding="utf-8")
    (path.parent / "level.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")


def _make_report(path: Path) -> None:
    at = (1.0, 2.0, 0.0)
    report = Report(
        Setup("level.obj", "z", 1.0, None, "human", 4, 10.0, 7), "ab", {"radius": 0.3},
        (Fault("hole", at, "a hole", True, "bots", 1.0, (Sighting(1, 2.0, at),)),),
        (Crossing("jump@1", "jump", 0.4, at, 3, 2),), (Journey("west", "east", 2, 1, 3.0, 4.0),),
        ((1.0, 0.5),), ((*at, 3),), 60.0,
    )  # fmt: skip
    write_report(report, path)


def _claim(path: Path) -> None:
    folder = path.parent / "claimed"
    folder.mkdir(exist_ok=True)
    (folder / "configuration.json").write_bytes(path.read_bytes())
    claim(folder, {"seed": 3, "marks": [1.3, 0.25], "clip": "ab"})


# --- characters
def _make_character(path: Path) -> None:
    write_character(STOUT, path)


def _make_open_character(path: Path) -> None:
    """The same with its JSON as text, beside a file of its numbers: damage changes what is said, too."""
    binary = path.with_suffix(".glb")
    write_character(STOUT, binary)
    content = binary.read_bytes()
    size = int.from_bytes(content[12:16], "little")
    document = json.loads(content[20 : 20 + size])
    document["buffers"][0]["uri"] = "numbers.bin"
    (path.parent / "numbers.bin").write_bytes(content[28 + size :])
    path.write_text(json.dumps(document), encoding="utf-8")


def _read_character(path: Path) -> Any:
    rig = Rig.load(path)
    return rig.names, rig.parts, rig.rest, rig.skeleton.mesh.points, rig


def _use_character(read: Any) -> None:
    rig = read[-1]
    rig.local(rig.pose_from(np.tile([0, 0, 0.9, 1, 0, 0, 0], (20, 1))))


def _read_tags(path: Path) -> Any:
    tags = navmesh.load_tags(path)
    return tags.tags, tags


def _use_tags(read: Any) -> None:
    graph = _world().graph
    read[1].apply(graph.obstacles, graph.surface, graph.rules)


KINDS: dict[str, Kind] = {
    "graph": Kind(".npz", _make_graph, navmesh.NodeGraph.load, _use_graph),
    "world": Kind(".npz", _make_world, _read_world, _use_world),
    "chunk": Kind(".npz", _make_chunk, _read_chunk),
    "state": Kind(".npz", _make_state, WorldState.read, _use_state),
    "trace": Kind(".npz", _make_trace, Trace.read, _use_trace),
    "run": Kind(".npz", _saved(load_run_skill), load_run_skill),
    "walk": Kind(".npz", _saved(load_walk_skill), load_walk_skill),
    "brake": Kind(".npz", _saved(load_brake_skill), load_brake_skill),
    "slow-down": Kind(".npz", _saved(load_slow_down_skill), load_slow_down_skill),
    "speed-up": Kind(".npz", _saved(load_speed_up_skill), load_speed_up_skill),
    "jump": Kind(".npz", _saved(load_jump_skill), load_jump_skill, _use_jump),
    "vault": Kind(".npz", _saved(load_vault_skill), load_vault_skill, lambda family: family.at(0.7)),
    "drop-roll": Kind(
        ".npz", _saved(load_drop_roll_skill), load_drop_roll_skill, lambda family: family.at(1.5)
    ),
    "motion": Kind(".npz", _make_motion, load_motion, check_motion),
    "motion set": Kind(
        ".npz", _saved(load_motions), load_motions, lambda motions: sample_clips(motions, 2, [0], [0.5])
    ),
    "checkpoint": Kind(".npz", _make_search, _read_search),
    "tags": Kind(".yaml", _written(_TAGS), _read_tags, _use_tags),
    "mission": Kind(".yaml", _make_mission, load_mission),
    "playtest": Kind(".yaml", _written(_PLAN), LoadedPlan.read),
    "clip": Kind(".yaml", _copy(RUN_CLIP), load_clip, lambda clip: clip.sample(np.linspace(0, 1, 9))),
    "mapping": Kind(".yaml", _copy(_HERE / "examples/clips/mixamo.yaml"), load_mapping),
    "body": Kind(".yaml", _copy(_HERE / "locomotion/data/bodies/dog.yaml"), load_body),
    "description": Kind(".yaml", _copy(LEAP_DESCRIPTION), load_description),
    "character": Kind(".glb", _make_character, _read_character, _use_character),
    "gltf": Kind(".gltf", _make_open_character, _read_character, _use_character),
    "bone-names": Kind(".yaml", _copy(CHARACTERS / "mixamo.yaml"), load_bone_names),
    "report": Kind(".json", _make_report, read_report),
    "configuration": Kind(
        ".json", _written(json.dumps({"seed": 3, "marks": [1.3, 0.25], "clip": "ab"})), _claim
    ),
}
"""By name; the archives are those that end in .npz."""
