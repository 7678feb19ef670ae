"""Search methods of training: CMA-ES and least squares, with checkpoints."""
