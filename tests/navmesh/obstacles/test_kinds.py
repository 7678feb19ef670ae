"""Kinds of obstacles: each is crossed like the one that the package finds, wherever it comes from."""

import numpy as np
import pytest

import navmesh
from navmesh.obstacles import kinds
from navmesh.obstacles.kinds import ObstacleKind, affordances, kind_of
from navmesh.obstacles.obstacles import Obstacles
from navmesh.obstacles.tagging import TagFile
from navmesh.obstacles.tags import Addition, Reference, Tags
from tests.navmesh.shapes import box, terrain

FOUND = {
    "jump": (box(12, 24, 0, 8, -1, 0.5),),
    "vault": (box(12, 12.3, 0, 8, -1, 0.8), box(12.3, 24, 0, 8, -1, 0)),
    "drop": (box(12, 24, 0, 8, -3, -1.2),),
    "gap": (box(12, 13, 0, 8, -4, -3), box(13, 24, 0, 8, -1, 0.1)),
}
"""What is behind a floor from x = 0 to 12: one obstacle of a kind for who runs along x."""


@pytest.fixture
def mantle(request):
    """A kind crossed as ``request.param``, another name with the same effort."""
    known = kind_of(request.param)
    kinds.register(ObstacleKind("own-kind", known.crossing, known.effort))
    yield request.param
    kinds.unregister("own-kind")


def level_of(affordance):
    return terrain(box(0, 12, 0, 8, -1, 0), *FOUND[affordance])


def forward(graph, affordance):
    """Index of the obstacle of a kind for one who runs along x."""
    obstacles = graph.obstacles
    (index,) = np.flatnonzero((obstacles.affordance == affordance) & (obstacles.normal[:, 0] < -0.9))
    return index


@pytest.mark.parametrize("mantle", FOUND, indirect=True)
def test_a_registered_kind_is_linked_like_the_one_that_is_crossed_in_the_same_way(mantle):
    found = navmesh.NodeGraph.build(level_of(mantle))
    at = forward(found, mantle)
    there, kind = found.obstacles, kind_of(mantle)
    own = Addition(
        name="own", affordance="own-kind", position=there.position[at].tolist(), run_towards_deg=0.0,
        width=float(there.width[at]), height=float(there.height[at]),
        depth=float(there.depth[at]) if kind.has_depth else None,
        run_up=float(there.run_up[at]), landing=float(there.landing[at]),
    )  # fmt: skip
    tags = TagFile(Tags(add=[own], remove=[Reference(tag=str(there.tag[at]))]))
    graph = navmesh.NodeGraph.build(level_of(mantle), tags=tags)
    placed = forward(graph, "own-kind")
    assert graph.obstacles.size[placed] == there.size[at]
    assert graph.obstacles.rise[placed] == pytest.approx(there.rise[at], abs=1e-9)
    theirs, ours = found.links.obstacle == at, graph.links.obstacle == placed
    assert ours.any()
    for name in ("start", "edge", "end", "height", "run_up", "cost"):
        one, other = getattr(found.links, name)[theirs], getattr(graph.links, name)[ours]
        assert np.allclose(one, other, atol=1e-9), name


def test_a_kind_looks_for_its_obstacles_itself_and_again_after_a_change():
    level = navmesh.join_chunks({"level": level_of("jump")})
    plain = navmesh.NodeGraph.build(level)
    jump = plain.obstacles.select(np.array([forward(plain, "jump")]))
    climb = Obstacles(**{**jump.arrays(), "affordance": np.array(["climb"]), "tag": np.array(["climb"])})
    asked = []

    def find(terrain, surface, walking):
        asked.append((len(terrain.faces), surface.resolution, walking.max_step))
        return climb

    kinds.register(ObstacleKind("climb", "onto", (2.0, 3.0), find=find))
    try:
        graph = navmesh.NodeGraph.build(level)
        assert graph.obstacles.affordance.tolist() == [*plain.obstacles.affordance.tolist(), "climb"]
        climbs, jumps = graph.links.affordance == "climb", graph.links.affordance == "jump"
        more = graph.links.cost[climbs] - graph.links.cost[jumps]
        assert climbs.sum() == jumps.sum() > 0
        assert more == pytest.approx(1.0 + 0.5 * np.ones(climbs.sum()))
        faces = len(level.faces)
        rules = graph.rules.resolution, graph.rules.max_step
        changed = graph.update({"crate": terrain(box(3, 4, 3, 4, 0, 1))})
        assert asked == [(faces, *rules), (faces + 12, *rules)]
        assert "climb" in changed.obstacles.affordance
    finally:
        kinds.unregister("climb")


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (("Brook", "across"), "'Brook': expected up to 16 letters"),
        (("a-kind-of-a-long-name", "across"), "expected up to 16 letters"),
        (("brook", "through"), "crossing 'through': valid: onto, over, off, across"),
        (("brook", "across", (1.0, -1.0)), "expected two numbers of at least 0"),
        (("brook", "across", 3.0), "expected two numbers of at least 0"),
    ],
)
def test_a_kind_with_a_mistake_is_refused(values, message):
    with pytest.raises(navmesh.NavmeshError, match=message):
        ObstacleKind(*values)


def test_names_are_unique():
    with pytest.raises(navmesh.NavmeshError, match="'gap' is taken"):
        kinds.register(ObstacleKind("gap", "across"))
    with pytest.raises(navmesh.NavmeshError, match="comes with the package"):
        kinds.unregister("gap")
    with pytest.raises(navmesh.NavmeshError, match="'ford': valid: jump, vault, drop, gap"):
        kinds.unregister("ford")
    assert affordances() == ("jump", "vault", "drop", "gap")
