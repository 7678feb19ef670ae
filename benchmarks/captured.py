"""Captured strides of walking and running people, from the shared data. No curves of arms are published at
several speeds: theirs are compared with these.

Each is about one stride of one person: ``mass/*.bvh`` (Apache-2.0), and ``humanoid3d/*.txt`` of pybullet.
None of them was used in learning. They are put on the person (`locomotion.clips.retargeting`), so that angles
mean the same. Recordings do not end where they began (``mass/run.bvh`` lacks the last frames of its stride):
a periodic curve is fitted to both sides, half a cycle apart, with the period that fits thighs and knees best.
"""

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from benchmarks.gait_measures import JOINTS, SAMPLES
from benchmarks.gait_record import thigh_angles
from benchmarks.shared_data import shared_folder
from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES
from locomotion.clips.bvh import Capture, read_bvh
from locomotion.clips.motion import Motion
from locomotion.clips.retargeting import load_mapping, retarget

__all__ = ["Stride", "captured_strides", "fitted", "humanoid3d"]

_MAPPING = Path(__file__).resolve().parents[1] / "examples" / "clips" / "mixamo.yaml"
_PREFIX = "Character1_"
_SIDES = ("right", "left")
_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # from Y up to Z up
_TRUNK = {
    "pelvis": ("", (0, 0, 0), 4), "chest": ("pelvis", (0, 0.236151, 0), 8),
    "head": ("chest", (0, 0.223894, 0), 12),
}  # fmt: skip
_LIMBS = {
    "thigh": ("pelvis", (0, 0, 0.084887), (16, 30)), "shank": ("thigh", (0, -0.421546, 0), (20, 34)),
    "foot": ("shank", (0, -0.40987, 0), (21, 35)),
    "upper_arm": ("chest", (-0.02405, 0.2435, 0.18311), (25, 39)),
    "forearm": ("upper_arm", (0, -0.274788, 0), (29, 43)),
}  # fmt: skip
# of the figure of DeepMimic (Peng et al. 2018): what is above, the way from there [m] on the right side, y
# up, and the columns of a frame with its turn, right and left
_WRIST = (0, -0.258947, 0)  # [m] from the elbow
_HINGES = ("shank", "forearm")
_HARMONICS = 6
_PERIODS = np.arange(0.95, 1.3, 0.005)  # of the recording's length


@dataclass(frozen=True)
class Stride:
    """``speed`` [m/s], of a person with our legs; ``cadence`` [steps/s]; ``curves`` of thigh, knee, ankle,
    shoulder and elbow, each (100,) [deg], which begin anywhere in the cycle."""

    name: str
    speed: float
    cadence: float
    curves: dict[str, NDArray[np.float64]]


@cache
def captured_strides(gait: str) -> tuple[Stride, ...]:
    """All of a ``gait``, "walk" or "run"; none without the shared data."""
    folder = shared_folder()
    if folder is None:
        return ()
    mapping = {part: _PREFIX + joint for part, joint in load_mapping(_MAPPING).items()}
    bvh = read_bvh(folder / "mocap" / "mass" / f"{gait}.bvh", "cm", "y")
    file = folder / "mocap" / "humanoid3d" / f"humanoid3d_{gait}.txt"
    other = humanoid3d(np.array(json.loads(file.read_text())["Frames"]))
    motions = {
        f"mass/{gait}": retarget(bvh, mapping),
        f"humanoid3d_{gait}": retarget(other, {part: part for part in other.joints}),
    }
    return tuple(_stride(name, motion) for name, motion in motions.items())


def humanoid3d(frames: NDArray[np.float64]) -> Capture:
    """Motion of the figure of DeepMimic, ``frames`` (n, 44): time to the next one [s], place of the root, y
    up, and turns from the part above: (w, x, y, z), or [rad] of a hinge about z."""
    parts = dict(_TRUNK)
    for k, side in enumerate(_SIDES):
        for part, (above, (x, y, z), columns) in _LIMBS.items():
            root = above if above in _TRUNK else f"{side}_{above}"
            parts[f"{side}_{part}"] = root, (x, y, -z if k else z), columns[k]
    turns = []
    for part, (_, _, column) in parts.items():
        if part.endswith(_HINGES):
            turns.append(Rotation.from_rotvec(np.outer(frames[:, column], [0.0, 0.0, 1.0])))
        else:
            turns.append(Rotation.from_quat(frames[:, column : column + 4], scalar_first=True))
    ends = [f"{side}_hand" for side in _SIDES]
    names = (*parts, *ends)
    above = [row[0] for row in parts.values()] + [f"{side}_forearm" for side in _SIDES]
    parents = np.array([names.index(each) if each else -1 for each in above])
    offsets = np.array([row[1] for row in parts.values()] + [_WRIST for _ in ends]) @ _UP.T
    turned = np.stack([each.as_matrix() for each in turns] + [np.tile(np.eye(3), (len(frames), 1, 1))] * 2, 1)
    place = frames[:, 1:4] @ _UP.T
    return Capture("humanoid3d", 1.0 / frames[0, 0], names, parents, offsets, place, _UP @ turned @ _UP.T)


def _stride(name: str, motion: Motion) -> Stride:
    model = figure()
    data, thighs = mujoco.MjData(model), [model.body(f"{side}_thigh").id for side in _SIDES]
    values = {"thigh": np.empty((len(motion.qpos), 2))}
    for k, qpos in enumerate(motion.qpos):
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        values["thigh"][k] = thigh_angles(data, thighs)
    for key, joint in JOINTS.items():
        values[key] = motion.qpos[:, [7 + JOINT_NAMES.index(f"{side}_{joint}") for side in _SIDES]]
    curves, period = fitted({key: np.degrees(each) for key, each in values.items()})
    way = float(np.linalg.norm(motion.qpos[-1, :2] - motion.qpos[0, :2]))
    return Stride(name, way / motion.duration, 2.0 * motion.rate / period, curves)


def fitted(values: dict[str, NDArray[np.float64]]) -> tuple[dict[str, NDArray[np.float64]], float]:
    """Periodic curves, each (100,), through ``values``, (n, 2) a frame, of the right and the left side; and
    their period in frames."""
    count = len(values["thigh"])

    def waves(at: NDArray[np.float64]) -> NDArray[np.float64]:
        angles = 2.0 * np.pi * np.outer(at, np.arange(_HARMONICS + 1))
        return np.hstack([np.cos(angles), np.sin(angles[:, 1:])])

    def fit(period: float) -> tuple[NDArray, NDArray]:
        at = np.arange(count) / period
        rows = waves(np.concatenate([at, at + 0.5]))
        both = np.stack([each.T.ravel() for each in values.values()], axis=1)
        found = np.linalg.lstsq(rows, both, rcond=None)[0]
        return found, both - rows @ found

    legs = [list(values).index(name) for name in ("thigh", "knee")]
    period = min(_PERIODS * (count - 1), key=lambda each: float((fit(each)[1][:, legs] ** 2).sum()))
    curves = waves(np.arange(SAMPLES) / SAMPLES) @ fit(period)[0]
    return dict(zip(values, curves.T, strict=True)), float(period)
