"""Open worlds: chunks loaded and dropped around the players, and a coarse graph of the rest."""
