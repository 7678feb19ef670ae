"""The graph of discs on the surface: nodes, edges, portals and links; its file; spatial questions to it."""
