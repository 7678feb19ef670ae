"""USD: units and axes of the stage, instances, purposes, skins; and what helps where usd-core is missing."""

import itertools
import re
import sys

import numpy as np
import pytest

from navmesh import NavmeshError, Terrain
from tests.navmesh.meshfiles.mesh_measures import area, upward_area, volume

FLOOR = [[0, 0, 0], [4, 4, 0]]
SQUARE = [(0, 0, 0), (4, 0, 0), (4, 0, -4), (0, 0, -4)]
L_SHAPE = [(4, 0, 0), (4, 0, -1), (1, 0, -1), (1, 0, -4), (0, 0, -4), (0, 0, 0)]


class Level:
    """A stage that grows."""

    def __init__(self, folder, name="level.usda", up="Y", unit=1.0):
        pytest.importorskip("pxr", reason="needs the extra usd")
        from pxr import Usd, UsdGeom

        self.path = folder / name
        self.stage = Usd.Stage.CreateNew(str(self.path))
        UsdGeom.SetStageUpAxis(self.stage, up)
        UsdGeom.SetStageMetersPerUnit(self.stage, unit)

    def mesh(self, path, points=SQUARE, sizes=None, corners=None):
        from pxr import UsdGeom

        mesh = UsdGeom.Mesh.Define(self.stage, path)
        mesh.CreatePointsAttr(points)
        mesh.CreateFaceVertexCountsAttr(sizes or [len(points)])
        mesh.CreateFaceVertexIndicesAttr(corners or list(range(len(points))))
        return mesh

    def load(self, **options):
        self.stage.GetRootLayer().Save()
        return Terrain.load(self.path, **options)


@pytest.fixture
def level(tmp_path):
    return Level(tmp_path)


@pytest.mark.parametrize("name", ["level.usda", "level.usdc", "level.usd", "level.usdz"])
def test_axes_and_units_are_the_stage_s(tmp_path, name):
    made = Level(tmp_path, "made.usdc" if name.endswith("z") else name)
    made.mesh("/floor")
    made.stage.GetRootLayer().Save()
    if name.endswith("z"):
        from pxr import UsdUtils

        UsdUtils.CreateNewUsdzPackage(str(made.path), str(tmp_path / name))
    terrain = Terrain.load(tmp_path / name)
    np.testing.assert_allclose(terrain.bounds, FLOOR)
    assert upward_area(terrain) == pytest.approx(16)


def test_centimetres_and_z_up(tmp_path):
    level = Level(tmp_path, up="Z", unit=0.01)
    level.mesh("/floor", [(100 * x, -100 * z, 0) for x, _, z in SQUARE])
    np.testing.assert_allclose(level.load().bounds, FLOOR, atol=1e-9)
    np.testing.assert_allclose(level.load(up="y", scale=1.0).bounds, [[0, 0, 0], [400, 0, 400]])


def test_concave_faces_holes_and_orientation(level):
    from pxr import UsdGeom

    level.mesh("/l", L_SHAPE)
    assert upward_area(level.load()) == pytest.approx(7)
    holed = level.mesh("/holed", [*SQUARE, (9, 9, 9)], [4, 3], [0, 1, 2, 3, 0, 1, 4])
    holed.CreateHoleIndicesAttr([1])
    assert area(level.load()) == pytest.approx(7 + 16)
    holed.CreateOrientationAttr(UsdGeom.Tokens.leftHanded)
    assert upward_area(level.load()) == pytest.approx(7 - 16)


def test_transforms(level):
    from pxr import UsdGeom

    UsdGeom.Xform.Define(level.stage, "/a").AddTranslateOp().Set((10, 0, 0))
    level.mesh("/a/mirrored").AddScaleOp().Set((-2, 1, 1))
    free = level.mesh("/a/free")
    free.AddTranslateOp().Set((0, 7, 0))
    free.SetResetXformStack(True)
    terrain = level.load()
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 0], [10, 4, 7]])
    assert upward_area(terrain) == pytest.approx(32 + 16)


def test_instances(level):
    from pxr import UsdGeom

    level.stage.CreateClassPrim("/tile")
    level.mesh("/tile/floor")
    for k in range(3):
        tile = level.stage.DefinePrim(f"/tile{k}", "Xform")
        tile.GetReferences().AddInternalReference("/tile")
        tile.SetInstanceable(True)
        UsdGeom.Xformable(tile).AddTranslateOp().Set((10 * k, 0, 0))
    terrain = level.load()
    assert area(terrain) == pytest.approx(48) and terrain.bounds[1, 0] == pytest.approx(24)


def test_point_instances(level):
    from pxr import Gf, UsdGeom

    instancer = UsdGeom.PointInstancer.Define(level.stage, "/many")
    level.mesh("/many/shapes/floor").AddTranslateOp().Set((0, 1, 0))
    level.mesh("/many/shapes/l", L_SHAPE)
    instancer.CreatePrototypesRel().SetTargets(["/many/shapes/floor", "/many/shapes/l"])
    instancer.CreateProtoIndicesAttr([0, 1, 0, 1])
    instancer.CreatePositionsAttr([(0, 0, 0), (10, 0, 0), (20, 0, 0), (99, 0, 0)])
    instancer.CreateScalesAttr([(1, 1, 1), (1, 1, 1), (2, 2, 2), (1, 1, 1)])
    quarter = Gf.Quath(0.7071, 0, 0.7071, 0)  # about Y: x to -z
    instancer.CreateOrientationsAttr([Gf.Quath(1), quarter, Gf.Quath(1), Gf.Quath(1)])
    instancer.AddTranslateOp().Set((0, 5, 0))
    instancer.InvisId(3, 0)
    terrain = level.load()
    assert upward_area(terrain) == pytest.approx(16 + 7 + 64, rel=1e-3)
    np.testing.assert_allclose(terrain.bounds, [[0, 0, 5], [28, 8, 7]], atol=0.01)


def test_what_is_not_to_be_seen_is_left_out(level):
    level.mesh("/floor")
    level.mesh("/hidden", [(x + 100, y, z) for x, y, z in SQUARE]).MakeInvisible()
    level.mesh("/guide", [(x + 200, y, z) for x, y, z in SQUARE]).CreatePurposeAttr("guide")
    level.stage.DefinePrim("/points", "Points")
    level.stage.DefinePrim("/hair", "BasisCurves")
    np.testing.assert_allclose(level.load().bounds, FLOOR)


@pytest.mark.parametrize(
    ("kind", "height", "cubic_metres"),
    [
        ("Cube", 2, 8.0),
        ("Sphere", 2, 4 / 3 * np.pi),
        ("Cylinder", 2, 2 * np.pi),
        ("Cone", 2, 2 / 3 * np.pi),
        ("Capsule", 2, np.pi / 4 + np.pi / 6),
    ],
)
@pytest.mark.parametrize("axis", "XYZ")
def test_solids(level, kind, height, cubic_metres, axis):
    prim = level.stage.DefinePrim("/solid", kind)
    if prim.HasAttribute("axis"):
        prim.GetAttribute("axis").Set(axis)
    terrain = level.load(up="z")
    assert volume(terrain) == pytest.approx(cubic_metres, rel=0.02)
    np.testing.assert_allclose(terrain.bounds[0], -terrain.bounds[1], atol=1e-9)
    assert np.ptp(terrain.bounds, axis=0).max() == pytest.approx(height)


@pytest.mark.parametrize(("axis", "sizes"), [("X", (0, 6, 2)), ("Y", (2, 0, 6)), ("Z", (2, 6, 0))])
def test_planes(level, axis, sizes):
    plane = level.stage.DefinePrim("/plane", "Plane")
    for name, value in (("axis", axis), ("width", 2.0), ("length", 6.0)):
        plane.GetAttribute(name).Set(value)
    assert np.ptp(level.load(up="z").bounds, axis=0).tolist() == list(sizes)


@pytest.mark.parametrize(
    ("animated", "height"), [("not", 1), ("still", 2), ("moving", 3), ("without range", 3)]
)
def test_skins_in_their_first_pose(level, animated, height):
    from pxr import Gf, UsdSkel

    UsdSkel.Root.Define(level.stage, "/figure")
    skeleton = UsdSkel.Skeleton.Define(level.stage, "/figure/bones")
    moved = Gf.Matrix4d(1).SetTranslate((0, 1, 0))
    skeleton.CreateJointsAttr(["a", "a/b"])
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1)] * 2)
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1), moved])
    binding = UsdSkel.BindingAPI.Apply(level.mesh("/figure/floor").GetPrim())
    binding.CreateSkeletonRel().SetTargets(["/figure/bones"])
    binding.CreateJointIndicesPrimvar(False, 1).Set([1, 1, 1, 1])
    binding.CreateJointWeightsPrimvar(False, 1).Set([1.0, 1.0, 1.0, 1.0])
    if animated != "not":
        motion = UsdSkel.Animation.Define(level.stage, "/figure/motion")
        motion.CreateJointsAttr(["a", "a/b"])
        motion.CreateRotationsAttr([Gf.Quatf(1)] * 2)
        motion.CreateScalesAttr([Gf.Vec3h(1, 1, 1)] * 2)
        times = [()] if animated == "still" else [(1.0,), (24.0,)]
        for at, up in zip(times, [2] if animated == "still" else [3, 9], strict=True):
            motion.CreateTranslationsAttr().Set([(0, 0, 0), (0, up, 0)], *at)
        if animated == "moving":
            level.stage.SetStartTimeCode(1)
            level.stage.SetEndTimeCode(24)
        UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets(["/figure/motion"])
    terrain = level.load()
    np.testing.assert_allclose(terrain.bounds, [[0, 0, height], [4, 4, height]], atol=1e-6)
    assert "points.timeSamples" not in level.path.read_text()


def test_points_that_move_are_taken_as_they_begin(level):
    from pxr import UsdGeom

    mesh = UsdGeom.Mesh(level.mesh("/floor"))
    mesh.GetPointsAttr().Clear()
    for time, y in ((1.0, 2.0), (24.0, 9.0)):
        mesh.GetPointsAttr().Set([(x, y, z) for x, _, z in SQUARE], time)
    np.testing.assert_allclose(level.load().bounds, [[0, 0, 2], [4, 4, 2]])


def test_what_is_wrong(level):
    mesh = level.mesh("/floor")
    count = itertools.count()

    def refused(says):
        with pytest.raises(NavmeshError, match=rf"level\.usda: .*{re.escape(says)}"):
            level.load()
        next(count)

    mesh.GetFaceVertexCountsAttr().Set([3])
    refused("/floor: faceVertexCounts and faceVertexIndices do not fit")
    mesh.GetFaceVertexCountsAttr().Set([4])
    mesh.GetFaceVertexIndicesAttr().Set([0, 1, 2, 4])
    refused("/floor: faceVertexIndices beyond its 4 points")
    mesh.GetFaceVertexIndicesAttr().Set([0, 2, 1, 3])
    refused("/floor, face 0: the outline of the polygon crosses itself")
    mesh.GetFaceVertexIndicesAttr().Set([0, 1, 2, 3])
    mesh.GetPointsAttr().Set([(0, float("nan"), 0), *SQUARE[1:]])
    refused("/floor: a point is not finite")
    mesh.GetPointsAttr().Set(SQUARE)
    patch = level.stage.DefinePrim("/patch", "NurbsPatch")
    refused("/patch: is a NurbsPatch, which is not read; convert it to a Mesh")
    level.stage.RemovePrim(patch.GetPath())
    level.stage.DefinePrim("/other").GetReferences().AddReference("./missing.usda")
    refused("its stage is not whole")
    level.stage.RemovePrim("/other")
    many = level.stage.DefinePrim("/many", "PointInstancer")
    many.GetAttribute("protoIndices").Set([3])
    many.GetAttribute("positions").Set([(0, 0, 0)])
    refused("/many: its positions and protoIndices do not fit its prototypes")
    assert next(count) == 7


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("level.usda", b'#usda 1.0\ndef Mesh "floor" {'),
        ("level.usdc", b"PXR-USDC" + b"\0" * 50),
        ("level.usd", b"x"),
    ],
)
def test_damaged_files(tmp_path, name, content):
    pytest.importorskip("pxr", reason="needs the extra usd")
    (tmp_path / name).write_bytes(content)
    with pytest.raises(NavmeshError, match=rf"{re.escape(name)}: cannot be read as a mesh: USD says"):
        Terrain.load(tmp_path / name)


def test_without_usd_core(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    (tmp_path / "level.usd").write_bytes(b"x")
    with pytest.raises(
        NavmeshError, match=re.escape("pip install -e '.[usd]'") + ".*export the level as glTF"
    ):
        Terrain.load(tmp_path / "level.usd")
