"""How near a body can come to a goal that it cannot reach: the nearest place in the parts of the graph that
it can get to."""

from math import sqrt

from navmesh.graph.parts import TILE
from navmesh.graph.snapping import CANDIDATES, candidate, node_at, place_in, squared_distance
from navmesh.surface.clearance_field import centre_of, slope_at
from navmesh.surface.floor_store import height_of
from surefoot.kernels import kernel

__all__ = ["nearest_reachable"]


@kernel(error_model="numpy", forceinline=True)
def _may_reach(net, doors, scratch, k):
    """Whether scratch.reached marks the part of any node that `node_at` can give for cell ``k``."""
    for i in range(CANDIDATES):
        node = candidate(net, k, doors.radius, i)
        if node >= 0 and scratch.reached[doors.region[doors.part[node]]] == scratch.numbers[0]:
            return True
    return False


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
        slope_x, slope_y = slope_at(net, k)
        rise = max(abs(height_of(net, k) - z) - (abs(slope_x) + abs(slope_y)) * half, 0.0)
        if net.clearance[k] < radius - 1.4144 * half or square + rise * rise >= best:
            continue
        if not _may_reach(net, doors, scratch, k):
            continue
        off, px, py = place_in(net, k, x, y, z, radius, 0.0, 1e300)
        if off < best:
            other = node_at(net, k, px, py, radius)
            if other >= 0 and reached[region[part[other]]] == mark:
                best, node, cell, bx, by = off, other, k, px, py
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search_tile(net, doors, scratch, tile, low, x, y, z, best, node, cell, bx, by, refine):
    """The place nearest to (x, y, z) in one tile and in a part that scratch.reached marks, where it is nearer
    than ``best`` (squared); none is less than ``low`` away in height, squared. Not ``refine``: among the
    centres of cells."""
    h = net.cell
    along = (net.ny + TILE - 1) // TILE
    low_x, low_y = tile // along * TILE, tile % along * TILE
    high_x, high_y = min(low_x + TILE, net.nx), min(low_y + TILE, net.ny)
    # from the column nearest to (x, y) to all sides, until no column there can be near enough
    first_x = min(max(int(x // h), low_x), high_x - 1)
    first_y = min(max(int(y // h), low_y), high_y - 1)
    for turn_x in (1, -1):
        ix = first_x if turn_x > 0 else first_x - 1
        while low_x <= ix < high_x:
            dx = max(abs((ix + 0.5) * h - x) - 0.5 * h, 0.0)
            if dx * dx + low >= best:
                break
            for turn_y in (1, -1):
                iy = first_y if turn_y > 0 else first_y - 1
                while low_y <= iy < high_y:
                    dy = max(abs((iy + 0.5) * h - y) - 0.5 * h, 0.0)
                    square = dx * dx + dy * dy
                    if square + low >= best:
                        break
                    column = ix * net.ny + iy
                    best, node, cell, bx, by = _search_column(
                        net, doors, scratch, column, square, x, y, z, best, node, cell, bx, by, refine
                    )
                    iy += turn_y
            ix += turn_x
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def _search_tiles(net, doors, scratch, x, y, z, best, node, cell, bx, by, refine):
    """`_search_tile` over all tiles, from (x, y) outwards; those without a part that is marked, or with no
    floor of one at a height that is near enough, are passed over."""
    reached, mark, region = scratch.reached, scratch.numbers[0], doors.region
    tile_part, tile_span = doors.tile_part, doors.tile_span
    side = TILE * net.cell
    across, along = (net.nx + TILE - 1) // TILE, (net.ny + TILE - 1) // TILE
    tx = min(max(int(x // side), 0), across - 1)
    ty = min(max(int(y // side), 0), along - 1)
    for ring in range(max(across, along)):
        nearest = max(ring - 1, 0) * side
        if nearest * nearest >= best:
            break
        for jx in range(max(tx - ring, 0), min(tx + ring + 1, across)):
            edge = jx == tx - ring or jx == tx + ring
            for jy in range(ty - ring, ty + ring + 1, 1 if edge else max(2 * ring, 1)):
                if jy < 0 or jy >= along:
                    continue
                dx = max(abs((jx + 0.5) * side - x) - 0.5 * side, 0.0)
                dy = max(abs((jy + 0.5) * side - y) - 0.5 * side, 0.0)
                if dx * dx + dy * dy >= best:
                    continue
                tile = jx * along + jy
                low = 1e300
                for i in range(doors.tile_start[tile], doors.tile_start[tile + 1]):
                    if reached[region[tile_part[i]]] == mark:
                        rise = max(tile_span[i, 0] - z, z - tile_span[i, 1], 0.0)
                        low = min(low, rise * rise)
                if dx * dx + dy * dy + low < best:
                    best, node, cell, bx, by = _search_tile(
                        net, doors, scratch, tile, low, x, y, z, best, node, cell, bx, by, refine
                    )
    return best, node, cell, bx, by


@kernel(error_model="numpy")
def nearest_reachable(net, doors, scratch, x, y, z):
    """The place nearest to (x, y, z) in a straight line among those in the parts that scratch.reached marks:
    of the places nearest to it in each cell (`place_in`), the nearest; of equally near ones always the same.

    The nearest centre of a cell says which cells are worth a closer look. Returns (node, cell, x, y, distance
    [m]).
    """
    best, node, cell, bx, by = _search_tiles(net, doors, scratch, x, y, z, 1e300, -1, -1, x, y, False)
    if node >= 0:
        bound = best * (1.0 + 1e-9) + 1e-12  # its own cell is to be found again
        off, other, k, px, py = _search_tiles(net, doors, scratch, x, y, z, bound, -1, -1, x, y, True)
        if other >= 0:
            best, node, cell, bx, by = off, other, k, px, py
    else:  # only places between the centres
        best, node, cell, bx, by = _search_tiles(net, doors, scratch, x, y, z, 1e300, -1, -1, x, y, True)
    return node, cell, bx, by, sqrt(best)
