"""Small levels with obstacles whose frames are known exactly, to measure detection."""

from dataclasses import dataclass

import numpy as np

import navmesh

__all__ = ["KINDS", "Scene", "Truth", "box", "merged", "plate", "random_scene", "turned"]

Mesh = tuple[np.ndarray, np.ndarray]
KINDS = ("jump", "vault", "drop", "gap", "none")
"""Kinds of `random_scene`; "none" holds what must not be tagged."""

_BOX_FACES = np.array(
    "0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7".split(), dtype=np.int64
).reshape(-1, 3)


@dataclass(frozen=True)
class Truth:
    """One obstacle that is really there."""

    affordance: str
    ends: np.ndarray
    """(2, 3) [m], of its edge."""
    normal: np.ndarray
    """(3,) towards the run-up side."""
    height: float
    depth: float | None
    """[m] of a vault or a gap, else None."""


@dataclass(frozen=True)
class Scene:
    """A level and everything in it that has to be found."""

    terrain: navmesh.Terrain
    truths: list[Truth]
    what: str


def plate(x: float, y: float, z: float = 0.0) -> Mesh:
    """A floor without thickness, x by y [m] around the origin at height z."""
    corners = [(-x / 2, -y / 2, z), (x / 2, -y / 2, z), (x / 2, y / 2, z), (-x / 2, y / 2, z)]
    return np.array(corners), np.array([(0, 1, 2), (0, 2, 3)])


def box(x: float, y: float, bottom: float, top: float, at: tuple[float, float] = (0.0, 0.0)) -> Mesh:
    """A closed box, x by y [m] around ``at``, from height ``bottom`` to ``top``."""
    flat = np.array([(-x / 2, -y / 2), (x / 2, -y / 2), (x / 2, y / 2), (-x / 2, y / 2)]) + at
    corners = [np.column_stack((flat, np.full(4, z))) for z in (bottom, top)]
    return np.concatenate(corners), _BOX_FACES


def merged(*meshes: Mesh) -> Mesh:
    """Several meshes as one, without welding anything."""
    shift = np.cumsum([0] + [len(vertices) for vertices, _ in meshes[:-1]])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + by for (_, faces), by in zip(meshes, shift, strict=True)]),
    )


def turned(points: np.ndarray, yaw: float, by: np.ndarray) -> np.ndarray:
    """Points (..., 3) turned by ``yaw`` [rad] about z and then moved ``by`` (3,)."""
    c, s = np.cos(yaw), np.sin(yaw)
    return points @ np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)]).T + by


def _rims(x: float, y: float, z: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """The four rims of a box's top: (ends (2, 3), outward (3,)), the two at right angles to x first."""
    found = []
    for axis, (half, side) in enumerate(((x / 2, y / 2), (y / 2, x / 2))):
        for sign in (1.0, -1.0):
            outward, along = np.zeros(3), np.zeros(3)
            outward[axis], along[1 - axis] = sign, side
            middle = half * outward + np.array([0, 0, z])
            found.append((np.stack((middle - along, middle + along)), outward))
    return found


def random_scene(kind: str, rng: np.random.Generator, max_step: float = 0.2) -> Scene:
    """A level with one obstacle of ``kind`` (see `KINDS`) of random size, place and heading."""
    yaw = float(rng.uniform(-np.pi, np.pi))
    by = np.append(rng.uniform(-50, 50, 2), rng.uniform(-5, 5))
    if rng.random() < 0.2:
        by[:2] += 5000.0
    ground = plate(26.0, 26.0)
    truths: list[Truth] = []
    if kind in ("jump", "drop"):
        x, y = rng.uniform(2.0, 8.0, 2)
        height = float(rng.uniform(max_step + 0.01, 0.699) if kind == "jump" else rng.uniform(0.901, 1.999))
        mesh = merged(ground, box(x, y, -0.2, height))
        for ends, outward in _rims(x, y, height):
            truths.append(Truth(kind, ends, outward if kind == "jump" else -outward, height, None))
        what = f"box {x:.2f} x {y:.2f} x {height:.3f} m"
    elif kind == "vault":
        x, y = rng.uniform(0.05, 0.55), rng.uniform(1.5, 8.0)
        height = float(rng.uniform(0.601, 0.999))
        mesh = merged(ground, box(x, y, -0.2, height))
        truths += [Truth(kind, ends, out, height, x) for ends, out in _rims(x, y, height)[:2]]
        what = f"wall {x:.3f} thick, {y:.2f} long, {height:.3f} m high"
    elif kind == "gap":
        width, y = rng.uniform(0.41, 2.49), rng.uniform(2.0, 8.0)
        rise = float(rng.uniform(-0.15, 0.15))
        x = 6.0
        mesh = merged(
            plate(26.0, 26.0, -4.0),
            box(x, y, -0.5, 0.0, (-(width + x) / 2, 0.0)),
            box(x, y, -0.5, rise, ((width + x) / 2, 0.0)),
        )
        for sign, height, own in ((-1.0, rise, 0.0), (1.0, -rise, rise)):
            ends = np.array([(sign * width / 2, -y / 2, own), (sign * width / 2, y / 2, own)])
            truths.append(Truth(kind, ends, np.array([sign, 0.0, 0.0]), height, width))
        what = f"gap {width:.3f} wide, {y:.2f} long, rising {rise:.3f} m"
    else:
        mesh, what = _nothing(rng, ground, max_step)
    vertices = turned(mesh[0], yaw, by)
    told = [
        Truth(t.affordance, turned(t.ends, yaw, by), turned(t.normal, yaw, np.zeros(3)), t.height, t.depth)
        for t in truths
    ]
    return Scene(navmesh.Terrain.from_arrays(vertices, mesh[1]), told, f"{what}, yaw {np.degrees(yaw):.1f}")


def _nothing(rng: np.random.Generator, ground: Mesh, max_step: float) -> tuple[Mesh, str]:
    """Something that no skill clears: a mesh and what it is."""
    x, y = rng.uniform(2.0, 6.0, 2)
    which = int(rng.integers(6))
    if which == 0:
        height = rng.uniform(0.71, 0.89)
        return merged(ground, box(x, y, -0.2, height)), f"box of {height:.3f} m: between jump and drop"
    if which == 1:
        height = rng.uniform(2.01, 4.0)
        return merged(ground, box(x, y, -0.2, height)), f"box of {height:.3f} m: too high"
    if which == 2:
        height = rng.uniform(0.02, max_step - 0.005)
        return merged(ground, box(x, y, -0.2, height)), f"step of {height:.3f} m: walked over"
    if which == 3:
        height = rng.uniform(0.25, 0.65)
        lid = box(14.0, 14.0, height + rng.uniform(0.8, 1.6), height + 2.5)
        return merged(ground, box(x, y, -0.2, height), lid), f"box of {height:.3f} m under a low ceiling"
    if which == 4:
        height = rng.uniform(1.02, 1.8)
        return merged(ground, box(0.3, y, -0.2, height)), f"wall of {height:.3f} m: too high to vault"
    height = rng.uniform(0.25, 0.65)
    side = rng.uniform(0.5, 0.8)
    ring = [
        box(0.2, y + 2 * side + 0.4, -0.2, 3.0, ((x + 0.2) / 2 + side, 0.0)),
        box(0.2, y + 2 * side + 0.4, -0.2, 3.0, (-(x + 0.2) / 2 - side, 0.0)),
        box(x + 2 * side, 0.2, -0.2, 3.0, (0.0, (y + 0.2) / 2 + side)),
        box(x + 2 * side, 0.2, -0.2, 3.0, (0.0, -(y + 0.2) / 2 - side)),
    ]
    return merged(ground, box(x, y, -0.2, height), *ring), f"box of {height:.3f} m with no room to run up"
