"""USD (.usd, .usda, .usdc, .usdz), through usd-core (the extra "usd"): axes and units are the stage's.

Geometry of purpose default and render that is visible at the earliest time, instances and point instances in
their places, skinned meshes in the pose of that time. Subdivision surfaces are taken as their cages.
"""

import os
from collections.abc import Callable
from typing import Any

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFile, MeshFileError, flattened, missing_extra
from navmesh.meshfiles.polygons import CrossingPolygon, triangulate
from surefoot.files.inputs import note_input

__all__ = ["read_usd"]

_Parts = list[tuple[np.ndarray, np.ndarray]]
_REFUSED = ("NurbsPatch", "TetMesh", "Cylinder_1", "Capsule_1")
_SIDES = 32


def read_usd(path: str | os.PathLike[str]) -> MeshFile:
    """The surfaces of a stage as triangles. Raises `MeshFileError`, also where a file that the stage refers
    to is missing."""
    try:
        from pxr import Tf, Usd, UsdGeom
    except ImportError:
        raise missing_extra(
            path, "USD is read by the package usd-core", "usd", "export the level as glTF"
        ) from None
    try:
        stage = Usd.Stage.Open(os.fspath(path))
    except Tf.ErrorException as error:
        raise MeshFileError(path, "", f"USD says: {str(error).rpartition(' : ')[2].strip()}") from None
    for layer in stage.GetUsedLayers():
        if layer.realPath:
            note_input(layer.realPath)
    broken = stage.GetCompositionErrors()
    if broken:
        raise MeshFileError(path, "", f"its stage is not whole: {broken[0]}")
    parts = _Reader(path, stage).parts(stage.GetPseudoRoot())
    vertices, faces = flattened(parts)
    return MeshFile(
        vertices, faces, str(UsdGeom.GetStageUpAxis(stage)).lower(), UsdGeom.GetStageMetersPerUnit(stage)
    )


class _Reader:
    """Walks through a stage. Matrices (4, 4) are USD's: a point (x, y, z, 1) stands to their left."""

    def __init__(self, path: str | os.PathLike[str], stage: Any) -> None:
        from pxr import Usd

        self._path, self._stage = path, stage
        self._time = Usd.TimeCode.EarliestTime()
        self._children = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
        self._pose()

    def parts(self, root: Any) -> _Parts:
        """The surfaces at and below a prim, in the space of the prim above it."""
        from pxr import UsdGeom

        found: _Parts = []
        todo: list[tuple[Any, np.ndarray]] = [(root, np.eye(4))]
        while todo:
            prim, place = todo.pop()
            imageable = UsdGeom.Imageable(prim)
            if imageable and imageable.GetVisibilityAttr().Get(self._time) == UsdGeom.Tokens.invisible:
                continue
            transform = UsdGeom.Xformable(prim)
            if transform:
                own = np.array(transform.GetLocalTransformation(self._time))
                place = own if transform.GetResetXformStack() else own @ place
            if prim.IsA(UsdGeom.PointInstancer):
                found += self._instances(UsdGeom.PointInstancer(prim), place)
                continue  # what lies below are the things to be placed
            if prim.IsA(UsdGeom.Gprim) and imageable.ComputePurpose() in ("default", "render"):
                found += [_moved(part, place) for part in self._surface(prim)]
            todo += [(child, place) for child in reversed(prim.GetFilteredChildren(self._children))]
        return found

    def _pose(self) -> None:
        """Skinned meshes get the points of their pose; only in memory."""
        from pxr import Gf, UsdSkel

        if not any(prim.IsA(UsdSkel.Root) for prim in self._stage.Traverse()):
            return
        start = self._stage.GetStartTimeCode()
        times = (start, start) if self._stage.HasAuthoredTimeCodeRange() else (-np.inf, np.inf)
        self._stage.SetEditTarget(self._stage.GetSessionLayer())
        if not UsdSkel.BakeSkinning(self._stage.Traverse(), Gf.Interval(*times)):
            raise MeshFileError(
                self._path, "", "USD cannot pose its skinned meshes; export them as they stand"
            )

    def _instances(self, instancer: Any, place: np.ndarray) -> _Parts:
        time = self._time
        which = np.array(instancer.GetProtoIndicesAttr().Get(time) or [], dtype=np.int64)
        transforms = instancer.ComputeInstanceTransformsAtTime(
            time, time, type(instancer).ExcludeProtoXform, type(instancer).IgnoreMask
        )
        mask = instancer.ComputeMaskAtTime(time)
        targets = instancer.GetPrototypesRel().GetForwardedTargets()
        name = str(instancer.GetPath())
        if len(transforms) != len(which) or (
            len(which) and not 0 <= which.min() <= which.max() < len(targets)
        ):
            raise MeshFileError(self._path, name, "its positions and protoIndices do not fit its prototypes")
        shapes: dict[int, _Parts] = {}
        found: _Parts = []
        for number, (index, transform) in enumerate(zip(which.tolist(), transforms, strict=True)):
            if mask and not mask[number]:
                continue
            if index not in shapes:
                prototype = self._stage.GetPrimAtPath(targets[index])
                if not prototype:
                    raise MeshFileError(self._path, name, f"there is no prototype {targets[index]}")
                shapes[index] = self.parts(prototype)
            found += [_moved(part, np.array(transform) @ place) for part in shapes[index]]
        return found

    def _surface(self, prim: Any) -> _Parts:
        """The triangles of a prim that has a surface, in its own space."""
        from pxr import UsdGeom

        kind = prim.GetTypeName()
        if kind in _REFUSED:
            problem = f"is a {kind}, which is not read; convert it to a Mesh"
            raise MeshFileError(self._path, str(prim.GetPath()), problem)
        if prim.IsA(UsdGeom.Mesh):
            vertices, faces = self._mesh(UsdGeom.Mesh(prim))
        elif kind in _SOLIDS:
            vertices, faces = _SOLIDS[kind](lambda name: prim.GetAttribute(name).Get(self._time))
        else:
            return []  # points, curves and volumes
        left = UsdGeom.Gprim(prim).GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded
        return [(vertices, faces[:, :: -1 if left else 1])]

    def _mesh(self, mesh: Any) -> tuple[np.ndarray, np.ndarray]:
        where = str(mesh.GetPath())
        points = np.array(mesh.GetPointsAttr().Get(self._time) or [], dtype=np.float64).reshape(-1, 3)
        sizes = np.array(mesh.GetFaceVertexCountsAttr().Get(self._time) or [], dtype=np.int64)
        corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(self._time) or [], dtype=np.int64)
        if (sizes < 0).any() or sizes.sum() != len(corners):
            raise MeshFileError(
                self._path, where, "faceVertexCounts and faceVertexIndices do not fit each other"
            )
        if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
            raise MeshFileError(self._path, where, f"faceVertexIndices beyond its {len(points)} points")
        if not np.isfinite(points).all():
            raise MeshFileError(self._path, where, "a point is not finite")
        kept = np.ones(len(sizes), dtype=bool)
        holes = np.array(mesh.GetHoleIndicesAttr().Get(self._time) or [], dtype=np.int64)
        kept[holes[(holes >= 0) & (holes < len(sizes))]] = False
        try:
            return points, triangulate(points, corners[np.repeat(kept, sizes)], sizes[kept])
        except CrossingPolygon as error:
            number = int(np.flatnonzero(kept)[error.index])
            raise MeshFileError(self._path, f"{where}, face {number}", str(error)) from None


def _moved(part: tuple[np.ndarray, np.ndarray], place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A part in another place; mirrored, it is seen from its other side."""
    vertices, faces = part
    turned = np.linalg.det(place[:3, :3]) < 0.0
    return vertices @ place[:3, :3] + place[3, :3], faces[:, :: -1 if turned else 1]


_Get = Callable[[str], Any]


def _made(mesh: Any, axis: str = "Z") -> tuple[np.ndarray, np.ndarray]:
    """A trimesh, made along Z, along another axis."""
    turned = {"X": (2, 0, 1), "Y": (1, 2, 0), "Z": (0, 1, 2)}[axis]
    return np.array(mesh.vertices)[:, turned], np.array(mesh.faces, dtype=np.int64)


def _cube(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    return _made(trimesh.creation.box([get("size")] * 3))


def _plane(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    x, y = get("width") / 2.0, get("length") / 2.0
    axis = get("axis")
    if axis == "X":  # its width lies along z, its length along y
        corners = [(0.0, -y, x), (0.0, -y, -x), (0.0, y, -x), (0.0, y, x)]
    elif axis == "Y":
        corners = [(-x, 0.0, y), (x, 0.0, y), (x, 0.0, -y), (-x, 0.0, -y)]
    else:
        corners = [(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)]
    return np.array(corners), np.array([[0, 1, 2], [0, 2, 3]])


def _sphere(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    return _made(trimesh.creation.uv_sphere(get("radius"), count=[_SIDES // 2, _SIDES]))


def _cylinder(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    return _made(trimesh.creation.cylinder(get("radius"), get("height"), sections=_SIDES), get("axis"))


def _cone(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    made = trimesh.creation.cone(get("radius"), get("height"), sections=_SIDES)
    made.apply_translation((0.0, 0.0, -get("height") / 2.0))  # USD's stands around its middle
    return _made(made, get("axis"))


def _capsule(get: _Get) -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    made = trimesh.creation.capsule(get("height"), get("radius"), count=[_SIDES, _SIDES])
    made.apply_translation((0.0, 0.0, -made.bounds.mean(axis=0)[2]))
    return _made(made, get("axis"))


_SOLIDS = {
    "Cube": _cube, "Plane": _plane, "Sphere": _sphere, "Cylinder": _cylinder, "Cone": _cone,
    "Capsule": _capsule,
}  # fmt: skip
