"""Reading and writing files, for all packages: archives of arrays, YAML that people write, atomic writing.

It lies in `navmesh` since that is the package that all others may import; nothing here knows of navigation.
"""
