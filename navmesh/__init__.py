"""From a level's mesh to routes: the walkable surface as a graph of discs."""

from navmesh.errors import NavmeshError
from navmesh.graph import NodeGraph
from navmesh.obstacle_rules import ObstacleRules
from navmesh.rules import WalkRules
from navmesh.tagging import load_tags
from navmesh.tags import save_tags, tags_path
from navmesh.terrain import Terrain

__all__ = [
    "NavmeshError",
    "NodeGraph",
    "ObstacleRules",
    "Terrain",
    "WalkRules",
    "load_tags",
    "save_tags",
    "tags_path",
]
