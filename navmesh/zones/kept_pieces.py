"""The pieces of broken discs and the edges between them, kept for each of the last states of the zones near.

A disc has room for as many states as there are zones to do with it: each of these blocked by itself, say. A
state is found by the sign of the disc, see `navmesh.zones.memo`.
"""

import numpy as np

from navmesh.zones.slots import add_edge
from surefoot.kernels import kernel

__all__ = ["disc_around", "keep_pieces", "keep_seam", "recall_pieces", "recall_seams", "room_for_states"]

_NONE = 65535  # the piece of a cell that none has
_SEAMS = 3  # edges for each piece; a planar graph has at most so many


def room_for_states(user_start: np.ndarray, user: np.ndarray, row_start: np.ndarray) -> dict[str, np.ndarray]:
    """The fields of `navmesh.zones.switches.SWITCHES` for states of discs, none of which is kept."""
    discs = len(row_start) - 1
    states = np.bincount(user, minlength=discs)
    rows = np.repeat(np.diff(row_start).astype(np.int64), states)
    row, piece = (np.concatenate([[0], np.cumsum(each)]) for each in (rows, rows // 32 + 16))
    pieces = int(piece[-1])
    return {
        "state_start": np.concatenate([[0], np.cumsum(states)]).astype(np.int32),
        "state_next": np.zeros(discs, np.int32), "state_now": np.full(discs, -1, np.int32),
        "state_sign": np.zeros(len(rows), np.int64), "state_count": np.full(len(rows), -1, np.int32),
        "seam_count": np.full(len(rows), -1, np.int32), "state_row": row, "state_first": piece,
        "state_label": np.empty(row[-1], np.uint16), "state_piece": np.empty(pieces, np.int32),
        "state_cell": np.empty(pieces, np.int32), "state_place": np.empty((pieces, 4)),
        "seam": np.empty((_SEAMS * pieces, 2), np.int32), "seam_place": np.empty((_SEAMS * pieces, 3)),
    }  # fmt: skip


@kernel(error_model="numpy")
def recall_pieces(switches, net, user):
    """Give a disc the pieces that it had when the zones near it were as they are, and say whether these are
    kept."""
    sign = switches.node_sign[switches.whole[user]]
    for state in range(switches.state_start[user], switches.state_start[user + 1]):
        if switches.state_count[state] >= 0 and switches.state_sign[state] == sign:
            break
    else:
        switches.state_now[user] = -1
        return False
    switches.state_now[user] = state
    first, last = np.int64(switches.row_start[user]), np.int64(switches.row_start[user + 1])
    begin = switches.state_first[state]
    switches.piece_count[user] = switches.state_count[state]
    for i in range(switches.state_count[state]):
        node = np.int64(switches.state_piece[begin + i])
        switches.piece[first + i] = node
        radius = switches.state_place[begin + i, 3]
        switches.all_radius[node] = net.node_radius[node] = radius
        for axis in range(3):
            place = switches.state_place[begin + i, axis]
            switches.all_position[node, axis] = place
            net.position[node, axis] = place - switches.origin[axis]
        net.node_cell[node] = switches.state_cell[begin + i]
    shift = switches.state_row[state] - first
    for row in range(first, last):
        number = np.int64(switches.state_label[shift + row])
        switches.all_label[switches.row_cell[row]] = (
            switches.state_piece[begin + number] if number < _NONE else -1
        )
    return True


@kernel(error_model="numpy")
def keep_pieces(switches, net, user, number):
    """Keep the pieces that a disc has now in place of the state that was kept first, if there is room for so
    many. ``number``: notes, one for each row of the disc."""
    start = switches.state_start[user]
    states = switches.state_start[user + 1] - start
    state = start + switches.state_next[user]
    count = switches.piece_count[user]
    begin = switches.state_first[state]
    if count > min(switches.state_first[state + 1] - begin, _NONE):
        return
    switches.state_next[user] = (switches.state_next[user] + 1) % states
    switches.state_now[user] = state
    switches.state_sign[state], switches.state_count[state] = switches.node_sign[switches.whole[user]], count
    switches.seam_count[state] = -1
    first, last = np.int64(switches.row_start[user]), np.int64(switches.row_start[user + 1])
    for i in range(count):
        node = np.int64(switches.piece[first + i])
        switches.state_piece[begin + i], switches.state_cell[begin + i] = node, net.node_cell[node]
        switches.state_place[begin + i, 3] = switches.all_radius[node]
        for axis in range(3):
            switches.state_place[begin + i, axis] = switches.all_position[node, axis]
        number[node - switches.first_piece - first] = i
    shift = switches.state_row[state] - first
    for row in range(first, last):
        label = np.int64(switches.all_label[switches.row_cell[row]])
        at = label - switches.first_piece - first
        switches.state_label[shift + row] = number[at] if label >= 0 else _NONE


@kernel(forceinline=True)
def disc_around(switches, a, b):
    """The disc that both of two nodes are pieces of, or -1."""
    first = switches.first_piece
    if a < first or b < first or switches.row_user[a - first] != switches.row_user[b - first]:
        return np.int64(-1)
    return np.int64(switches.row_user[a - first])


@kernel(error_model="numpy")
def recall_seams(switches, user):
    """Add the edges between the pieces that a disc has now, and say whether these are kept; if not, they are
    kept from now on by `keep_seam`."""
    state = switches.state_now[user]
    if state < 0:
        return False
    if switches.seam_count[state] < 0:
        switches.seam_count[state] = 0
        return False
    first = _SEAMS * switches.state_first[state]
    for i in range(first, first + switches.seam_count[state]):
        c, n = switches.seam[i, 0], switches.seam[i, 1]
        a, b = np.int64(switches.all_label[c]), np.int64(switches.all_label[n])
        place = switches.seam_place[i, 0], switches.seam_place[i, 1], switches.seam_place[i, 2]
        add_edge(switches, a, b, place, (c, n))
    return True


@kernel
def keep_seam(switches, user, place, border):
    """Keep an edge between two pieces that a disc has now; nothing is kept of it if there is no room."""
    state = switches.state_now[user]
    if state < 0:
        return
    at = _SEAMS * switches.state_first[state] + switches.seam_count[state]
    if at == _SEAMS * switches.state_first[state + 1]:
        switches.state_count[state] = switches.state_now[user] = -1
        switches.state_next[user] = state - switches.state_start[user]
        return
    switches.seam[at, 0], switches.seam[at, 1] = border
    for i in range(3):
        switches.seam_place[at, i] = place[i]
    switches.seam_count[state] += 1
