"""Install the triangle collider in MuJoCo, behind marked height-field geoms.

MuJoCo's table of collision functions belongs to the process. Ours replaces the two entries for a height field
with a sphere and with a capsule, checks the geom's user data, and passes height fields without our mark to
the original function; all other geoms are unaffected. A marked geom names a slot and the digest of the ground
that must be in it. A model whose ground has been released, or that comes from another process, therefore
touches nothing rather than a wrong ground.
"""

from __future__ import annotations

import ctypes
import threading
from pathlib import Path
from typing import Any

import llvmlite.binding
import mujoco
import numpy as np
from llvmlite import ir
from numba import carray, types
from numba.extending import intrinsic

from locomotion.errors import LocomotionError
from locomotion.ground.collider.build import TriangleArrays
from locomotion.ground.collider.contact import (
    CANDIDATE,
    MAX_CANDIDATES,
    NORMAL,
    POSITION,
    TANGENT,
    capsule_contacts,
)
from locomotion.ground.collider.layout import FLAGS, ROW
from surefoot.kernels import allocating_kernel, cfunc

__all__ = ["MARK", "occupy", "release"]

#: user_data[0] of a geom that stands for a ground; [1] is its slot, [2] its digest.
MARK = 5.0e15 + 2012.0
SLOTS = 1024
CAPSULE = int(mujoco.mjtGeom.mjGEOM_CAPSULE)
SYMBOL = "surefoot_ground_table"
HEADER = 32
_CHUNK = 512  # [bytes] searched at a time; many other fields follow those searched for

# the process-wide table: 0-5 offsets in mjModel and mjData, 6-7 original functions, then digest and
# header address of each slot; compiled code finds it through a linker symbol, which survives caching
_table = np.zeros(8 + 2 * SLOTS, np.int64)
_cell = np.array([_table.ctypes.data], np.int64)
llvmlite.binding.add_symbol(SYMBOL, _cell.ctypes.data)
_lock = threading.Lock()
_installed: list[Any] = []


def _load_table_address(typingctx):
    def codegen(context, builder, signature, args):
        return builder.load(context.get_c_value(builder, context.get_value_type(types.int64), SYMBOL))

    return types.int64(), codegen


def _pointer_to(dtype) -> Any:
    def cast(typingctx, address):
        def codegen(context, builder, signature, args):
            return builder.inttoptr(args[0], context.get_value_type(types.CPointer(dtype)))

        return types.CPointer(dtype)(types.int64), codegen

    return intrinsic(cast)


_as_float64 = _pointer_to(types.float64)
_as_int64 = _pointer_to(types.int64)
_as_int32 = _pointer_to(types.int32)


def _call_function(typingctx, function, model, data, contacts, g1, g2, margin):
    """Call the C collision function at an address."""

    def codegen(context, builder, signature, args):
        kinds = [context.get_value_type(a) for a in signature.args[1:]]
        pointer = ir.FunctionType(ir.IntType(32), kinds).as_pointer()
        return builder.call(builder.inttoptr(args[0], pointer), args[1:])

    i64, i32 = types.int64, types.int32
    return i32(i64, i64, i64, i64, i32, i32, types.float64), codegen


_table_address: Any = intrinsic(_load_table_address)
_call: Any = intrinsic(_call_function)


@allocating_kernel
def _collide(table, model, data, contacts, g1, g2, margin, capsule):
    user_width = carray(_as_int64(model + table[0]), (1,))[0]
    slot = -1
    if user_width >= 3:
        pointers = carray(_as_int64(model + table[1]), (1,))
        user = carray(_as_float64(pointers[0] + 8 * user_width * g1), (3,))
        if user[0] == MARK:
            slot = int(user[1])
            if slot < 0 or slot >= SLOTS or float(table[8 + 2 * slot]) != user[2]:
                return types.int32(0)
    if slot < 0:
        return _call(table[6 + capsule], model, data, contacts, g1, g2, margin)
    h = carray(_as_int64(table[9 + 2 * slot]), (HEADER,))
    rows = carray(_as_float64(h[0]), (h[9], ROW))
    flags = carray(_as_int32(h[1]), (h[9], FLAGS))
    vertex_start = carray(_as_int32(h[2]), (h[10],))
    vertex_edges = carray(_as_float64(h[3]), (h[11], 3))
    cell_start = carray(_as_int32(h[4]), (h[12] + 1,))
    cell_triangles = carray(_as_int32(h[5]), (h[13],))
    cell_range = carray(_as_float64(h[6]), (h[12], 2))
    grid = carray(_as_float64(h[7]), (4,))
    shape = carray(_as_int32(h[8]), (2,))
    origin = carray(_as_float64(h[14]), (3,))
    size = carray(_as_float64(carray(_as_int64(model + table[2]), (1,))[0] + 24 * g2), (3,))
    position = carray(_as_float64(carray(_as_int64(data + table[3]), (1,))[0] + 24 * g2), (3,))
    x, y, z = position[0] - origin[0], position[1] - origin[1], position[2] - origin[2]
    ux, uy, uz, half = 0.0, 0.0, 0.0, 0.0
    if capsule:
        matrix = carray(_as_float64(carray(_as_int64(data + table[4]), (1,))[0] + 72 * g2), (9,))
        ux, uy, uz, half = matrix[2], matrix[5], matrix[8], size[1]
    dx, dy, dz = half * ux, half * uy, half * uz
    out = carray(_as_float64(contacts), (MAX_CANDIDATES, CANDIDATE))
    count = capsule_contacts(
        rows, flags, vertex_start, vertex_edges, cell_start, cell_triangles, cell_range, grid, shape,
        x + dx, y + dy, z + dz, x - dx, y - dy, z - dz, size[0], margin, out,
    )  # fmt: skip
    for i in range(count):
        for k in range(3):
            out[i, POSITION + k] += origin[k]
        # first tangent along the axis, as MuJoCo has it on a plane; zero: it chooses one
        upright = abs(ux * out[i, NORMAL] + uy * out[i, NORMAL + 1] + uz * out[i, NORMAL + 2]) > 0.99
        out[i, TANGENT] = 0.0 if upright else ux
        out[i, TANGENT + 1] = 0.0 if upright else uy
        out[i, TANGENT + 2] = 0.0 if upright else uz
    return types.int32(count)


_signature = types.int32(types.int64, types.int64, types.int64, types.int32, types.int32, types.float64)


# one function for both kinds: a second one would double the loading time at every start
def _round_ground(model, data, contacts, g1, g2, margin):
    table = carray(_as_int64(_table_address()), (8 + 2 * SLOTS,))
    kind = carray(_as_int32(carray(_as_int64(model + table[5]), (1,))[0] + 4 * g2), (1,))[0]
    return _collide(table, model, data, contacts, g1, g2, margin, int(kind == CAPSULE))


def occupy(arrays: TriangleArrays, origin: np.ndarray, digest: int) -> tuple[int, Any]:
    """Register a ground in the table; returns its slot and the objects to keep alive while the slot is
    used."""
    with _lock:
        _install()
        free = np.flatnonzero(_table[8::2] == 0)
        if not len(free):
            raise LocomotionError(f"more than {SLOTS} grounds at once in one process")
        slot = int(free[0])
        header = np.zeros(HEADER, np.int64)
        parts = (
            arrays.rows, arrays.flags, arrays.vertex_start, arrays.vertex_edges, arrays.cell_start,
            arrays.cell_triangles, arrays.cell_range, arrays.grid, arrays.shape,
        )  # fmt: skip
        for i, part in enumerate(parts):
            assert part.flags.c_contiguous
            header[i] = part.ctypes.data
        header[9:14] = (
            len(arrays.rows), len(arrays.vertex_start), len(arrays.vertex_edges),
            len(arrays.cell_range), len(arrays.cell_triangles),
        )  # fmt: skip
        header[14] = origin.ctypes.data
        _table[9 + 2 * slot] = header.ctypes.data
        _table[8 + 2 * slot] = digest
        return slot, (header, parts, origin)


def release(slot: int) -> None:
    """Free a slot; models that still use it touch nothing from now on."""
    with _lock:
        _table[8 + 2 * slot] = 0


def _install() -> None:
    """Register the two functions with MuJoCo, once per process."""
    if _installed:
        return
    model, data = _layout_probe()
    _table[0] = 8 * mujoco.MjModel._size_fields.index("nuser_geom")
    _table[1] = _find(model, model.geom_user)
    _table[2] = _find(model, model.geom_size)
    _table[3] = _find(data, data.geom_xpos)
    _table[4] = _find(data, data.geom_xmat)
    _table[5] = _find(model, model.geom_type)
    width = ctypes.c_int64.from_address(model._address + int(_table[0])).value
    if width != model.nuser_geom:
        raise LocomotionError(f"MuJoCo {mujoco.__version__} keeps its sizes elsewhere; use version 4.0")
    # created here and not on import: compiling takes ten seconds the first time
    round_ground = cfunc(_signature)(_round_ground)
    library = ctypes.CDLL(str(_library()))
    kinds = int(mujoco.mjtGeom.mjGEOM_SDF) + 1
    functions = (ctypes.c_void_p * (kinds * kinds)).in_dll(library, "mjCOLLISIONFUNC")
    row = int(mujoco.mjtGeom.mjGEOM_HFIELD) * kinds
    for i, kind in enumerate((int(mujoco.mjtGeom.mjGEOM_SPHERE), CAPSULE)):
        _table[6 + i] = functions[row + kind]
        functions[row + kind] = round_ground.address
    _installed.append((library, functions, round_ground))


def _layout_probe() -> tuple[Any, Any]:
    model = mujoco.MjModel.from_xml_string(
        "<mujoco><size nuser_geom='13'/><worldbody><body><joint/><geom size='1' user='1'/>"
        "<geom size='2' pos='0 0 4'/></body></worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def _find(owner: Any, array: np.ndarray) -> int:
    """Offset [bytes] of the pointer to `array` within MuJoCo's structure `owner`."""
    for offset in range(0, 1 << 20, _CHUNK):
        words = (ctypes.c_int64 * (_CHUNK // 8)).from_address(owner._address + offset)
        found = np.flatnonzero(np.ctypeslib.as_array(words) == array.ctypes.data)
        if len(found):
            return offset + 8 * int(found[0])
    raise LocomotionError(f"MuJoCo {mujoco.__version__} keeps its arrays elsewhere; use version 4.0")


def _library() -> Path:
    """MuJoCo's shared library, as the Python package loaded it."""
    folder = Path(str(mujoco.__file__)).parent
    for pattern in ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll"):
        found = sorted(folder.glob(pattern))
        if found:
            return found[0]
    raise LocomotionError(f"no MuJoCo library in {folder}")
