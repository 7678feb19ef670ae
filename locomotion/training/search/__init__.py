"""What training searches with: CMA-ES and least squares, with checkpoints."""
