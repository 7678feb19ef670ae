"""From a level's mesh to routes: the walkable surface as a graph of discs."""

from navmesh.errors import NavmeshError
from navmesh.graph.node_graph import NodeGraph
from navmesh.level.chunks import chunks_of, join_chunks, split_terrain
from navmesh.level.terrain import Terrain
from navmesh.obstacles.kinds import ObstacleKind
from navmesh.obstacles.kinds import register as register_kind
from navmesh.obstacles.kinds import unregister as unregister_kind
from navmesh.obstacles.low_passages import crouch_kind
from navmesh.obstacles.obstacles import Obstacles
from navmesh.obstacles.rules import ObstacleRules
from navmesh.obstacles.tagging import load_tags
from navmesh.obstacles.tags import save_tags, tags_path
from navmesh.routes.route import Route, Routes
from navmesh.rules import WalkRules
from navmesh.streaming.baking import bake_open_world
from navmesh.streaming.open_world import OpenWorld
from navmesh.streaming.world_route import WorldRoute
from surefoot import __version__
from surefoot.compile_notice import announce

__all__ = [
    "NavmeshError",
    "NodeGraph",
    "ObstacleKind",
    "ObstacleRules",
    "Obstacles",
    "OpenWorld",
    "Route",
    "Routes",
    "Terrain",
    "WalkRules",
    "WorldRoute",
    "__version__",
    "bake_open_world",
    "chunks_of",
    "crouch_kind",
    "join_chunks",
    "load_tags",
    "register_kind",
    "save_tags",
    "split_terrain",
    "tags_path",
    "unregister_kind",
]

announce()
