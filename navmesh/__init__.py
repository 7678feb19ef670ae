"""From a level's mesh to routes: the walkable surface as a graph of discs."""

from navmesh.chunks import chunks_of, join_chunks, split_terrain
from navmesh.errors import NavmeshError
from navmesh.graph import NodeGraph
from navmesh.kinds import ObstacleKind
from navmesh.obstacle_rules import ObstacleRules
from navmesh.obstacles import Obstacles
from navmesh.route import Route, Routes
from navmesh.rules import WalkRules
from navmesh.tagging import load_tags
from navmesh.tags import save_tags, tags_path
from navmesh.terrain import Terrain
from surefoot import __version__
from surefoot.compiling import announce

__all__ = [
    "NavmeshError",
    "NodeGraph",
    "ObstacleKind",
    "ObstacleRules",
    "Obstacles",
    "Route",
    "Routes",
    "Terrain",
    "WalkRules",
    "__version__",
    "chunks_of",
    "join_chunks",
    "load_tags",
    "save_tags",
    "split_terrain",
    "tags_path",
]

announce()
