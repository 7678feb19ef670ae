"""Read and write files: archives of arrays, hand-written YAML, JSON; atomic writing."""
