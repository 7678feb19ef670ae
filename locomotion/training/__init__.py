"""Training of skills: CMA-ES over simulated trials, with checkpoints."""
