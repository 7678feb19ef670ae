"""The contacts of a body, as kernels read them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["contacts_of"]


def contacts_of(data: mujoco.MjData) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Geoms (n, 2) and address (n,) of its forces in ``data.efc_force``, -1 for none, of each of the
    ``data.ncon`` contacts of ``data``. Rows may follow that mean nothing.

    They are never contiguous. MuJoCo's are not either, since they are columns of a table, but where there is
    at most one contact they count as such, and Numba would compile every kernel for both.
    """
    pairs, addresses, count = data.contact.geom, data.contact.efc_address, data.ncon
    if count > 1:
        return pairs, addresses
    table = np.zeros((2, 4), np.int32)
    table[:count, :2], table[:count, 2] = pairs, addresses
    return table[:, :2], table[:, 2]
