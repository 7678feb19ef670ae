"""Rooms and yards with faults, and what a playtest finds in them."""

import math

import numpy as np
import trimesh

import navmesh
from runtime.playtest import playtest
from runtime.playtest.analysis import analyse, core_parts
from runtime.playtest.character import character_of
from runtime.playtest.holes import find_holes
from runtime.playtest.site import Site

NOBODY = np.empty(0, dtype=np.int64)
W, D = 16.0, 10.0
PLAN = "spawns:\n  - {name: gate, at: [2.0, 5.0, 0.0]}\n"


def box(x0, x1, y0, y1, z0, z1):
    return trimesh.creation.box(bounds=[(x0, y0, z0), (x1, y1, z1)])


FLOOR = box(0, W, 0, D, -0.2, 0)


def room(*parts, high=3.2):
    sides = [(-0.3, 0, -0.3, D + 0.3), (W, W + 0.3, -0.3, D + 0.3), (0, W, -0.3, 0), (0, W, D, D + 0.3)]
    return trimesh.util.concatenate([*(box(a, b, c, d, -0.2, high) for a, b, c, d in sides), *parts])


def door(width, lintel=None):
    a, b = 5 - 0.5 * width, 5 + 0.5 * width
    above = [box(8, 8.3, a, b, lintel, 3.2)] if lintel else []
    return [FLOOR, box(8, 8.3, 0, a, 0, 3.2), box(8, 8.3, b, D, 0, 3.2), *above]


def ramp(degrees):
    run = 1.5 / math.tan(math.radians(degrees))
    corners = [(x, y, z) for y in (0.0, D) for x, z in ((10 - run, 0.0), (10.0, 0.0), (10.0, 1.5))]
    return [FLOOR, box(10, W, 0, D, 0, 1.5), trimesh.convex.convex_hull(np.array(corners))]


def played(folder, mesh, bots=0, seconds=20.0, plan=PLAN):
    mesh.export(folder / "level.obj")
    (folder / "level.playtest.yaml").write_text(plan)
    return playtest(folder / "level.obj", bots=bots, seconds=seconds, seed=1)


def site_of(mesh, tags=None, body="walker"):
    player = character_of(body)
    terrain = navmesh.Terrain.from_arrays(mesh.vertices, mesh.faces)
    return Site(navmesh.NodeGraph.build(terrain, player.rules, player.obstacle_rules(), tags=tags), player)


HOLED = [
    box(0, W, 0, 4, -0.2, 0),
    box(0, W, 6, D, -0.2, 0),
    box(0, 7, 4, 6, -0.2, 0),
    box(9, W, 4, 6, -0.2, 0),
]


def unreached(mesh, body="walker"):
    """What cannot be reached, or not be left again, from the largest part of a level."""
    return analysed(site_of(mesh, body=body))


def analysed(site):
    starts = core_parts(site)
    return analyse(site, find_holes(site, site.reached(starts)), starts, NOBODY, NOBODY)


def gap_of(width):
    return trimesh.util.concatenate([box(0, 12, 0, 6, -0.3, 0), box(12 + width, 20 + width, 0, 6, -0.3, 0)])
