"""The level's own surface as ground for simulated bodies.

    ground = Ground.from_arrays(vertices, faces)
    model = build_person(ground)

The model gets a height-field geom called ``ground`` that only stands for the level: contacts of spheres and
capsules with it come from the level's triangles (`locomotion.ground.collider.contact`), exactly where the
mesh is. Faces are one-sided: a body is pushed out to the side from which the corners run counter-clockwise.
"""

from __future__ import annotations

import hashlib
import math
import weakref
from functools import lru_cache
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.errors import LocomotionError
from locomotion.ground.collider.build import build_triangle_arrays, scaled_arrays
from locomotion.ground.collider.install import MARK, occupy, release
from locomotion.ground.collider.layout import (
    CORNER,
    NX,
    NY,
    NZ,
    OFFSET,
    PER_METRE,
    SIDE,
    SIDE_ROW,
    SIDES_END,
    SOUTH,
    WEST,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["FRICTION", "SLIPPERY", "Ground", "extruded", "height_below", "plane_lookup"]

FRICTION = 0.9
"""Friction of shoes on ordinary ground."""
SLIPPERY = 0.75
"""Friction below which feet slip where a person speeds up or slows down quickly."""
_HOLD = 1.4 * math.sqrt(2.0)
# friction per slope with which a foot still has force to spare, in the worst direction of the pyramid that
# stands for the cone of friction: it holds 1 / sqrt(2) of its coefficient there
_STEEPEST_FRONT, _LOWEST_FRONT = 1.0, 0.05
# slope beyond which the front of a step is not trodden on; [m] of height below which it does not matter
_HARD = (0.999, 0.9999, 0.001, 0.5, 2.0)
# impedance of contacts with steep ground: with the default, hands and feet creep downhill by 3 to 5 cm/s
_USUAL = (0.9, 0.95, 0.001, 0.5, 2.0)  # MuJoCo's impedance of contacts
_TORSIONAL, _ROLLING = 0.005, 0.0001
_MESH_FACES = 200_000  # MuJoCo's renderer draws larger meshes badly; only pictures are cut off


class Ground:
    """A triangle mesh that bodies in MuJoCo can stand on.

    Several grounds may exist in one process. Keep a ground as long as models made with it are stepped:
    without it, their bodies fall through.

    Attributes:
      vertices: (v, 3) float64, faces: (f, 3) int64, as given.
      low, high: (3,) float64, bounds [m].
      digest: hex digest of the mesh.
      friction: coefficient of friction.
      steep: whether floors are too steep for the default friction.
    """

    def __init__(
        self, vertices: NDArray[np.float64], faces: NDArray[np.int64], max_slope: float, max_step: float
    ) -> None:
        self.vertices, self.faces = vertices, faces
        self._rules = max_slope, max_step
        floors = _HOLD * math.tan(max_slope)
        fronts = _HOLD * _steepest_front(vertices, faces, max_slope, max_step)
        self.friction, self.steep = max(FRICTION, floors, fronts), floors > FRICTION
        used = vertices[np.unique(faces)]
        self.low, self.high = used.min(axis=0), used.max(axis=0)
        self._origin = np.ascontiguousarray(0.5 * (self.low + self.high))
        self._arrays = build_triangle_arrays(vertices - self._origin, faces)
        if not len(self._arrays.rows):
            raise LocomotionError("the ground has only degenerate triangles; give at least one with an area")
        self._visible = True
        self._occupy()

    def _occupy(self) -> None:
        self.digest = hashlib.sha256(self.vertices.tobytes() + self.faces.tobytes()).hexdigest()[:16]
        self._number = int(self.digest[:12], 16) | 1  # 48 bits: exact as a float64, never zero
        self._slot, kept = occupy(self._arrays, self._origin, self._number)
        self._kept = kept
        weakref.finalize(self, _release, self._slot, kept)

    def scaled(self, factor: float) -> Ground:
        """The same surface ``factor`` > 0 times as large, made of what is worked out for this one. Pictures
        of MuJoCo do not show it."""
        other = Ground.__new__(Ground)
        vars(other).update(vars(self))
        other.vertices, other._arrays = factor * self.vertices, scaled_arrays(self._arrays, factor)
        other.low, other.high, other._origin = factor * self.low, factor * self.high, factor * self._origin
        other._rules = self._rules[0], factor * self._rules[1]
        other._visible = False
        other._occupy()
        return other

    @classmethod
    def from_arrays(
        cls, vertices: ArrayLike, faces: ArrayLike, *, max_slope: float = 0.0, max_step: float = 0.0
    ) -> Ground:
        """vertices (v, 3) [m], faces (f, 3) indices of corners, counter-clockwise seen from outside.
        max_slope [rad], max_step [m]: steepest floor to walk on and highest step without a skill, as in
        `navmesh.WalkRules`. The ground gets the friction that these require, at least `FRICTION`.

        Raises `LocomotionError` for wrong shapes, coordinates that are not finite, indices out of range, and
        slopes or steps below 0 or too great.
        """
        points = np.ascontiguousarray(vertices, dtype=np.float64)
        triangles = np.asarray(faces)
        if points.ndim != 2 or points.shape[1] != 3:
            raise LocomotionError(f"vertices have the shape {points.shape}; give (v, 3)")
        if triangles.ndim != 2 or triangles.shape[1] != 3 or len(triangles) == 0:
            raise LocomotionError(f"faces have the shape {triangles.shape}; give (f, 3) with f > 0")
        if not np.issubdtype(triangles.dtype, np.integer):
            raise LocomotionError(f"faces are {triangles.dtype}; give integers")
        if not np.isfinite(points).all():
            row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            raise LocomotionError(f"vertex {row} is {points[row]}; give finite coordinates")
        if triangles.min() < 0 or triangles.max() >= len(points):
            raise LocomotionError(f"faces name vertices outside 0 to {len(points) - 1}")
        if not 0.0 <= max_slope < 0.5 * math.pi:
            raise LocomotionError(f"max_slope is {max_slope} rad; give 0 to less than {0.5 * math.pi:.2f}")
        if not 0.0 <= max_step < math.inf:
            raise LocomotionError(f"max_step is {max_step} m; give a finite number from 0 on")
        return cls(points, np.ascontiguousarray(triangles, dtype=np.int64), max_slope, max_step)

    def __reduce__(self) -> tuple[Any, ...]:
        # a copy takes a place of its own among those of its process, or it would lie where another does
        return _copied, (self.vertices, self.faces, *self._rules, self.friction)

    @property
    def arrays(self):
        """The collision kernel's `TriangleArrays`, relative to `origin`."""
        return self._arrays

    @property
    def lookup(self) -> tuple[NDArray[Any], ...]:
        """Lookup table for `locomotion.gaits.walk.footholds.ground_at`."""
        a = self._arrays
        return a.rows, a.cell_start, a.cell_triangles, a.grid, a.shape, self._origin

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) origin [m] of the kernel's coordinates."""
        return self._origin

    def add_to(self, spec: mujoco.MjSpec, visual: bool = True) -> Any:
        """Add the ground to a model's description; returns the geom ``ground`` that stands for it.

        With ``visual`` the mesh is also added as a visible geom (``ground_mesh``). Bodies collide only with
        their spheres and capsules; `check` tells whether a model has others.
        """
        half = 0.5 * (self.high - self.low) + 1.0
        spec.nuser_geom = max(spec.nuser_geom, 3)
        spec.add_hfield(
            name="ground", nrow=2, ncol=2, size=[half[0], half[1], half[2], half[2]],
            userdata=np.zeros(4, np.float32),
        )  # fmt: skip
        user = np.zeros(max(spec.nuser_geom, 3))
        user[:3] = MARK, self._slot, self._number
        geom = spec.worldbody.add_geom(
            name="ground", type=mujoco.mjtGeom.mjGEOM_HFIELD, hfieldname="ground", pos=self._origin,
            contype=1, conaffinity=0, friction=[self.friction, _TORSIONAL, _ROLLING], rgba=[0, 0, 0, 0],
            group=4, userdata=user,
        )  # fmt: skip
        if self.friction > FRICTION:
            geom.solimp, geom.priority = _HARD if self.steep else _usually_hard(self.friction), 1
        if visual and self._visible:
            self._add_visual(spec)
        return geom

    def _add_visual(self, spec: mujoco.MjSpec) -> None:
        triangles = self._arrays.rows[:_MESH_FACES, CORNER : CORNER + 9].reshape(-1, 3)
        spec.add_mesh(
            name="ground", uservert=triangles.reshape(-1).astype(np.float32),
            userface=np.arange(len(triangles), dtype=np.int32),
            inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
        )  # fmt: skip
        spec.worldbody.add_geom(
            name="ground_mesh", type=mujoco.mjtGeom.mjGEOM_MESH, meshname="ground", pos=self._origin,
            contype=0, conaffinity=0, rgba=[0.62, 0.66, 0.62, 1.0], group=1,
        )  # fmt: skip

    def check(self, model: mujoco.MjModel) -> None:
        """Raise `LocomotionError` unless ``model`` stands on this ground with spheres and capsules only."""
        try:
            geom = model.geom("ground").id
        except KeyError:
            raise LocomotionError("the model has no geom called 'ground'; build it with add_to") from None
        if model.nuser_geom < 3 or tuple(model.geom_user[geom, :3]) != (MARK, self._slot, self._number):
            raise LocomotionError("the model was built for another ground or in another process")
        allowed = (int(mujoco.mjtGeom.mjGEOM_SPHERE), int(mujoco.mjtGeom.mjGEOM_CAPSULE))
        for i in range(model.ngeom):
            touches = model.geom_contype[i] & model.geom_conaffinity[geom]
            touches |= model.geom_contype[geom] & model.geom_conaffinity[i]
            if i != geom and touches and model.geom_bodyid[i] and int(model.geom_type[i]) not in allowed:
                raise LocomotionError(
                    f"geom {i} ({model.geom(i).name!r}) is no sphere or capsule: it would fall through"
                )

    def surface_below(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Height and normal of the first upward face at or below each of ``points`` (n, 3).

        Returns z (n,) float64 [m], NaN where nothing is below, and unit normals (n, 3) float64.
        """
        # of another layout the kernel would be compiled once more
        wanted = np.atleast_2d(np.asarray(points, dtype=np.float64, order="C")) - self._origin
        if wanted.shape[1] != 3:
            raise LocomotionError(f"points have the shape {wanted.shape}; give (n, 3)")
        heights, normals = np.full(len(wanted), np.nan), np.full((len(wanted), 3), np.nan)
        a = self._arrays
        _surface_below(a.rows, a.cell_start, a.cell_triangles, a.grid, a.shape, wanted, heights, normals)
        return heights + self._origin[2], normals


def _usually_hard(friction: float) -> tuple[float, ...]:
    """Impedance that makes contacts as stiff as with `FRICTION`: with more friction they soften with its
    square."""
    softer = (FRICTION / friction) ** 2
    least, most = (1.0 / (1.0 + softer * (1.0 / each - 1.0)) for each in _USUAL[:2])
    return (least, most, *_USUAL[2:])


def _steepest_front(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], max_slope: float, max_step: float
) -> float:
    """Slope of the steepest step front that feet land on, 0 if there is none: of the faces that are steeper
    than floors and rise by at most a step over their width."""
    corners = vertices[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(edges[:, 0], edges[:, 1])  # twice its area
    flat, level = np.hypot(normals[:, 0], normals[:, 1]), normals[:, 2]
    facing_up = level > 0.0
    slopes = flat[facing_up] / level[facing_up]
    lengths = np.hypot(edges[facing_up, :, 0], edges[facing_up, :, 1]).max(axis=1)
    heights = flat[facing_up] / lengths  # the slope times the width across the longest edge, seen from above
    trodden = (slopes > math.tan(max_slope)) & (slopes <= _STEEPEST_FRONT)
    trodden &= (heights >= _LOWEST_FRONT) & (heights <= max_step)
    return float(np.max(slopes[trodden], initial=0.0))


@lru_cache(maxsize=1)
def plane_lookup() -> tuple[NDArray[Any], ...]:
    """The endless plane z = 0 (a square of 20 km) as `Ground.lookup` would give it."""
    half = 1e4
    corners = np.array([[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]])
    a = build_triangle_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    return a.rows, a.cell_start, a.cell_triangles, a.grid, a.shape, np.zeros(3)


def _copied(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], slope: float, step: float, friction: float
) -> Ground:
    ground = Ground(vertices, faces, slope, step)
    ground.friction = friction
    return ground


def _release(slot: int, kept: Any) -> None:
    release(slot)
    del kept


def extruded(profile: ArrayLike, half_width: float) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices and faces of the surface over a line ``profile`` (n, 2) of x and z [m], ``half_width`` [m] to
    both sides along y; it faces the line's left."""
    line = np.asarray(profile, dtype=np.float64)
    n = len(line)
    y = np.repeat([-half_width, half_width], n)
    vertices = np.column_stack([np.tile(line[:, 0], 2), y, np.tile(line[:, 1], 2)])
    right, left = np.arange(n - 1), np.arange(n - 1) + n
    faces = np.concatenate(
        [np.column_stack([right, right + 1, left + 1]), np.column_stack([right, left + 1, left])]
    )
    return vertices, faces


@kernel
def height_below(rows, cell_start, cell_triangles, grid, shape, x, y, z):
    """Height of the first upward face at or below (x, y, z), NaN where there is none, and its row or -1."""
    best, which = -np.inf, -1
    fx, fy = (x - grid[WEST]) * grid[PER_METRE], (y - grid[SOUTH]) * grid[PER_METRE]
    if not (fx >= 0.0 and fy >= 0.0 and fx <= shape[0] and fy <= shape[1]):
        return np.nan, which
    cell = min(int(fx), shape[0] - 1) * shape[1] + min(int(fy), shape[1] - 1)
    for i in range(cell_start[cell], cell_start[cell + 1]):
        row = rows[cell_triangles[i]]
        if row[NZ] < 1e-6:
            continue
        h = (row[OFFSET] - row[NX] * x - row[NY] * y) / row[NZ]
        if h > z + 1e-9 or best >= h:
            continue
        inside = True
        for k in range(SIDE, SIDES_END, SIDE_ROW):
            if row[k] * x + row[k + 1] * y + row[k + 2] * h - row[k + 3] > 1e-6:
                inside = False
                break
        if inside:
            best, which = h, cell_triangles[i]
    return (best if which >= 0 else np.nan), which


@allocating_kernel
def _surface_below(rows, cell_start, cell_triangles, grid, shape, points, heights, normals):
    for p in range(len(points)):
        x, y, z = points[p]
        heights[p], t = height_below(rows, cell_start, cell_triangles, grid, shape, x, y, z)
        if t >= 0:
            normals[p] = rows[t, NX:OFFSET]
