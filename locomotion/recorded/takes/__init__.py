"""Where the motions of a set come from: the simulation of the person, and keys."""
