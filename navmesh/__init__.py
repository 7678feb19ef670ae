"""From a level's mesh to routes: the walkable surface as a graph of discs."""

from navmesh.errors import NavmeshError
from navmesh.graph import NodeGraph
from navmesh.rules import WalkRules
from navmesh.terrain import Terrain

__all__ = ["NavmeshError", "NodeGraph", "Terrain", "WalkRules"]
