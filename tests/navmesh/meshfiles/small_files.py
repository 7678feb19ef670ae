"""Small PLY, OFF and STL files, as text and binary."""

import struct

from navmesh import Terrain

SQUARE = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)]
L_SHAPE = [(14, 0, 0), (14, 1, 0), (11, 1, 0), (11, 4, 0), (10, 4, 0), (10, 0, 0)]
TWO = (SQUARE[:3], [SQUARE[0], SQUARE[2], SQUARE[3]])


def load(tmp_path, name, content):
    file = tmp_path / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return Terrain.load(file)


def ply(kind, points, faces, corners="property list uchar int vertex_indices", end="\n", name="face"):
    head = [
        "ply",
        f"format {kind} 1.0",
        "comment made by hand, see end_header",
        f"element vertex {len(points)}",
    ]
    head += [f"property {'float' if kind == 'ascii' else 'double'} {axis}" for axis in "xyz"]
    head += [f"element {name} {len(faces)}", corners, "end_header", ""]
    text = end.join(head)
    if kind == "ascii":
        rows = [*points, *([len(face), *face] for face in faces)]
        return (text + end.join(" ".join(str(value) for value in row) for row in rows) + end).encode()
    order = "<" if "little" in kind else ">"
    body = b"".join(struct.pack(f"{order}3d", *point) for point in points)
    return text.encode() + body + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


def off(head="OFF\n6 1 0", points=L_SHAPE, more="", faces="6 0 1 2 3 4 5"):
    return f"{head}\n" + "".join(f"{x} {y} {z}{more}\n" for x, y, z in points) + f"{faces}\n"


def stl(*outlines, name=""):
    lines = [f"solid {name}"]
    for outline in outlines:
        corners = [f"      vertex {x} {y} {z}" for x, y, z in outline]
        lines += ["  facet normal 0 0 1", "    outer loop", *corners, "    endloop", "  endfacet"]
    return "\n".join([*lines, f"endsolid {name}", ""])


def binary_stl(head=b"level", count=2):
    facets = [SQUARE[:3], [SQUARE[0], SQUARE[2], SQUARE[3]]]
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *sum(corners, ()), 0xFFFF) for corners in facets)
    return head.ljust(80) + struct.pack("<I", count) + body
