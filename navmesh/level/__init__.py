"""A level's mesh: triangles, chunks, closed solids, and questions to them."""
