"""People that play recorded motion and move as walkers do, by the hundred."""
