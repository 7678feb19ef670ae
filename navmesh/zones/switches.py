"""All that zones change when they are blocked and opened, as one bundle for the kernels that do it."""

from numba import float64, int32, int64, uint8, uint16

from surefoot.kernels.bundles import BundleType

__all__ = ["FREE", "SLOTS", "SWITCHES", "TURNS"]

SWITCHES = BundleType(
    grain=float64,
    least=float64,
    first_piece=int64,
    blocked=int32[::1],
    cell_start=int32[::1],
    cell_known=int32[::1],
    known_cell=int32[::1],
    known_nearest=float64[:, ::1],
    known_clearance=float64[::1],
    near_start=int32[::1],
    near_zone=int32[::1],
    near=float64[:, ::1],
    cut_start=int32[::1],
    cut_link=int32[::1],
    cut=int32[:, ::1],
    cut_count=int32[::1],
    side_start=int32[::1],
    side_row=int32[::1],
    side=float64[:, ::1],
    user_start=int32[::1],
    user=int32[::1],
    user_cut=int32[::1],
    whole=int32[::1],
    whole_radius=float64[::1],
    broken=int32[::1],
    turned=int64[::1],
    row_start=int32[::1],
    row_cell=int32[::1],
    row_user=int32[::1],
    row_power=float64[::1],
    cell_row=int32[::1],
    piece_count=int32[::1],
    piece=int32[::1],
    rim_start=int32[::1],
    rim=int32[:, ::1],
    state_start=int32[::1],
    state_next=int32[::1],
    state_now=int32[::1],
    state_sign=int64[::1],
    state_count=int32[::1],
    state_row=int64[::1],
    state_label=uint16[::1],
    state_first=int64[::1],
    state_piece=int32[::1],
    state_cell=int32[::1],
    state_place=float64[:, ::1],
    seam_count=int32[::1],
    seam=int32[:, ::1],
    seam_place=float64[:, ::1],
    numbers=int64[::1],
    head=int32[::1],
    following=int32[::1],
    target=int32[::1],
    width=float64[::1],
    gate=float64[:, ::1],
    border=int32[:, ::1],
    made=int64[::1],
    origin=float64[::1],
    around_start=int32[::1],
    around=int32[::1],
    zone_sign=int64[::1],
    node_sign=int64[::1],
    kept=int64[:, ::1],
    kept_place=float64[:, ::1],
    kept_border=int32[:, ::1],
    all_storey=uint8[:, ::1],
    all_clearance=float64[::1],
    all_nearest=float64[:, ::1],
    all_label=int32[::1],
    all_blocker=float64[:, ::1],
    all_radius=float64[::1],
    all_position=float64[:, ::1],
)
"""All that zones change, and how.

blocked (z,): 1 or 0. Cells *know* the zones that can be nearer to them than where walking ends: zone i is
known to cell_known[cell_start[i]:cell_start[i + 1]], indices of known_cell. Of each of these: known_nearest
(2) [m]: the vector to where walking ends if all zones are open, and known_clearance, its length; near_zone,
near (2), grouped by near_start: the zones that it knows and the vectors to them. cut_link, grouped by zone:
the links that it cuts, as rows of cut (cell, direction, storey that it leads to); cut_count: how many blocked
zones cut each. side_row, grouped by zone: the rows of the blockers that are its outline, and side (4): what
they are if it is blocked.

user, grouped by zone by user_start: the discs that a zone has to do with; user_cut: 1 for those that it is in
the way of. Of each such disc: whole: the node, whole_radius [m], broken: how many blocked zones are in its
way, turned: the number of the last turn that concerned it; its rows from row_start on: row_cell, the cells
that it owns, row_user, itself, and row_power, by how much (d² - r²) they lie in their piece; piece_count and
piece, from row_start on: the nodes that are its pieces now. A piece that is made at the turn of the cell of
row r is node first_piece + r. cell_row (n,): the row of a cell, or -1. rim (3), grouped by disc by rim_start:
its links to cells of others, as cell, direction and other cell, with all zones open.

state_start groups by disc what is kept of it, see `navmesh.zones.kept_pieces`; state_now is the state that it
is in, or -1 if that is not kept, state_next the one that makes room next, counted from state_start. Of each
state: state_sign; state_label, from state_row on: for each row of the disc which of the pieces it belongs to;
from state_first on: state_count pieces (-1: nothing is kept), state_piece, state_cell and state_place, the
node, its cell, and its place and radius [m]; and, from three times state_first on, seam_count edges between
them (-1: yet to be looked for), seam and seam_place: border cells, and width and gate [m].

Edges of pieces are pairs of slots, one for each way, at 2k and 2k + 1. head (m,) is the first slot of each
node, following the next, or -1, by rising target; of each slot: target, width, gate (2) and border (2) as of
`NodeGraph`, and made, the number of the turn that made it. around, grouped by zone: the nodes whose edges it
may narrow or close; zone_sign and node_sign: see `navmesh.zones.memo`; kept, kept_place (width and gate) and
kept_border: other edges that came up before. numbers: see `SLOTS`. all_...: the arrays of the surface and the
graph that are kept up to date.
"""

SLOTS, FREE, TURNS = 0, 1, 2
"""Places in `SWITCHES`.numbers: how many slots have ever been in use, the first free pair, turns so far."""
