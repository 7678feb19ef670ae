"""From triangles to the walkable surface: cells, where walking ends, and how far away that is."""
