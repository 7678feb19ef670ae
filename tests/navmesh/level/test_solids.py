"""Floor inside of closed solids does not count; see `navmesh.level.solids`."""

import numpy as np
import pytest

from navmesh import NavmeshError, NodeGraph, Terrain, WalkRules, join_chunks, split_terrain
from navmesh.level.raster import SAME_SURFACE
from navmesh.surface.build import build_surface
from navmesh.surface.surface import Surface
from tests.navmesh.graph.test_kept_build import assert_same, rebuilt
from tests.navmesh.shapes import Mesh, box, join, plane, terrain

RULES = WalkRules(max_step=0.3, headroom=1.8)


def hill(size: float, height: float, squares: int = 24) -> Mesh:
    """Ground of waves."""
    at = np.linspace(0.0, size, squares + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    vertices = np.stack([x, y, height * np.sin(x) * np.cos(0.7 * y)], axis=-1).reshape(-1, 3)
    a = (np.arange(squares)[:, None] * (squares + 1) + np.arange(squares)).ravel()
    b, c, d = a + squares + 1, a + squares + 2, a + 1
    return vertices, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def prism(rng: np.random.Generator, middle: np.ndarray, *, upright: bool) -> Mesh:
    """A closed prism with 3 to 8 sides, anyhow turned; faces outwards."""
    sides, radius, half = rng.integers(3, 9), rng.uniform(0.8, 2.5), rng.uniform(1.0, 4.0)
    turn = np.arange(sides) * 2.0 * np.pi / sides + rng.uniform(0.0, 7.0)
    ring = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    vertices = np.concatenate(
        [np.column_stack([ring, np.full(sides, -half)]), np.column_stack([ring, np.full(sides, half)])]
    )
    faces = []
    for k in range(sides):
        j = (k + 1) % sides
        faces += [(k, j, sides + j), (k, sides + j, sides + k)]
    for k in range(1, sides - 1):
        faces += [(0, k + 1, k), (sides, sides + k, sides + k + 1)]
    if not upright:
        rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        vertices = vertices @ (rotation * np.sign(np.linalg.det(rotation)))
    return vertices + middle, np.array(faces)


def with_flap(mesh: Mesh) -> Mesh:
    """``mesh`` (convex) with one face more, inside of it, that ends in the air: no longer closed."""
    vertices, faces = mesh
    flap = [[faces[0, 0], faces[0, 1], len(vertices)]]
    return np.concatenate([vertices, vertices.mean(axis=0)[None]]), np.concatenate([faces, flap])


def without_solids(level: Terrain) -> Terrain:
    """``level`` with no part that counts as closed."""
    level.__dict__["solid"] = np.full(len(level.faces), -1, np.int32)
    return level


def depth(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """How far inside a convex ``mesh`` each of ``points`` (n, 3) is [m]."""
    corner = mesh[0][mesh[1]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return -((points[:, None] - corner[None, :, 0]) * normal).sum(axis=2).max(axis=1)


def cells(surface: Surface) -> list[tuple[int, float]]:
    """Column and height of each."""
    return list(zip(surface.cell_column.tolist(), surface.height.tolist(), strict=True))


def just_above(surface: Surface) -> np.ndarray:
    return surface.centers() + np.array([0.0, 0.0, SAME_SURFACE])


def has_floor(surface: Surface, x: float, y: float, z: float = 0.0) -> bool:
    return bool((np.abs(surface.centers() - [x, y, z]) <= [0.13, 0.13, 0.05]).all(axis=1).any())


def scene(seed: int) -> tuple[Mesh, list[Mesh]]:
    rng = np.random.default_rng(seed)
    ground = hill(16.0, 0.8) if seed % 2 else plane(0.0, 16.0, 0.0, 16.0)
    solids = [
        prism(rng, rng.uniform([2.0, 2.0, -1.0], [14.0, 14.0, 2.0]), upright=bool(k % 2)) for k in range(6)
    ]
    return ground, solids


@pytest.mark.parametrize("seed", range(12))
def test_no_cell_is_inside_and_all_others_stay(seed):
    ground, solids = scene(seed)
    now = build_surface(terrain(ground, *solids), RULES)
    before = build_surface(without_solids(terrain(ground, *solids)), RULES)
    deepest = np.max([depth(solid, just_above(now)) for solid in solids], axis=0)
    assert deepest.max() < 1e-6
    outside = np.max([depth(solid, just_above(before)) for solid in solids], axis=0) < -1e-6
    kept = {cell for cell, out in zip(cells(before), outside, strict=True) if out}
    assert kept <= set(cells(now)) < set(cells(before))
    index = {cell: k for k, cell in enumerate(cells(before))}
    same = [index[cell] for cell in cells(now)]
    np.testing.assert_array_equal(now.clearance, before.clearance[same])


@pytest.mark.parametrize("seed", range(4))
def test_order_and_repeated_vertices_do_not_matter(seed):
    whole = terrain(scene(seed)[0], *scene(seed)[1])
    expected = build_surface(whole, RULES)
    rng = np.random.default_rng(seed)
    faces = rng.permutation(whole.faces)
    turned = np.stack([np.roll(face, k % 3) for k, face in enumerate(faces)])
    for vertices, corners in (
        (whole.vertices, turned),
        (whole.vertices[turned].reshape(-1, 3), np.arange(3 * len(turned)).reshape(-1, 3)),
    ):
        got = build_surface(Terrain.from_arrays(vertices, corners), RULES)
        np.testing.assert_array_equal(got.cell_column, expected.cell_column)
        np.testing.assert_allclose(got.height, expected.height, atol=1e-12)


@pytest.mark.parametrize("far", [1e4, 4e6])
def test_far_from_the_origin(far):
    ground, solids = scene(1)
    near = build_surface(terrain(ground, *solids), RULES)
    vertices, faces = join(ground, *solids)
    shift = np.array([far, -far, 0.25 * far])
    moved = build_surface(Terrain.from_arrays(vertices + shift, faces), RULES)
    np.testing.assert_array_equal(moved.cell_column, near.cell_column)
    np.testing.assert_allclose(moved.centers(), near.centers() + shift, atol=1e-7)


@pytest.mark.parametrize("shift", [0.0, 0.125, 0.06])
def test_a_building_that_stands_on_the_floor(shift):
    """Also where walls and diagonals of its roof pass through the centres of squares."""
    building = box(2.0 + shift, 6.0 + shift, 2.0 + shift, 6.0 + shift, 0.0, 5.0)
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), building), RULES)
    x, y, z = (just_above(surface) - [4.0 + shift, 4.0 + shift, 0.0]).T
    floor = z < 1.0
    assert not (floor & (np.maximum(abs(x), abs(y)) < 2.0 - 1e-9)).any()
    centre = (np.arange(32) + 0.5) * 0.25 - 4.0 - shift
    assert (~floor).sum() == (abs(centre) <= 2.0).sum() ** 2
    assert 32**2 - (abs(centre) < 2.0).sum() ** 2 >= floor.sum() >= 32**2 - (abs(centre) <= 2.0).sum() ** 2


def test_parts_that_are_not_closed_are_no_solids():
    vertices, faces = box(2.0, 6.0, 2.0, 6.0, -1.0, 4.0)
    ground = plane(0.0, 8.0, 0.0, 8.0)
    for left_out in range(len(faces)):
        surface = build_surface(terrain(ground, (vertices, np.delete(faces, left_out, axis=0))), RULES)
        assert has_floor(surface, 4.125, 4.125)
    one_turned = faces.copy()
    one_turned[0] = one_turned[0, ::-1]
    assert has_floor(build_surface(terrain(ground, (vertices, one_turned)), RULES), 4.125, 4.125)


def test_a_face_on_the_outside_that_belongs_to_a_closed_part_twice():
    """Two boxes that share an edge are closed together."""
    pair = join(box(1.0, 4.0, 1.0, 4.0, -1.0, 4.0), box(4.0, 7.0, 4.0, 7.0, -1.0, 4.0))
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), pair), RULES)
    assert not has_floor(surface, 2.125, 2.125) and not has_floor(surface, 5.125, 5.125)
    assert has_floor(surface, 2.125, 5.125)


def test_overlapping_solids():
    pair = join(box(1.0, 5.0, 1.0, 5.0, -1.0, 4.0), box(3.0, 7.0, 3.0, 7.0, -0.5, 8.0))
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), pair), RULES)
    for x in (2.125, 4.125, 6.125):
        assert not has_floor(surface, x, x)
    assert has_floor(surface, 2.125, 2.125, 4.0) and has_floor(surface, 6.125, 6.125, 8.0)
    assert not has_floor(surface, 4.125, 4.125, 4.0)


def inwards(mesh: Mesh) -> Mesh:
    return mesh[0], mesh[1][:, ::-1]


HOUSE = box(1.0, 7.0, 1.0, 7.0, -0.2, 4.0)
ROOM = inwards(box(1.3, 6.7, 1.3, 6.7, 0.0, 3.6))
GROUND = plane(0.0, 8.0, 0.0, 8.0, -0.1)


def test_a_room_in_a_house_is_floor_and_a_pillar_in_it_is_not():
    assert has_floor(build_surface(terrain(GROUND, HOUSE, ROOM), RULES), 4.125, 4.125)
    pillar = box(3.0, 5.0, 3.0, 5.0, -0.1, 3.8)
    surface = build_surface(terrain(GROUND, HOUSE, ROOM, pillar), RULES)
    assert not has_floor(surface, 4.125, 4.125) and has_floor(surface, 2.125, 2.125)
    assert not has_floor(build_surface(terrain(GROUND, HOUSE), RULES), 4.125, 4.125, -0.1)


def test_a_house_with_a_door():
    """One closed part: outside, inside and the frame of the door hang together."""
    outer = [(1, 1), (7, 1), (7, 7), (1, 7), (1, 4.6)]
    inner = [(1.3, 4.6), (1.3, 6.7), (6.7, 6.7), (6.7, 1.3), (1.3, 1.3)]
    outline = [*outer, *inner, (1.3, 3.4), (1, 3.4)]
    n = len(outline)
    bottom, top = -0.2, 3.6
    vertices = np.array([(x, y, z) for z in (bottom, top) for x, y in outline])
    sides = [f for k in range(n) for f in ((k, (k + 1) % n, n + (k + 1) % n), (k, n + (k + 1) % n, n + k))]
    strips = [
        (11, 0, 9, 10),
        (0, 1, 8, 9),
        (1, 2, 7, 8),
        (2, 3, 6, 7),
        (3, 4, 5, 6),
    ]  # between both sides of the walls
    caps = [f for a, b, c, d in strips for f in ((n + a, n + b, n + c), (n + a, n + c, n + d))]
    caps += [(c - n, b - n, a - n) for a, b, c in caps]
    walls = vertices, np.array(sides + caps)
    roof = box(1.0, 7.0, 1.0, 7.0, 3.6, 4.0)
    mesh = terrain(plane(0.0, 8.0, 0.0, 8.0), walls, roof)
    assert (mesh.solid[2:] >= 0).all()
    surface = build_surface(mesh, RULES)
    assert has_floor(surface, 4.125, 4.125) and has_floor(surface, 1.125, 4.125)
    assert not has_floor(surface, 1.125, 2.125)


def test_a_room_turned_inwards_is_no_solid_and_hides_none():
    """Neither in the room, nor on the floor below it; a closed block in the room is solid all the same."""
    room = inwards(box(0.0, 8.0, 0.0, 8.0, 3.0, 9.0))
    block = box(3.0, 5.0, 3.0, 5.0, 2.9, 6.0)
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), room, block), RULES)
    assert has_floor(surface, 4.125, 1.125, 3.0) and has_floor(surface, 4.125, 4.125, 6.0)
    assert has_floor(surface, 4.125, 1.125) and has_floor(surface, 4.125, 4.125)
    assert not has_floor(surface, 4.125, 4.125, 3.0)


def test_floor_under_a_table_and_on_a_solid():
    slab = box(2.0, 6.0, 2.0, 6.0, 2.5, 2.7)
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), slab), RULES)
    assert has_floor(surface, 4.125, 4.125) and has_floor(surface, 4.125, 4.125, 2.7)


@pytest.mark.parametrize("repeated", [[0], [1, 1, 5, 9], list(range(12))])
def test_repeated_faces_do_not_matter(repeated):
    vertices, faces = box(2.0, 6.0, 2.0, 6.0, -1.0, 4.0)
    block = vertices, np.concatenate([np.roll(faces[repeated], 1, axis=1), faces])
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), block), RULES)
    assert not has_floor(surface, 4.125, 4.125) and has_floor(surface, 1.125, 4.125)


def test_solids_with_a_face_in_common():
    """Blocks with a side in the same plane, of the same triangles."""
    vertices, faces = box(2.0, 6.0, 2.0, 6.0, -1.0, 4.0)
    narrow = vertices.copy()
    narrow[4:, 0] = 4.0
    surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), (vertices, faces), (narrow, faces)), RULES)
    assert not has_floor(surface, 3.125, 4.125) and not has_floor(surface, 5.125, 4.125)


def test_nobody_walks_in_cracks_inside():
    """Floor with a crack under a closed block: the crack is not closed inside of it."""
    floor = join(plane(0.0, 4.1, 0.0, 8.0), plane(4.15, 8.0, 0.0, 8.0))
    surface = build_surface(terrain(floor, box(2.0, 6.0, 2.0, 6.0, -1.0, 4.0)), RULES)
    assert not has_floor(surface, 4.125, 4.125) and has_floor(surface, 4.125, 1.125)


def test_all_but_upright_walls():
    """Walls that lean by 0.03°: where the line through a centre passes them, they count as well."""
    vertices, faces = box(2.0, 6.0, 2.0, 6.0, 2.5, 12.5)
    vertices[vertices[:, 2] > 3.0, :2] += 5e-3
    expected = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), plane(2.0, 6.0, 2.0, 6.0, 2.5)), RULES)
    for shift in np.linspace(-4e-3, 4e-3, 5):
        block = vertices + np.array([0.125 + shift, 0.125 + shift, 0.0]), faces
        surface = build_surface(terrain(plane(0.0, 8.0, 0.0, 8.0), block), RULES)
        assert (surface.height < 1.0).sum() == (expected.height < 1.0).sum() == 32**2


def test_a_level_without_floor_outside_of_solids():
    corner = np.array([(0, 0, 0), (6, 0, 0), (0, 6, 0), (1.5, 1.5, 40.0)])
    spire = corner, np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    with pytest.raises(NavmeshError, match=r"nothing to walk on: .* inside of solids"):
        build_surface(terrain(plane(1.0, 2.0, 1.0, 2.0, 1.0), spire), RULES)


@pytest.mark.parametrize("seed", range(3))
def test_a_changed_chunk_gives_what_a_build_gives(seed):
    ground, solids = scene(seed)
    level = {f"ground {name}": part for name, part in split_terrain(terrain(ground), 5.0).items()}
    level |= {f"solid {k}": terrain(solid) for k, solid in enumerate(solids[:3])}
    level["many"] = join_chunks({"b": terrain(solids[3]), "a": terrain(with_flap(solids[4]))})
    extent = [(-6, -6, -6), (22, 22, 8)]
    graph = NodeGraph.build(join_chunks(level), RULES, extent=extent)
    for changes in (
        {"solid 1": None},
        {"solid 1": terrain(solids[1]), "solid 0": terrain(with_flap(solids[0]))},
        {"a first one": terrain(solids[5]), "many": terrain(solids[3])},
        {"solid 2": None, "a first one": None, "solid 0": terrain(solids[0])},
    ):
        graph = graph.update(changes)
        carried = graph.terrain.solid
        fresh = Terrain(graph.terrain.vertices, graph.terrain.faces, chunks=graph.terrain.chunks).solid
        np.testing.assert_array_equal(carried, fresh)
        assert carried.dtype == fresh.dtype
        assert_same(graph, rebuilt(graph))


def test_parts_end_with_their_chunk():
    """A box in two chunks is closed in neither, whatever the other one has."""
    vertices, faces = box(2.0, 6.0, 2.0, 6.0, -1.0, 4.0)
    halves = {"a": Terrain.from_arrays(vertices, faces[:6]), "b": Terrain.from_arrays(vertices, faces[6:])}
    assert (join_chunks(halves).solid == -1).all()
    assert (join_chunks({"all": join_chunks(halves)}).solid == 0).all()


def test_parts_against_a_plain_count():
    """`Terrain.solid` of random triangles on few places, by sets of faces and a count of edges."""
    rng = np.random.default_rng(0)
    closed, closed_once = 0, 0
    for _ in range(300):
        faces = np.array([rng.permutation(5)[:3] for _ in range(rng.integers(2, 9))])
        faces = np.concatenate([faces, rng.permutation(faces)[: rng.integers(0, len(faces) + 1), ::-1]])
        got = Terrain.from_arrays(rng.normal(size=(5, 3)), faces).solid
        edges = [[(face[k], face[(k + 1) % 3]) for k in range(3)] for face in faces.tolist()]
        repeated = [any(set(edges[g]) == set(edges[f]) for g in range(f)) for f in range(len(faces))]
        part = list(range(len(faces)))
        for _ in faces:
            for f, mine in enumerate(edges):
                for g, other in enumerate(edges):
                    if {frozenset(e) for e in mine} & {frozenset(e) for e in other}:
                        part[f] = part[g] = min(part[f], part[g])
        for f in range(len(faces)):
            every = [e for g in range(len(faces)) if part[g] == part[f] for e in edges[g]]
            whole = all(every.count(e) == every.count(e[::-1]) for e in every)
            distinct = [g for g in range(len(faces)) if part[g] == part[f] and not repeated[g]]
            every = [e for g in distinct for e in edges[g]]
            counted = whole or (f in distinct and all(every.count(e) == every.count(e[::-1]) for e in every))
            assert got[f] == (part[f] if counted else -1)
            closed, closed_once = closed + whole, closed_once + (counted and not whole)
    assert closed > 100 and closed_once > 20


def test_no_obstacles_inside():
    """A platform to jump onto, out in the open and inside of a block."""
    ground, platform = plane(0.0, 12.0, 0.0, 12.0), box(4.0, 8.0, 4.0, 8.0, 0.0, 0.6)
    block = box(0.5, 11.5, 0.5, 11.5, -1.0, 6.0)
    assert len(NodeGraph.build(terrain(ground, platform), RULES).obstacles)
    assert len(NodeGraph.build(terrain(ground, platform, with_flap(block)), RULES).obstacles)
    graph = NodeGraph.build(terrain(ground, platform, block), RULES)
    assert not (graph.obstacles.position[:, 2] < 3.0).any() and not (graph.links.start[:, 2] < 3.0).any()
