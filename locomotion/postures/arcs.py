"""The frames of arcs: between keys, or cut from a recorded motion."""

from collections.abc import Sequence

import mujoco
import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from locomotion.body.models import figure
from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import Motion, lowest_points
from locomotion.postures.places import inverse, place_of, placed

__all__ = ["RATE", "arc_between", "arc_of_motion", "pose_of"]

RATE = 60.0
"""[Hz] of the frames that are made between keys."""


def pose_of(angles: dict[str, float], pitch: float, roll: float) -> np.ndarray:
    """A pose (46,) on the ground z = 0: ``angles`` [deg] by joint, others 0; the pelvis leans forward by
    ``pitch`` and to the right by ``roll`` [deg]."""
    pose = np.zeros(7 + len(JOINT_NAMES))
    pose[3:7] = Rotation.from_euler("YX", [pitch, roll], degrees=True).as_quat(scalar_first=True)
    for name, angle in angles.items():
        pose[7 + JOINT_NAMES.index(name)] = np.radians(angle)
    pose[2] = -lowest_points(pose[None])[0]
    return pose


def arc_between(
    poses: np.ndarray, shares: Sequence[float], seconds: float, standing_on: str
) -> tuple[np.ndarray, np.ndarray]:
    """Frames (n, 46) from the first of ``poses`` (k, 46) to the last, through the others at ``shares`` (k,)
    of its ``seconds``; and where the arc takes the figure, x, y [m] and turn [rad].

    It begins and ends gently. The part of the body ``standing_on`` stays over its place, and at its height
    where that is the same at both ends; but the figure never floats.
    """
    count = max(round(seconds * RATE), 1) + 1
    time = np.linspace(0.0, 1.0, count)
    gentle = PchipInterpolator([0.0, 1.0], [0.0, 1.0])(time)
    turns = _continuous(poses[:, 3:7])
    frames = np.zeros((count, poses.shape[1]))
    frames[:, 7:] = PchipInterpolator(shares, poses[:, 7:])(gentle)
    turn = PchipInterpolator(shares, turns)(gentle)
    frames[:, 3:7] = turn / np.linalg.norm(turn, axis=1, keepdims=True)
    places = _places(frames, standing_on)
    height = _places(poses[[0, -1]], standing_on)[:, 2]
    frames[:, :2] = places[0, :2] - places[:, :2]
    frames[:, 2] = height[0] + gentle * (height[1] - height[0]) - places[:, 2]
    frames[:, 2] -= np.maximum(lowest_points(frames), 0.0)
    return frames, np.array([*frames[-1, :2], 0.0])


def arc_of_motion(motion: Motion, begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """The frames of ``motion`` from ``begin`` to ``end`` [s], where it begins at x = y = 0 facing +x, and
    where it takes the figure."""
    first, last = round(begin * motion.rate), round(end * motion.rate)
    frames = motion.qpos[first : last + 1]
    back = inverse(place_of(frames[0]))
    frames = np.array([placed(frame, back) for frame in frames])
    return frames, place_of(frames[-1])


def _continuous(turns: np.ndarray) -> np.ndarray:
    """Quaternions (k, 4), each with the sign that is nearer to the one before."""
    turns = turns.copy()
    for k in range(1, len(turns)):
        if turns[k] @ turns[k - 1] < 0.0:
            turns[k] *= -1.0
    return turns


def _places(frames: np.ndarray, part: str) -> np.ndarray:
    """Where a part of the body is in each frame: (n, 3) [m]."""
    model = figure()
    data = mujoco.MjData(model)
    body = model.body(part).id
    places = np.empty((len(frames), 3))
    for k, frame in enumerate(frames):
        data.qpos[:] = frame
        mujoco.mj_kinematics(model, data)
        places[k] = data.xpos[body]
    return places
