"""The drop-roll's law in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import controller
from locomotion.skills.drop_roll import kernel as dr
from locomotion.skills.kernel import mirror
from locomotion.skills.learned_skill import LawTables

__all__ = ["giving_leg", "point_of_sole", "sole_force", "wanted_pose"]

_STEP = 1e-6  # [rad] of a numerical derivative


def sole_force(
    give: np.ndarray, height: float, speed: float, feet: np.ndarray, rate: float
) -> tuple[float, float]:
    """Force on both soles together, along the approach and upwards [N], that slows a landing down.

    height, speed: of the centre of mass above the ground [m] and upwards [m/s]. feet (2,): where the soles
    bear, ahead of the centre of mass and above it [m]. rate: of turning forward [rad/s].
    """
    _, _, end_height, end_speed, turning, gain, *_ = give
    up = 9.81
    if speed < end_speed:
        up += (speed**2 - end_speed**2) / (2.0 * max(height - end_height, 0.04))
    upward = 65.0 * min(max(up, 0.0), 9.0 * 9.81)
    ahead, above = feet
    # the moment forward of a force (along, upward) at the feet is above * along - ahead * upward
    along = (gain * (turning - rate) + ahead * upward) / min(above, -0.2)
    return float(np.clip(along, -0.6 * upward, 0.6 * upward)), upward


def point_of_sole(pitch: float, joints: np.ndarray, ball: float) -> np.ndarray:
    """Where a sole bears from the hip on, ahead and up (2,) [m]: pitch of the pelvis, hip, knee, ankle."""
    hip, knee, ankle = joints
    thigh = hip - pitch
    shank = thigh - knee
    foot = shank + ankle
    down = [np.array([np.sin(a), -np.cos(a)]) for a in (thigh, shank, foot)]
    return 0.412 * down[0] + 0.424 * down[1] + 0.064 * down[2] + ball * np.array([np.cos(foot), np.sin(foot)])


def giving_leg(
    pitch: float,
    joints: np.ndarray,
    rates: np.ndarray,
    last: np.ndarray | None,
    force: np.ndarray,
    ball: float,
) -> np.ndarray:
    """Targets (3,) [rad] of hip, knee and ankle with which a sole bears ``force`` (2,) [N]. rates, last:
    of the joints now and a tick ago [rad/s]."""
    ends = [[point_of_sole(pitch, joints + s * move, ball) for s in (1, -1)] for move in _STEP * np.eye(3)]
    jacobian = np.column_stack([(plus - minus) / (2.0 * _STEP) for plus, minus in ends])
    torques = np.clip(-jacobian.T @ force, [-350.0, -350.0, -300.0], [350.0, 350.0, 300.0])
    if last is not None:
        rates = rates + 0.4 * CONTROL_DT * np.clip((rates - last) / CONTROL_DT, -400.0, 400.0)
    return joints + (0.5 * CONTROL_DT + 0.1) * rates + torques / [600.0, 500.0, 400.0]


def wanted_pose(tables: LawTables, memory: np.ndarray, state: np.ndarray, before: np.ndarray) -> np.ndarray:
    """PD targets (39,) [rad] of a tick on legs that hold their pose, from what ``memory`` and ``state`` hold
    after it.

    ``before`` (39,): the targets with which the fall began.
    """
    p = {name: tables.parameters[part] for name, part in dr.parameter_slices().items()}
    clip, reference, _, _ = tables.rest
    share, phase = memory[dr.SHARE], memory[dr.PHASE]
    lead = np.clip(share + p["timing"][0] * memory[dr.SHARE_RATE], 0.0, 1.0)
    pose = _at(clip, lead)
    sensed = memory[dr.SENSED]

    stage = 0 if phase == dr.FALL else 1 if share < 0.75 else 2
    off = np.clip(sensed - _at(reference, share), -dr.MOST_OFF, dr.MOST_OFF)
    m_sp = p["m_sp"].reshape(3, dr.RANK, len(dr.SENSORS))[stage]
    latent = np.clip(m_sp @ off, -1.0, 1.0)
    action = _at(p["pose"].reshape(dr.KNOTS, len(dr.ACTIONS)), share)
    action = action + p["m_ap"].reshape(len(dr.ACTIONS), dr.RANK) @ latent
    value = dict(zip(dr.ACTIONS, action, strict=True))

    named = dict(zip(JOINT_NAMES, pose, strict=True))
    for side, right in (("right", 1.0), ("left", -1.0)):
        named[f"{side}_hip_flexion"] += value["hips"] + right * value["hip_split"]
        named[f"{side}_hip_abduction"] += right * value["legs_side"]
        named[f"{side}_knee_flexion"] += value["knees"]
        named[f"{side}_ankle_flexion"] += value["ankles"]
        named[f"{side}_shoulder_flexion"] += value["shoulders"]
    for part in ("waist", "chest"):
        named[f"{part}_pitch"] += value["trunk_pitch"]
        named[f"{part}_roll"] += value["trunk_roll"]
        named[f"{part}_yaw"] += value["trunk_yaw"]

    if phase == dr.FALL:
        above = max(state[controller.FEET][[2, 5]].min() - 0.064 - memory[dr.LOW], 0.0)
        vz = state[controller.COM_VELOCITY][2]
        left = (vz + np.sqrt(vz**2 + 2.0 * 9.81 * above)) / 9.81
        aimed = np.clip(1.0 - (left - 0.05) / 0.3, 0.0, 1.0)
        rate = memory[dr.RATE]
        pitch = memory[dr.ANGLE] + np.clip(rate, -2.0, 3.0) * left
        ahead, by_speed, by_rate, toes, split, bend, by_pitch = p["landing"]
        ahead = ahead + by_speed * (sensed[1] - 3.0) + by_rate * rate + by_pitch * (pitch - 0.7)
        for side, right in (("right", 1.0), ("left", -1.0)):
            knee = named[f"{side}_knee_flexion"] + bend
            hip = ahead + right * split + 0.5 * knee + pitch
            ankle = pitch - hip + knee - toes
            for joint, angle in (("hip", hip), ("knee", knee), ("ankle", ankle)):
                name = f"{side}_{joint}_flexion"
                named[name] += aimed * (angle - named[name])

    result = np.array([named[name] for name in JOINT_NAMES])
    if memory[dr.SIDE] < 0.0:
        result = mirror(result)
    if phase == dr.FALL:
        keep = max(1.0 - memory[dr.PHASE_TICKS] * CONTROL_DT / max(p["timing"][3], CONTROL_DT), 0.0)
        result += keep * (before - result)
    return result


def _at(rows: np.ndarray, share: float) -> np.ndarray:
    """Rows (n, k), evenly over [0, 1], at ``share``."""
    places = np.linspace(0.0, 1.0, len(rows))
    return np.array([np.interp(share, places, column) for column in rows.T])
