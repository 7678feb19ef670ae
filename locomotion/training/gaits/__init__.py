"""Learning to walk, to run, and to go over from one to the other."""
