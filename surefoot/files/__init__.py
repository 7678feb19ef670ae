"""Reading and writing files, for all packages: archives of arrays, YAML that people write, atomic writing."""
