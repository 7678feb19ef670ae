"""Learning preconditions: trying skills from many states, and fitting what came of it."""
