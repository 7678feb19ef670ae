"""How near a body can come to a goal that it cannot reach: the nearest place in the parts of the graph that
it can get to."""

from math import sqrt

import numpy as np

from navmesh.graph.parts import BLOCK, TILE
from navmesh.graph.snapping import CANDIDATES, candidate, node_at, place_in, squared_distance
from navmesh.surface.clearance_field import centre_of, gap_at, slope_at
from navmesh.surface.floor_store import height_of
from surefoot.kernels import kernel

__all__ = ["nearest_reachable", "off_disc"]


@kernel(error_model="numpy", forceinline=True)
def _may_reach(net, doors, scratch, k):
    """Whether scratch.reached marks the part of any node that `node_at` can give for cell ``k``."""
    for i in range(CANDIDATES):
        node = candidate(net, k, doors.radius, i)
        if node >= 0 and scratch.reached[doors.region[doors.part[node]]] == scratch.numbers[0]:
            return True
    return False


@kernel(error_model="numpy")
def off_disc(cx, cy, half, qx, qy, radius, x, y):
    """The squared distance from (x, y) to the nearest point of a square about c, with sides of 2 ``half``,
    that is not within ``radius`` of q; 1e300 where all are.

    It is the nearest of the square, or of a side, or where the circle meets a side or is nearest to (x, y).
    """
    best, room = 1e300, radius * radius * (1.0 - 1e-9)
    for i in range(14):
        if i == 0:
            px, py = min(max(x, cx - half), cx + half), min(max(y, cy - half), cy + half)
        elif i == 1:
            far = max(sqrt((x - qx) * (x - qx) + (y - qy) * (y - qy)), 1e-12)
            px, py = qx + radius * (x - qx) / far, qy + radius * (y - qy) / far
        else:  # sides to the right, left, above and below, and three places of each
            side = half if (i - 2) % 2 == 0 else -half
            upright = i < 8
            across = (cx if upright else cy) + side
            middle, along = (cy, y) if upright else (cx, x)
            off = across - (qx if upright else qy)
            at = along
            if (i - 2) % 6 >= 2:
                if radius < abs(off):
                    continue
                reach = sqrt(radius * radius - off * off)
                at = (qy if upright else qx) + (reach if (i - 2) % 6 < 4 else -reach)
                if abs(at - middle) > half:
                    continue
            at = min(max(at, middle - half), middle + half)
            px, py = (across, at) if upright else (at, across)
        if max(abs(px - cx), abs(py - cy)) > half * (1.0 + 1e-9):
            continue
        if (px - qx) * (px - qx) + (py - qy) * (py - qy) >= room:
            best = min(best, (px - x) * (px - x) + (py - y) * (py - y))
            if i == 0:
                break
    return best


@kernel(error_model="numpy")
def _look_closer(net, doors, scratch, k, x, y, z, best, node, cell, bx, by):
    """The place nearest to (x, y, z) in one cell and in a part that scratch.reached marks, where it is nearer
    than ``best`` (squared)."""
    off, px, py = place_in(net, k, x, y, z, doors.radius, 0.0, 1e300)
    if off < best:
        other = node_at(net, k, px, py, doors.radius)
        if other >= 0 and scratch.reached[doors.region[doors.part[other]]] == scratch.numbers[0]:
            return off, other, k, px, py
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search_column(net, doors, scratch, column, square, x, y, z, best, node, cell, bx, by, refine):
    """`_search_tile` for one column; its square is ``square`` away from (x, y), squared."""
    radius, half = doors.radius, 0.5 * net.cell
    reached, mark, part, region = scratch.reached, scratch.numbers[0], doors.part, doors.region
    for k in range(net.column_start[column], net.column_start[column + 1]):
        if not refine:
            if net.clearance[k] < radius or net.label[k] < 0 or reached[region[part[net.label[k]]]] != mark:
                continue
            px, py = centre_of(net, k)
            off = squared_distance(net, k, px, py, x, y, z, 0.0)
            if off < best:
                best, node, cell, bx, by = off, net.label[k], k, px, py
            continue
        if k == cell or net.clearance[k] < radius - 1.4144 * half:
            continue
        slope_x, slope_y = slope_at(net, k)
        rise = max(abs(height_of(net, k) - z) - (abs(slope_x) + abs(slope_y)) * half, 0.0)
        if square + rise * rise >= best:
            continue
        if net.clearance[k] < radius + 1.4144 * half:
            cx, cy = centre_of(net, k)
            _, qx, qy = gap_at(net, k, cx, cy)
            if off_disc(cx, cy, half, qx, qy, radius, x, y) + rise * rise >= best:
                continue
        if _may_reach(net, doors, scratch, k):
            best, node, cell, bx, by = _look_closer(net, doors, scratch, k, x, y, z, best, node, cell, bx, by)
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search_tile(net, doors, scratch, tile, blocks, low, x, y, z, best, node, cell, bx, by, refine):
    """The place nearest to (x, y, z) in these ``blocks`` of a tile, `navmesh.graph.parts.Tiles.block`, and in
    a part that scratch.reached marks, where it is nearer than ``best`` (squared); none is less than ``low``
    away in height, squared. Not ``refine``: among the centres of cells."""
    h = net.cell
    side, count = BLOCK * h, TILE // BLOCK
    along = (net.ny + TILE - 1) // TILE
    low_x, low_y = tile // along * count, tile % along * count
    # from the block nearest to (x, y) to all sides, until none there can be near enough
    first_x = min(max(int(x // side) - low_x, 0), count - 1)
    first_y = min(max(int(y // side) - low_y, 0), count - 1)
    for turn_x in (1, -1):
        jx = first_x if turn_x > 0 else first_x - 1
        while 0 <= jx < count:
            dx = max(abs((low_x + jx + 0.5) * side - x) - 0.5 * side, 0.0)
            if dx * dx + low >= best:
                break
            row = (blocks >> (count * jx)) & ((1 << count) - 1)
            for turn_y in (1, -1):
                jy = first_y if turn_y > 0 else first_y - 1
                while row != 0 and 0 <= jy < count:
                    dy = max(abs((low_y + jy + 0.5) * side - y) - 0.5 * side, 0.0)
                    if dx * dx + dy * dy + low >= best:
                        break
                    if (row >> jy) & 1 == 1:
                        for i in range(BLOCK * BLOCK):
                            ix, iy = BLOCK * (low_x + jx) + i // BLOCK, BLOCK * (low_y + jy) + i % BLOCK
                            if ix >= net.nx or iy >= net.ny:
                                continue
                            off_x = max(abs((ix + 0.5) * h - x) - 0.5 * h, 0.0)
                            off_y = max(abs((iy + 0.5) * h - y) - 0.5 * h, 0.0)
                            square = off_x * off_x + off_y * off_y
                            if square + low < best:
                                best, node, cell, bx, by = _search_column(
                                    net, doors, scratch, ix * net.ny + iy, square,
                                    x, y, z, best, node, cell, bx, by, refine,
                                )  # fmt: skip
                    jy += turn_y
            jx += turn_x
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search_around(net, doors, scratch, most, x, y, z, best, node, cell, bx, by, refine):
    """`_search_tile` over all tiles, from (x, y) outwards; those without a part that is marked, or with no
    floor of one at a height that is near enough, are passed over. Also whether it came to an end before it
    had looked at more than ``most`` tiles."""
    reached, mark, region = scratch.reached, scratch.numbers[0], doors.region
    side = TILE * net.cell
    across, along = (net.nx + TILE - 1) // TILE, (net.ny + TILE - 1) // TILE
    tx = min(max(int(x // side), 0), across - 1)
    ty = min(max(int(y // side), 0), along - 1)
    seen = 0
    for ring in range(max(across, along)):
        nearest = max(ring - 1, 0) * side
        if nearest * nearest >= best:
            break
        if seen > most:
            return False, best, node, cell, bx, by
        for jx in range(max(tx - ring, 0), min(tx + ring + 1, across)):
            edge = jx == tx - ring or jx == tx + ring
            for jy in range(ty - ring, ty + ring + 1, 1 if edge else max(2 * ring, 1)):
                if jy < 0 or jy >= along:
                    continue
                seen += 1
                dx = max(abs((jx + 0.5) * side - x) - 0.5 * side, 0.0)
                dy = max(abs((jy + 0.5) * side - y) - 0.5 * side, 0.0)
                if dx * dx + dy * dy >= best:
                    continue
                tile = jx * along + jy
                low, blocks = 1e300, np.int64(0)
                for i in range(doors.tile_start[tile], doors.tile_start[tile + 1]):
                    if reached[region[doors.tile_part[i]]] == mark:
                        low = min(low, _rise(doors, i, z))
                        blocks |= doors.tile_block[i]
                if dx * dx + dy * dy + low < best:
                    best, node, cell, bx, by = _search_tile(
                        net, doors, scratch, tile, blocks, low, x, y, z, best, node, cell, bx, by, refine
                    )
    return True, best, node, cell, bx, by


@kernel(error_model="numpy", forceinline=True)
def _rise(doors, row, z):
    """How far a height ``z`` is from those of a row of the tiles at least, squared."""
    rise = max(doors.tile_span[row, 0] - z, z - doors.tile_span[row, 1], 0.0)
    return rise * rise


@kernel(error_model="numpy")
def _search_regions(net, doors, scratch, regions, x, y, z, best, node, cell, bx, by, refine):
    """`_search_tile` over all tiles of the first ``regions`` of scratch.part_stack, the marked ones."""
    side = TILE * net.cell
    along = (net.ny + TILE - 1) // TILE
    for i in range(regions):
        part = np.int64(scratch.part_stack[i])
        while True:
            for at in range(doors.part_row_start[part], doors.part_row_start[part + 1]):
                row = np.int64(doors.part_row[at])
                tile = np.int64(doors.row_tile[row])
                dx = max(abs((tile // along + 0.5) * side - x) - 0.5 * side, 0.0)
                dy = max(abs((tile % along + 0.5) * side - y) - 0.5 * side, 0.0)
                low = _rise(doors, row, z)
                if dx * dx + dy * dy + low < best:
                    blocks = doors.tile_block[row]
                    best, node, cell, bx, by = _search_tile(
                        net, doors, scratch, tile, blocks, low, x, y, z, best, node, cell, bx, by, refine
                    )
            part = np.int64(doors.ring[part])
            if part == scratch.part_stack[i]:
                break
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search(net, doors, scratch, regions, rows, x, y, z, best, node, cell, bx, by, refine):
    """The place nearest to (x, y, z), of those nearer than ``best`` (squared): from there outwards or, where
    that would be more tiles than the ``rows`` of the ``regions``, over these."""
    is_done, best, node, cell, bx, by = _search_around(
        net, doors, scratch, rows, x, y, z, best, node, cell, bx, by, refine
    )
    if not is_done:
        best, node, cell, bx, by = _search_regions(
            net, doors, scratch, regions, x, y, z, best, node, cell, bx, by, refine
        )
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def nearest_reachable(net, doors, scratch, regions, rows, x, y, z, bound):
    """The place nearest to (x, y, z) in a straight line, less than ``bound`` away (squared), among those in
    the first ``regions`` of scratch.part_stack, which scratch.reached marks: of the places nearest to it in
    each cell (`place_in`), the nearest; of equally near ones always the same. ``rows``: of the tiles, as many
    as these regions have.

    The nearest centre of a cell says which cells are worth a closer look. Returns (node, cell, x, y, distance
    [m]); node -1 where there is none.
    """
    best, node, cell, bx, by = _search(
        net, doors, scratch, regions, rows, x, y, z, bound, -1, -1, x, y, False
    )
    if node >= 0:
        best, node, cell, bx, by = _look_closer(
            net, doors, scratch, np.int64(cell), x, y, z, best, node, cell, bx, by
        )
    best, node, cell, bx, by = _search(
        net, doors, scratch, regions, rows, x, y, z, best, node, cell, bx, by, True
    )
    return node, cell, bx, by, sqrt(best)
