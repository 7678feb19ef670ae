"""From a level's mesh to routes: the walkable surface as a graph of discs."""
