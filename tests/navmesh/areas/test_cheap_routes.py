"""Routes with costs by area: cheap by a reference, walkable, the same however asked for; and where areas come
from."""

import math

import numpy as np
import pytest

from benchmarks.area_costs import COSTS, RADIUS, compare, patchwork
from navmesh import NavmeshError, NodeGraph, Terrain, WalkRules, chunks_of, join_chunks, split_terrain
from tests.navmesh.areas.painted import FIELD_ERROR, built, painted, same, strips
from tests.navmesh.meshfiles.gltf_files import Gltf
from tests.navmesh.shapes import plane


@pytest.mark.parametrize("seed", [31, 32, 33])
def test_routes_are_as_cheap_as_those_over_a_fine_grid(seed: int) -> None:
    ratio, back, plain = np.array(compare(seed, 6)).T[:3]
    assert ratio.mean() < 1.03 and ratio.max() < 1.1
    assert np.maximum(ratio / back, back / ratio).max() < 1.1
    assert plain.mean() > ratio.mean()


def test_every_point_has_the_clearance(scene) -> None:
    made, graph, starts, goals = scene
    for route in graph.find_paths(starts, goals, RADIUS, costs=COSTS):
        assert route.status == "complete"
        assert made.gap_at(route.on_surface(0.02)[:, :2]).min() >= RADIUS - FIELD_ERROR
        assert route.holds(graph)
        assert route.length == pytest.approx(np.linalg.norm(np.diff(route.waypoints, axis=0), axis=1).sum())


def test_a_batch_is_what_single_questions_give(scene) -> None:
    made, graph, starts, goals = scene
    again = built(made.terrain)
    routes = graph.find_paths(starts, goals, RADIUS, costs=COSTS)
    threaded = again.find_paths(starts, goals, RADIUS, costs=COSTS, workers=3)
    for k, (start, goal) in enumerate(zip(starts, goals, strict=True)):
        single = graph.find_path(start, goal, RADIUS, costs=COSTS)
        assert same(routes[k], single) and same(threaded[k], single)
    assert len(graph.find_paths(np.empty((0, 3)), np.empty((0, 3)), costs=COSTS)) == 0


def test_costs_of_one_change_nothing(scene) -> None:
    _, graph, starts, goals = scene
    for start, goal in zip(starts, goals, strict=True):
        plain = graph.find_path(start, goal, RADIUS)
        assert same(plain, graph.find_path(start, goal, RADIUS, costs={}))
        assert same(plain, graph.find_path(start, goal, RADIUS, costs={"mud": 1.0}))


def test_one_cost_everywhere_gives_short_routes(scene) -> None:
    _, graph, starts, goals = scene
    everywhere = {name: 3.0 for name in graph.areas}
    for start, goal in zip(starts, goals, strict=True):
        plain = graph.find_path(start, goal, RADIUS)
        assert graph.find_path(start, goal, RADIUS, costs=everywhere).length <= 1.03 * plain.length


def test_mud_is_gone_round_or_through_by_its_cost() -> None:
    level = painted((plane(0, 20, 0, 4), "mud"), (plane(0, 20, 4, 8), "grass"))
    graph = built(level)
    assert graph.areas == ("grass", "mud")
    start, goal = (1.0, 3.0, 0.0), (19.0, 3.0, 0.0)
    dear = graph.find_path(start, goal, costs={"mud": 3.0})
    assert dear.status == "complete" and dear.waypoints[:, 1].max() > 4.0
    points = dear.on_surface(0.01)[:, :2]
    assert (points[:, 1] < 4.0).mean() < 0.15
    cheap = graph.find_path(start, goal, costs={"mud": 1.001})
    assert cheap.length < 18.01
    assert same(cheap, graph.find_path(start, goal, costs={"mud": 1.001, "grass": 1.0}))


def test_an_upper_storey_does_not_count_below() -> None:
    level = painted((plane(0, 12, 0, 12), "grass"), (plane(2, 10, 0, 12, 3.0), "mud"))
    graph = built(level)
    below = graph.find_path((1, 6, 0), (11, 6, 0), costs={"mud": 5.0})
    assert below.length == pytest.approx(10.0, abs=1e-6)


def test_of_coincident_faces_the_upper_counts() -> None:
    level = painted((plane(0, 12, 0, 12), "grass"), (plane(4, 8, 0, 9, 0.005), "mud"))
    route = built(level).find_path((1, 2, 0), (11, 2, 0), costs={"mud": 20.0})
    assert route.status == "complete" and route.waypoints[:, 1].max() > 9.0


def test_skills_are_offered_with_costs() -> None:
    level = painted((plane(0, 5, 0, 8), "grass"), (plane(6, 12, 0, 8), "mud"), (plane(6, 12, 8, 9), "grass"))
    graph = NodeGraph.build(level)
    skills = {"gap": (0.3, 3.0)}
    start, goal = (1.0, 4.0, 0.0), (11.0, 4.0, 0.0)
    assert graph.find_path(start, goal, costs={"mud": 2.0}).status == "partial"
    plain = graph.find_path(start, goal, skills=skills)
    route = graph.find_path(start, goal, skills=skills, costs={"mud": 2.0})
    assert plain.status == route.status == "complete" and len(route.links) == len(plain.links) == 1
    use = route.links[0]
    np.testing.assert_allclose(route.waypoints[use.first], graph.links.start[use.link], atol=1e-9)
    np.testing.assert_allclose(route.waypoints[use.last], graph.links.end[use.link], atol=1e-9)
    dearer = np.zeros(len(graph.links))
    dearer[use.link] = np.inf
    closed = graph.find_path(start, goal, skills=skills, costs={"mud": 2.0}, link_costs=dearer)
    assert not any(other.link == use.link for other in closed.links)
    dearer[:] = 5.0
    dear = graph.find_path(start, goal, skills=skills, costs={"mud": 2.0}, link_costs=dearer)
    assert dear.cost == pytest.approx(route.cost + 5.0)
    assert same(graph.find_paths([start], [goal], skills=skills, costs={"mud": 2.0})[0], route)


def test_ends_without_a_place_are_off_the_graph() -> None:
    graph = built(strips("grass", "mud"))
    route = graph.find_path((2.0, 6.0, 0.0), (99.0, 0.0, 0.0), costs={"mud": 2.0})
    assert route.status == "off_graph" and not len(route.waypoints)


@pytest.mark.parametrize(
    ("costs", "words"),
    [
        ({"lava": 3.0}, "there is no area 'lava'; there are grass, mud"),
        ({"mud": 0.5}, "area 'mud': expected a cost of at least 1, not 0.5"),
        ({"mud": math.nan}, "area 'mud': expected a cost of at least 1, not nan"),
        ({"mud": 1e7}, "at most 1e\\+06, or math.inf"),
        ({"mud": True}, "area 'mud': expected a cost"),
        ({"mud": "dear"}, "area 'mud': expected a cost"),
        (["mud"], "costs: expected costs by area"),
    ],
)
def test_wrong_costs_are_refused(costs, words: str) -> None:
    graph = built(strips("grass", "mud"))
    a, b = (1.0, 1.0, 0.0), (5.0, 5.0, 0.0)
    with pytest.raises(NavmeshError, match=words):
        graph.find_path(a, b, costs=costs)
    with pytest.raises(NavmeshError, match=words):
        graph.find_paths([a], [b], costs=costs)
    with pytest.raises(NavmeshError, match="one of them, not both"):
        graph.find_path(a, b, costs={"mud": 2.0}, node_costs=np.ones(len(graph)))


def test_a_level_without_materials_has_one_area() -> None:
    graph = built(Terrain.from_arrays(*plane(0, 6, 0, 6)))
    assert graph.areas == ("default",) and not len(graph.terrain.face_material)
    route = graph.find_path((1, 1, 0), (5, 5, 0), costs={"default": 2.0})
    assert route.length == pytest.approx(math.dist((1, 1), (5, 5)), rel=1e-6)


def test_materials_are_names_one_for_each_triangle() -> None:
    vertices, faces = plane(0, 6, 0, 6)
    for materials in (["mud"], [1, 2], "mud", [["mud", "mud"]]):
        with pytest.raises(NavmeshError, match="expected a name for each of the 2 triangles"):
            Terrain.from_arrays(vertices, faces, materials=materials)
    plain = Terrain.from_arrays(vertices, faces)
    assert Terrain.from_arrays(vertices, faces, materials=["", "default"]).digest == plain.digest
    muddy = Terrain.from_arrays(vertices, faces, materials=["mud", ""])
    assert muddy.materials == ("default", "mud") and muddy.digest != plain.digest
    assert muddy.material_of_faces.tolist() == ["mud", "default"]


def test_a_loaded_graph_has_its_areas(tmp_path) -> None:
    graph = built(strips("grass", "mud", "grass"))
    graph.save(tmp_path / "level.nav")
    back = NodeGraph.load(tmp_path / "level.nav", graph.terrain, WalkRules())
    assert back.areas == graph.areas == ("grass", "mud")
    a, b = (1.0, 1.0, 0.0), (11.0, 10.0, 0.0)
    assert same(graph.find_path(a, b, costs={"mud": 4.0}), back.find_path(a, b, costs={"mud": 4.0}))
    with pytest.raises(NavmeshError, match="another terrain"):
        NodeGraph.load(tmp_path / "level.nav", strips("grass", "rock", "grass"))


def test_chunks_keep_their_materials() -> None:
    level = patchwork(5).terrain
    parts = split_terrain(level, 4.0)
    whole = join_chunks(parts)
    assert whole.materials == level.materials
    assert sorted(whole.material_of_faces) == sorted(level.material_of_faces)
    for name, part in chunks_of(whole).items():
        assert part.digest == parts[name].digest
    mixed = join_chunks({"a": strips("mud"), "b": Terrain.from_arrays(*plane(4, 8, 0, 12))})
    assert mixed.materials == ("default", "mud")


def test_an_update_equals_a_build() -> None:
    parts = {
        "a": strips("grass"),
        "b": painted((plane(4, 8, 0, 12), "mud")),
        "c": Terrain.from_arrays(*plane(8, 12, 0, 12)),
    }
    graph = built(join_chunks(parts))
    a, b = (1.0, 6.0, 0.0), (11.0, 6.0, 0.0)
    steps = (
        {"b": painted((plane(4, 8, 0, 10), "mud"), (plane(4, 8, 10, 12), "grass"))},
        {"b": painted((plane(4, 8, 0, 2), "grass"), (plane(4, 8, 2, 12), "swamp"))},
        {"a": Terrain.from_arrays(*plane(0, 4, 0, 12)), "c": painted((plane(8, 12, 0, 12), "rock"))},
        {"c": None},
    )
    for changes in steps:
        parts |= changes
        graph = graph.update(changes)
        again = built(join_chunks({name: part for name, part in parts.items() if part is not None}))
        assert graph.areas == again.areas and graph.terrain.digest == again.terrain.digest
        costs = {name: 4.0 for name in graph.areas if name in ("mud", "swamp")}
        assert same(graph.find_path(a, b, costs=costs), again.find_path(a, b, costs=costs))
    assert graph.update({"b": chunks_of(graph.terrain)["b"]}) is graph


OBJ = """v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 8 0 0\nv 8 4 0\nv 6 1 0
{first}f 1 2 3 4
usemtl  wet mud
f 2 5 7 6 3
usemtl grass
usemtl rock
f 1 2 3
"""


def test_the_materials_of_an_obj_file(tmp_path) -> None:
    file = tmp_path / "level.obj"
    file.write_text(OBJ.format(first=""))
    level = Terrain.load(file)
    assert level.material_of_faces.tolist() == ["default"] * 2 + ["wet mud"] * 3 + ["rock"]
    file.write_text(OBJ.format(first="usemtl grass\n"))
    assert Terrain.load(file).materials == ("grass", "rock", "wet mud")


def test_the_materials_of_a_gltf_file(tmp_path) -> None:
    square = np.array([[0, 0, 0], [4, 0, 0], [4, 0, -4], [0, 0, -4]], np.float32)
    file = Gltf(materials=[{"name": "mud"}, {}])
    file.node(mesh=file.mesh(square, [0, 1, 2, 0, 2, 3], material=0))
    file.node(mesh=file.mesh(square, [0, 1, 2], material=1), translation=[4, 0, 0])
    file.node(mesh=file.mesh(square, [0, 1, 2]), translation=[8, 0, 0])
    file.json["scenes"] = [{"nodes": [0, 1, 2]}]
    path = tmp_path / "level.glb"
    path.write_bytes(file.glb())
    assert Terrain.load(path).material_of_faces.tolist() == ["mud", "mud", "default", "default"]
    file.json["meshes"][0]["primitives"][0]["material"] = 7
    path.write_bytes(file.glb())
    with pytest.raises(NavmeshError, match="materials"):
        Terrain.load(path)


def test_a_bridge_leads_over_water() -> None:
    bridge = painted(
        (plane(0, 4, 0, 12), "grass"), (plane(4, 8, 0, 5), "water"), (plane(4, 8, 5, 7), "planks"),
        (plane(4, 8, 7, 12), "water"), (plane(8, 12, 0, 12), "grass"),
    )  # fmt: skip
    route = built(bridge).find_path((1, 1, 0), (11, 1, 0), costs={"water": math.inf, "planks": 2.0})
    assert route.status == "complete"
    on = route.on_surface(0.01)
    over = on[(on[:, 0] > 4.0) & (on[:, 0] < 8.0), 1]
    assert len(over) and 5.0 <= over.min() and over.max() <= 7.0
