"""The drop-roll's law in plain NumPy: slow, obvious, what the tests compare the kernel with."""

import numpy as np

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.gaits.run import controller
from locomotion.skills.drop_roll import kernel as dr
from locomotion.skills.kernel import mirror
from locomotion.skills.learned_skill import LawTables

__all__ = ["wanted_pose"]


def wanted_pose(tables: LawTables, memory: np.ndarray, state: np.ndarray, before: np.ndarray) -> np.ndarray:
    """PD targets (39,) [rad] of a tick, from what ``memory`` and ``state`` hold after it.

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
