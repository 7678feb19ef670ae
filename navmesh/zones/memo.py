"""Results that come up again when zones are blocked and opened by turns, kept by what they depend on.

A *sign* of a node is a number that says which of the zones near it are blocked now. What is between two nodes
follows from them and their signs. There are two places for each of these; what comes later takes one of them.
"""

import numpy as np

from surefoot.kernels import kernel

__all__ = ["MIX", "nothing_kept", "place_of", "sign_of"]

MIX = -7046029254386353131  # odd, of 64 bits, half of them set


def nothing_kept(places: int) -> np.ndarray:
    """(p, 2) int64: keys of at least so many ``places``, a power of two."""
    return np.full((1 << max(int(places) - 1, 1).bit_length(), 2), -1, np.int64)


@kernel
def sign_of(switches, node):
    """The sign of a node, or of the disc that it is a piece of."""
    piece = node - switches.first_piece
    return switches.node_sign[node if piece < 0 else switches.whole[switches.row_user[piece]]]


@kernel
def place_of(kept, key, sign):
    """Where in ``kept`` the result of ``key``, at least 0, and ``sign`` is or goes, and whether it is
    there: one of two places side by side."""
    mixed = (key * MIX) ^ sign
    mixed ^= mixed >> 29
    at = (mixed * MIX >> 20) & (kept.shape[0] - 1)
    beside = at ^ 1
    if kept[at, 0] == key and kept[at, 1] == sign:
        return at, True
    if kept[beside, 0] == key and kept[beside, 1] == sign:
        return beside, True
    return (at if kept[at, 0] < 0 else beside), False
