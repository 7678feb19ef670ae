"""Playtests measure faults on the mesh: what was planted is named, measured and found in its place, and what
only looks like a fault is not one."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
import trimesh

from benchmarks.planted_rooms import FAULTS, LOOK_ALIKES, planted
from benchmarks.playtest_faults import judged
from navmesh.surface.ledges import GAP
from runtime.playtest.character import character_of
from runtime.playtest.closeup import close_up
from runtime.playtest.floorplan import Allowance, FloorPlan
from runtime.playtest.mesh import Mesh
from runtime.playtest.page import write_page
from runtime.views.render import Triangles
from tests.runtime.playtest.levels import FLOOR, HOLED, D, W, box, door, played, room, unreached


@pytest.mark.parametrize(
    "mesh",
    [
        room(box(0, 8, 0, D, -0.2, 0), box(8.01, W, 0, D, -0.2, 0)),
        room(box(0, 8, 0, D, -0.2, 0), box(8.05, W, 0, D, -0.2, 0)),
        room(*door(0.62)),
        room(*door(0.85)),
        room(*door(1.2, 1.9)),
        FLOOR,
    ],
    ids=["crack of 1 cm", "crack of 5 cm", "door of 0.62 m", "door of 0.85 m", "lintel at 1.9 m", "no walls"],
)
def test_what_is_as_it_should_be_is_no_fault(tmp_path, mesh):
    assert [fault.text for fault in played(tmp_path, mesh, bots=8).report.failures] == []


def test_of_many_notes_on_parts_out_of_reach_the_largest_are_told_and_the_others_counted():
    pillars = [box(6 * x, 6 * x + 2, 6 * y, 6 * y + 2, 0, 4) for x in range(6) for y in range(4)]
    found = unreached(trimesh.util.concatenate([box(-3, 36, -3, 24, -0.2, 0), *pillars]))
    notes = [fault for fault in found if fault.kind == "unreachable"]
    assert len(notes) == 21 and not any(fault.fails for fault in notes)
    (rest,) = (fault for fault in notes if "more parts" in fault.text)
    assert "4 more parts" in rest.text and rest.extent == pytest.approx(4 * 1.4**2, abs=1.5)
    assert rest.extent < 4.01 * min(fault.extent for fault in notes if fault is not rest)
    few = unreached(trimesh.util.concatenate([box(-3, 36, -3, 24, -0.2, 0), *pillars[:21]]))
    assert len([fault for fault in few if fault.kind == "unreachable"]) == 21


def test_an_inner_ledge_is_no_open_edge(tmp_path):
    parts = [box(0, 8, 0, D, -3, 0), box(14, W, 0, D, -3, 0), box(8, 14, 0, D, -3, -1.2)]
    faults = played(tmp_path, room(*parts)).report.faults
    assert "one_way" in [fault.kind for fault in faults]
    assert not {"open_edge", "hole"} & {fault.kind for fault in faults}


@pytest.mark.parametrize("name", [*FAULTS, *LOOK_ALIKES])
def test_what_is_planted_is_found_and_nothing_else(tmp_path, name):
    rng = np.random.default_rng(20260 + len(name))
    hall = planted(rng, name, "solid" if name in FAULTS else "faces")
    plan = f"spawns:\n  - {{name: gate, at: {hall.spawn.tolist()}}}\n"
    report = played(tmp_path, hall.mesh, plan=plan).report
    assert judged(hall, report.failures) == "", hall.says


def test_a_level_without_walls_passes_and_falls_are_sightings_of_its_edge(tmp_path):
    report = played(tmp_path, FLOOR, bots=8, seconds=40.0).report
    (edge,) = (fault for fault in report.faults if fault.kind == "open_edge")
    assert report.held and not edge.fails and len(edge.sightings) > 0


def floor_by_rays(mesh, point, step, headroom, slope):
    """The slow reference: heights of the floors at ``point`` (2,), from every triangle over it."""
    hits = []
    for a, b, c in mesh.vertices[mesh.faces]:
        lifted = np.column_stack([b[:2] - a[:2], c[:2] - a[:2]])
        if abs(np.linalg.det(lifted)) < 1e-12:
            continue
        u, v = np.linalg.solve(lifted, point - a[:2])
        if u >= 0 and v >= 0 and u + v <= 1:
            normal = np.cross(b - a, c - a)
            hits.append((a[2] + u * (b - a)[2] + v * (c - a)[2], normal[2] / np.linalg.norm(normal)))
    return [
        z for z, up in hits
        if up >= math.cos(slope) and not any(z + 0.01 < other < z + headroom for other, _ in hits)
    ]  # fmt: skip


def test_the_floor_plan_is_what_rays_find():
    rng = np.random.default_rng(5)
    parts = [box(0, 6, 0, 6, -0.2, 0)]
    for _ in range(9):
        low = rng.uniform((0, 0, 0), (5, 5, 1.5))
        part = trimesh.creation.box(bounds=[low, low + rng.uniform(0.3, 2.0, 3)])
        tilt = trimesh.transformations.rotation_matrix(
            rng.uniform(-0.7, 0.7), rng.normal(size=3), part.centroid
        )
        part.apply_transform(tilt)
        parts.append(part)
    mesh = trimesh.util.concatenate(parts)
    allowed = Allowance(math.radians(35.0), 0.2, 1.8, 0.02)
    plan = FloorPlan(Mesh(mesh.vertices[mesh.faces]), np.array([0, 0, -1.0]), np.array([6, 6, 5.0]), allowed)
    agree = total = 0
    for point in rng.uniform(0.1, 5.9, (400, 2)):
        expected = floor_by_rays(mesh, point, allowed.step, allowed.headroom, allowed.slope)
        at = np.flatnonzero(shapely.contains_xy(plan.pieces, *point))
        found = plan.height(at, np.repeat(point[None], len(at), axis=0))
        same = len(expected) == len(found) and np.allclose(np.sort(expected), np.sort(found), atol=1e-6)
        agree, total = agree + same, total + 1
    # walls count a millimetre to every side, and small steep faces may be risers
    assert agree >= 0.97 * total, (agree, total)


@pytest.mark.parametrize("crack", [0.004, 0.03, 0.099])
def test_a_gap_that_the_graph_takes_for_floor_is_floor_in_the_plan(crack):
    """It closes from side to side, and the floor does not grow elsewhere; what is wider stays open."""
    for width, whole in ((crack, True), (1.02 * GAP, False)):
        mesh = trimesh.util.concatenate([box(0, 2, 0, 3, -0.2, 0), box(2 + width, 4, 0, 3, -0.2, 0)])
        allowed = Allowance.of(character_of("walker").rules)
        low, high = np.array([-1.0, -1.0, -0.1]), np.array([5.0, 4.0, 0.3])
        plan = FloorPlan(Mesh(mesh.vertices[mesh.faces]), low, high, allowed)
        assert (len(np.unique(plan.label)) == 1) == whole
        area = sum(shapely.area(plan.region(label)) for label in np.unique(plan.label).tolist())
        assert area == pytest.approx(12.0 if whole else 12.0 - 3.0 * width, abs=1e-3)


def test_a_wall_of_small_triangles_is_the_wall():
    """The same floor around it as around one of large triangles."""
    floor, turn = (
        box(-3, 3, -3, 3, -0.2, 0),
        trimesh.transformations.rotation_matrix(0.7, (0, 0, 1), (0, 0, 0)),
    )
    shapes = []
    for side in (9.0, 0.2):
        wall = box(-2, 2, 0, 0.2, 0, 2.5)
        wall = trimesh.Trimesh(
            *trimesh.remesh.subdivide_to_size(wall.vertices, wall.faces, side), process=False
        )
        mesh = trimesh.util.concatenate([floor, wall])
        mesh.apply_transform(turn)
        corners = mesh.vertices[mesh.faces].round(8)
        plan = FloorPlan(
            Mesh(corners), np.full(3, -4.0), np.full(3, 4.0), Allowance.of(character_of("walker").rules)
        )
        shapes.append(shapely.union_all(plan.pieces))
    assert shapely.area(shapely.symmetric_difference(*shapes)) < 0.002
    assert shapely.get_num_coordinates(shapes[1]) < 2 * shapely.get_num_coordinates(shapes[0])


def test_the_picture_shows_what_was_measured(tmp_path):
    ceiling = box(-0.3, W + 0.3, -0.3, D + 0.3, 3.2, 3.4)
    outcome = played(tmp_path, room(*door(0.5), ceiling))
    site = outcome.stage.site
    triangles = Triangles(site.graph.terrain.vertices, site.graph.terrain.faces)
    fault = next(each for each in outcome.report.failures if each.kind == "narrow")
    red, green, blue = np.moveaxis(close_up(site, triangles, fault).astype(int), 2, 0)
    bar = (red > 1.6 * green) & (red > 1.6 * blue)
    rows, columns = np.nonzero(bar)
    assert bar.sum() > 60  # the red bar, all of it in the picture
    assert 10 < columns.min() and columns.max() < bar.shape[1] - 10
    assert 10 < rows.min() and rows.max() < bar.shape[0] - 10


def test_the_page_is_the_same_however_fast_it_went(tmp_path):
    outcome = played(tmp_path, room(*HOLED), bots=2, seconds=5.0)
    for number, wall in enumerate((1.0, 7.3)):
        write_page(replace(outcome, wall=wall), tmp_path / f"{number}.html")
    assert (tmp_path / "0.html").read_bytes() == (tmp_path / "1.html").read_bytes()
