"""The node-radius graph: discs on the walkable surface, joined where a body can pass from one to the next."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from navmesh.errors import NavmeshError
from navmesh.graph import spatial_queries as queries
from navmesh.graph.carrying import carry_over
from navmesh.graph.first_queries import prepare_like
from navmesh.graph.graph_file import read_graph, write_graph
from navmesh.graph.kept_build import Built, KeptBuild, all_rim_samples, build_whole, grid_for, renewed
from navmesh.graph.links import Links, make_links
from navmesh.level.chunks import change_chunks
from navmesh.level.mesh_queries import MeshGrid
from navmesh.level.terrain import DEFAULT_MATERIAL, Terrain
from navmesh.obstacles.detection import obstacles_at, with_own_kinds
from navmesh.obstacles.obstacles import Obstacles
from navmesh.obstacles.rim_samples import RimSamples
from navmesh.obstacles.rules import ObstacleRules
from navmesh.obstacles.tagging import TagFile
from navmesh.routes import path_queries as pathfinding
from navmesh.routes.path_queries import PathSearch
from navmesh.routes.route import Route, Routes
from navmesh.rules import WalkRules
from navmesh.surface.build import Grid
from navmesh.surface.surface import Surface
from navmesh.threads import checked_threads
from navmesh.zones.outlines import checked_outlines
from navmesh.zones.plain import plain_graph
from navmesh.zones.zones import Zones, rebuilt, zoned_graph
from surefoot.freed_memory import give_back
from surefoot.words import several

if TYPE_CHECKING:
    import networkx

__all__ = ["NodeGraph"]

_OBSTACLE_RULES = ObstacleRules()
_MANY = 500_000
"""Cells from which on it is worth while to give back to the system what the build has freed."""


@dataclass(eq=False)
class NodeGraph:
    """Discs that cover the walkable surface of a terrain. Make one with `build` or `load`.

    Inside a disc a body of radius r can stand wherever it is r away from the rim; a body passes an edge
    when it is not wider than the edge. One graph serves bodies of every radius. Arrays are not to be
    changed from outside.
    """

    terrain: Terrain
    """The geometry that the graph was built from."""
    rules: WalkRules
    surface: Surface
    positions: np.ndarray
    """(m, 3) float64 [m], world coordinates of the nodes: points of the surface, centres of cells or, in a
    narrow passage, its middle."""
    radii: np.ndarray
    """(m,) float64 [m]: horizontal distance from the node to the nearest place where walking ends; -1 for
    nodes that are not there with the zones that are blocked now."""
    node_cell: np.ndarray
    """(m,) int32: the cell that the node lies in."""
    label: np.ndarray
    """(n,) int32: the node that owns each cell of the surface (least d² - r² of the discs that hold it);
    -1 for cells in no disc, which have less clearance than `WalkRules.min_radius`."""
    edge_start: np.ndarray
    """(m + 1,) int32: the edges that leave node i are edge_start[i]:edge_start[i + 1], by rising target."""
    edge_target: np.ndarray
    """(e,) int32: the node that an edge leads to. Every edge has its reverse."""
    edge_width: np.ndarray
    """(e,) float64 [m]: radius of the widest body that passes."""
    edge_gate: np.ndarray
    """(e, 2) float64 [m]: x, y of the place on the border of the two labels that the widest body passes,
    relative to surface.origin."""
    edge_cells: np.ndarray
    """(e, 2) int32: linked cells on the border of the two labels with the most clearance: the first is
    owned by the edge's source, the second by its target."""
    obstacles: Obstacles = field(default_factory=Obstacles.empty)
    """What a skill can clear, found in the mesh and corrected by the author's tags."""
    links: Links = field(default_factory=Links.empty)
    """The ways over the obstacles that a route can take; see `find_path`'s skills."""
    obstacle_rules: ObstacleRules | None = None
    """What `build` was given."""
    tags: TagFile | None = None
    """What `build` was given."""
    kept_build: KeptBuild | None = field(default=None, repr=False)
    """What `update` needs of the build; never saved."""
    zone_state: Zones | None = field(default=None, repr=False)
    """What `with_zones` was given, and what is blocked; never saved."""
    cache: dict[str, Any] = field(default_factory=dict, repr=False)
    """What queries have worked out and want to keep; never saved, and may be emptied at any time."""

    @classmethod
    def build(
        cls,
        terrain: Terrain,
        rules: WalkRules | None = None,
        obstacle_rules: ObstacleRules | None = _OBSTACLE_RULES,
        tags: TagFile | None = None,
        extent: Any = None,
        threads: int = 1,
    ) -> "NodeGraph":
        """The graph of ``terrain`` under ``rules`` (default: `WalkRules()`).

        ``obstacle_rules`` say what counts as clearable; None leaves the search for obstacles out. ``tags``
        (`navmesh.load_tags`) are the author's additions, changes and removals. ``extent`` (2, 3) [m] are the
        least and the greatest corner of the room that a level which grows (`update`) is going to fill; by
        default its bounds. ``threads``, at least 1, share most of the work; the graph is the same
        bit for bit. Raises `NavmeshError` when nothing is walkable, or when the tags do not fit the level.
        """
        if not isinstance(terrain, Terrain):
            raise NavmeshError(f"terrain: expected a navmesh.Terrain, not a {type(terrain).__name__}")
        if not isinstance(rules, WalkRules | None):
            raise NavmeshError(f"rules: expected navmesh.WalkRules, not a {type(rules).__name__}")
        rules = rules or WalkRules()
        threads = checked_threads(threads)
        built = build_whole(terrain, rules, grid_for(terrain, rules, extent), threads)
        surface, found = built.surface, None
        if obstacle_rules is not None:
            found = all_rim_samples(None, (), terrain, surface, rules, obstacle_rules, threads)
        graph = cls._made(terrain, rules, obstacle_rules, tags, built, found)
        if len(surface) > _MANY:
            give_back()
        return graph

    def update(self, changes: Mapping[str, Terrain | None]) -> "NodeGraph":
        """The graph after ``changes`` to the level's chunks: by name, a `Terrain` to be added or to replace
        the one of that name, None to remove it. This graph stays as it is.

        Bit for bit what `build` gives for the changed terrain with this graph's `extent`. Only the
        neighbourhood of the chunks is looked at again, see docs/how-it-works/navmesh.md; where they reach
        beyond the extent, or this graph was loaded and not yet updated, the whole is built anew. Raises
        `NavmeshError` for the removal of a chunk that is not there, when nothing walkable is left, and for
        tags that fit no more.
        """
        terrain, changed = change_chunks(self.terrain, changes)
        if not changed:
            return self
        rules, kept_build = self.rules, self.kept_build
        grid = grid_for(terrain, rules, self.extent, grown=True)
        if (
            kept_build is not None
            and grid.shape == kept_build.built.grid.shape
            and (grid.origin == kept_build.built.grid.origin).all()
        ):
            built, moved = renewed(kept_build.built, changed, terrain, rules)
        else:
            built, kept_build, moved = build_whole(terrain, rules, grid), None, None
        found = None
        if self.obstacle_rules is not None:
            found = all_rim_samples(kept_build, changed, terrain, built.surface, rules, self.obstacle_rules)
        graph = self._made(terrain, rules, self.obstacle_rules, self.tags, built, found)
        if self.zone_state is None:
            if moved is not None:
                carry_over(self, graph, moved)
            return graph
        return rebuilt(graph, self.zone_state.outlines, self.zones)

    def prepare_like(self, other: "NodeGraph") -> None:
        """Work out now what the first queries on this graph would, for the bodies and skills that the
        ``other`` graph was asked for last, such as the one that this is an `update` of. It can be called in a
        thread while others ask on the other graph. Answers are the same with and without."""
        prepare_like(self, other)

    def with_zones(self, outlines: Mapping[str, Any]) -> "NodeGraph":
        """This graph with zones, parts of the floor that can be blocked and opened at once, such as doorways.

        ``outlines`` gives the corners (k, 3) [m] of each zone by its name, in order, on the floor: what
        counts is floor up to half of `WalkRules.headroom` above or below them. Two corners are a line. Zones
        that the graph has already stay as they are, but those of the same names. New ones are open; see
        `block`. With all zones open every query answers as it does on this graph.

        Call it once, when the level is loaded, with all zones: it looks at the whole graph. `update` keeps
        zones and what is blocked, `save` leaves them out, a copy of the graph has its own. ``node_costs`` of
        `find_path` then are for nodes that are not there now, too. Raises `NavmeshError` for outlines that
        are none, or under which there is no floor.
        """
        fresh = checked_outlines(outlines)
        old = self.zone_state
        if old is None:
            return zoned_graph(self, fresh, set(), {})
        blocked = {name: blocked for name, blocked in self.zones.items() if name not in fresh}
        return zoned_graph(old.undivided, old.outlines | fresh, set(old.outlines) - set(fresh), blocked)

    def block(self, *zones: str) -> None:
        """Block ``zones``, by name: from now on nobody can be in them, and no route leads through or jumps
        over. Takes time in proportion to the zones and what is near them, whatever the size of the level.

        This changes the graph itself: not while another thread asks it something. Routes found before can be
        asked whether they still hold (`Route.holds`). Raises `NavmeshError` for a name that there is not.
        """
        self._turn(zones, True)

    def open(self, *zones: str) -> None:
        """Open ``zones``, by name; as `block`."""
        self._turn(zones, False)

    def _turn(self, names: tuple[str, ...], blocked: bool) -> None:
        if self.zone_state is None:
            raise NavmeshError("the graph has no zones; expected one that with_zones has given some")
        self.zone_state.turn(self, names, blocked)

    @property
    def zones(self) -> dict[str, bool]:
        """Whether each zone is blocked, by its name."""
        return {} if self.zone_state is None else self.zone_state.names

    @property
    def undivided(self) -> "NodeGraph":
        """The graph that `with_zones` was called on, as it is with all zones open; itself if it has none."""
        return self if self.zone_state is None else self.zone_state.undivided

    def without_zones(self) -> "NodeGraph":
        """The graph of what there is now, with the zones that are blocked, and without zones: for analysis.
        Its nodes are numbered anew. Takes time in proportion to the level, once after a zone was turned."""
        return plain_graph(self)

    def __reduce_ex__(self, protocol: Any) -> Any:
        if self.zone_state is None:
            return super().__reduce_ex__(protocol)
        return rebuilt, (self.zone_state.undivided, self.zone_state.outlines, self.zones)

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"cache": {}}

    @classmethod
    def _made(
        cls,
        terrain: Terrain,
        rules: WalkRules,
        obstacle_rules: ObstacleRules | None,
        tags: TagFile | None,
        built: Built,
        found: tuple[RimSamples, MeshGrid] | None,
    ) -> "NodeGraph":
        """The graph of what was ``built`` and what was ``found`` at rims (`all_rim_samples`), if there are
        ``obstacle_rules``."""
        surface, nodes = built.surface, built.nodes
        start, target, width, gate, border = built.edges
        obstacles, rim_samples = Obstacles.empty(), None
        if obstacle_rules is not None and found is not None:
            rim_samples, mesh_grid = found
            obstacles = obstacles_at(rim_samples, surface, rules, obstacle_rules, mesh_grid)
            obstacles = with_own_kinds(obstacles, terrain, surface, rules)
        if tags is not None:
            obstacles = tags.apply(obstacles, surface, rules)
        return cls(
            terrain=terrain,
            rules=rules,
            surface=surface,
            positions=nodes.position,
            radii=nodes.place[:, 2].copy(),
            node_cell=nodes.cell,
            label=nodes.label,
            edge_start=start,
            edge_target=target,
            edge_width=width,
            edge_gate=gate,
            edge_cells=border,
            obstacles=obstacles,
            links=make_links(obstacles, surface, rules, (obstacle_rules or _OBSTACLE_RULES).body_radius),
            obstacle_rules=obstacle_rules,
            tags=tags,
            kept_build=KeptBuild(built, rim_samples),
        )

    @property
    def areas(self) -> tuple[str, ...]:
        """Names of the level's materials, in alphabetical order; "default" for what has none."""
        return self.terrain.materials or (DEFAULT_MATERIAL,)

    @property
    def extent(self) -> np.ndarray:
        """(2, 3) float64 [m]: the room that `update` can fill without building everything anew."""
        surface = self.surface
        return Grid(surface.origin, surface.resolution, surface.shape).extent

    def __repr__(self) -> str:
        counts = (len(self), "node"), (len(self.edge_target) // 2, "edge"), (len(self.obstacles), "obstacle")
        parts = ", ".join(several(*each) for each in counts)
        return f"<NodeGraph of {Path(self.terrain.name).name}: {parts}>"

    def __len__(self) -> int:
        return len(self.radii)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the graph to ``path``, without its zones; `load` reads it back."""
        write_graph(path, self.undivided)

    @classmethod
    def load(
        cls, path: str | os.PathLike[str], terrain: Terrain | None = None, rules: WalkRules | None = None
    ) -> "NodeGraph":
        """Read a graph that `save` wrote.

        With ``terrain`` or ``rules`` given, the graph must have been built from just these. Raises
        `ArchiveError` for a file that is missing, cut off, or of another version, `NavmeshError` for one
        made for another terrain or other rules.
        """
        graph = cls(**read_graph(path))
        digest = graph.terrain.digest
        if terrain is not None and terrain.digest != digest:
            raise NavmeshError(
                f"{path}: baked from another terrain than {terrain.name} (digest {digest[:12]}…, "
                f"expected {terrain.digest[:12]}…); bake it anew"
            )
        if rules is not None and rules != graph.rules:
            raise NavmeshError(f"{path}: baked with {graph.rules}, expected {rules}; bake it anew")
        return graph

    def find_path(
        self,
        start: Any,
        goal: Any,
        radius: float = 0.3,
        skills: Mapping[str, tuple[float, float]] | None = None,
        node_costs: np.ndarray | None = None,
        link_costs: np.ndarray | None = None,
        extent: tuple[float, float] | None = None,
        costs: Mapping[str, float] | None = None,
    ) -> Route:
        """The route from ``start`` to ``goal`` (3,) [m] for a body of ``radius`` [m].

        Each end is moved to the place nearest to it where the body fits: a point of the surface with its
        radius clear around it. ``extent`` (horizontal, vertical) [m] is how far it may be moved, by default
        twice the radius and two cells sideways and 1.5 times `WalkRules.headroom` up or down; `max_step`
        of the height does not count as distance. The route's first and last waypoints say where. A goal
        that cannot be reached is replaced by the place that can be and is nearest to it in a straight line:
        the status is "partial". ``skills`` offers typed links: for each affordance
        the least and greatest height [m] that the body can clear, as in {"jump": (0.3, 0.5)}. ``node_costs``
        (m,), at least 1, multiply the length walked in each node. ``link_costs`` (l,) [m], at least 0,
        come on top of what each of `links` costs, as for the chance of failing there; one of math.inf is not
        offered. ``costs`` say what a metre costs in each of the `areas`, as in {"mud":
        3.0}: 1 to 1e6, 1 for areas that are not named, math.inf for those that must not be entered. The route
        is cheap by the sum (`Route.cost`; docs/how-it-works/navmesh.md says how cheap), its length is in
        metres all the same. Never raises because of where the ends are: see `navmesh.routes.route.STATUSES`.
        Raises `NavmeshError` for arguments of a wrong kind.
        """
        return pathfinding.find_path(self, start, goal, radius, skills, node_costs, link_costs, extent, costs)

    def find_paths(
        self,
        starts: Any,
        goals: Any,
        radius: float = 0.3,
        skills: Mapping[str, tuple[float, float]] | None = None,
        node_costs: np.ndarray | None = None,
        workers: int = 1,
        extent: tuple[float, float] | None = None,
        costs: Mapping[str, float] | None = None,
    ) -> Routes:
        """The routes from ``starts`` to ``goals`` (q, 3) [m] each: bit for bit what `find_path` gives
        one by one. ``workers`` threads share the work."""
        return pathfinding.find_paths(self, starts, goals, radius, skills, node_costs, workers, extent, costs)

    def begin_path(
        self,
        start: Any,
        goal: Any,
        radius: float = 0.3,
        skills: Mapping[str, tuple[float, float]] | None = None,
        node_costs: np.ndarray | None = None,
        extent: tuple[float, float] | None = None,
        costs: Mapping[str, float] | None = None,
    ) -> PathSearch:
        """`find_path` as a search that is spread over frames: ``advance`` it, then ``finish`` it."""
        return PathSearch(self, start, goal, radius, skills, node_costs, extent, costs)

    def project(self, points: Any) -> tuple[Any, Any]:
        """The floor at ``points`` (3,) or (k, 3): (cell, world z); see `navmesh.graph.spatial_queries`."""
        return queries.project(self, points)

    def clearance_at(self, points: Any) -> Any:
        """Distance [m] from ``points`` (3,) or (k, 3) to where walking ends; 0 off the surface."""
        return queries.clearance_at(self, points)

    def nearest_edge(self, points: Any) -> queries.NearestEdge:
        """The nearest place where walking ends, and how far it is, for ``points`` (3,) or (k, 3)."""
        return queries.nearest_edge(self, points)

    def nearest_node(self, points: Any) -> Any:
        """The node nearest in space to ``points`` (3,) or (k, 3)."""
        return queries.nearest_node(self, points)

    def containing_node(self, points: Any) -> Any:
        """The node that owns the place of ``points`` (3,) or (k, 3), or -1."""
        return queries.containing_node(self, points)

    def cast_ray(self, starts: Any, ends: Any, radius: float = 0.0) -> queries.Ray:
        """How far a body gets from ``starts`` straight towards ``ends`` (3,) or (k, 3) each."""
        return queries.cast_ray(self, starts, ends, radius)

    def random_points(
        self, rng: np.random.Generator, count: int, radius: float = 0.3, reachable_from: Any = None
    ) -> np.ndarray:
        """``count`` places (count, 3) where a body of ``radius`` fits, evenly spread over the surface."""
        return queries.random_points(self, rng, count, radius, reachable_from)

    def reachable_nodes(self, start: Any, radius: float = 0.3) -> np.ndarray:
        """The nodes that a body of ``radius`` can walk to from ``start`` (3,)."""
        return queries.reachable_nodes(self, start, radius)

    def room_to_turn(self, points: Any, length: float) -> Any:
        """Whether a body of ``length`` can turn around at ``points`` (3,) or (k, 3)."""
        return queries.room_to_turn(self, points, length)

    def to_networkx(self) -> "networkx.Graph":
        """The graph for analysis: nodes with ``position`` (x, y, z) and ``radius``, edges with ``width``
        and ``length`` (distance between centres), all in metres."""
        import networkx  # takes a tenth of a second, which only analysis should

        if self.zone_state is not None:
            return self.without_zones().to_networkx()
        graph = networkx.Graph()
        for i, (position, radius) in enumerate(
            zip(self.positions.tolist(), self.radii.tolist(), strict=True)
        ):
            graph.add_node(i, position=tuple(position), radius=radius)
        source = np.repeat(np.arange(len(self)), np.diff(self.edge_start))
        lengths = np.linalg.norm(self.positions[source] - self.positions[self.edge_target], axis=1)
        for a, b, width, length in zip(
            source.tolist(),
            self.edge_target.tolist(),
            self.edge_width.tolist(),
            lengths.tolist(),
            strict=True,
        ):
            if a < b:
                graph.add_edge(a, b, width=width, length=length)
        return graph
