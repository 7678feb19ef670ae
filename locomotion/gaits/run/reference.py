"""The running controller's law in plain NumPy and SciPy: slow, obvious, what the tests compare the kernel
with.

It says what one tick does between two switches of the stance; it shares only names and constants with the
kernel.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.body.person import JOINT_NAMES
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill

__all__ = ["actions", "feed_forward", "parameters_at", "pd_targets", "sensors"]


def parameters_at(skill: RunSkill, speed: float) -> dict[str, np.ndarray]:
    """Blocks of `controller.PARAMETERS` at ``speed`` [m/s]."""
    row = np.array([np.interp(speed, skill.knots, column) for column in skill.table.T])
    return {name: row[part] for name, part in c.parameter_slices().items()}


def sensors(state: np.ndarray, side_speed: float, qpos: np.ndarray, qvel: np.ndarray) -> np.ndarray:
    """The 12 sensors, lateral ones mirrored so that the right leg is the stance leg."""
    to_heading = Rotation.from_euler("z", -state[c.HEADING])
    attitude = Rotation.from_quat(qpos[[4, 5, 6, 3]])
    forward, up = (to_heading * attitude).apply(np.eye(3)[[0, 2]])
    rate = to_heading.apply(attitude.apply(qvel[3:6])) - [0.0, 0.0, state[c.TURN_RATE]]
    velocity = to_heading.apply(state[c.COM_VELOCITY])
    feet = state[c.FEET].reshape(2, 3)
    foot = feet[1] if state[c.STANCE] > 0 else feet[0]
    place = to_heading.apply(state[c.COM] - foot)
    sagittal = [np.arctan2(up[0], up[2]), rate[1], place[2], velocity[0], velocity[2], place[0]]
    sagittal[2] -= state[c.SLOPE] * place[0]
    sagittal[4] -= state[c.SLOPE] * velocity[0]
    lateral = [
        np.arctan2(-up[1], up[2]),
        np.arctan2(forward[1], forward[0]),
        rate[0],
        rate[2],
        velocity[1] - side_speed,
        place[1],
    ]
    return np.array(sagittal + [-state[c.STANCE] * x for x in lateral])


def actions(skill: RunSkill, state: np.ndarray, sensed: np.ndarray) -> np.ndarray:
    """The 12 actions named in `controller.CLIMB` [rad]."""
    p = parameters_at(skill, state[c.SPEED])
    phases = np.linspace(0.0, 1.0, len(skill.state_reference))
    expected = np.array([np.interp(state[c.PHASE], phases, column) for column in skill.state_reference.T])
    speed = state[c.SPEED] + state[c.TRIM]
    expected[3] += speed
    expected[5] *= speed
    bound = np.array([0.6, 5.0, 0.2, 1.5, 2.0, 0.5, 0.6, 0.6, 5.0, 5.0, 1.5, 0.4])
    delta = np.clip(sensed - expected, -bound, bound)
    side = state[c.STANCE]
    result = (p["climb"] if state[c.SLOPE] >= 0 else p["descend"]) * state[c.SLOPE]
    result[:9] += p["m_ap"].reshape(9, 3) @ p["m_sp"].reshape(3, 12) @ delta
    result += p["bend"] * (state[c.TURN_RATE] * state[c.SPEED]) ** 2
    result[:9] += p["a_hat"] + p["turn"] * state[c.TURN_RATE] * side
    pitch, pitch_rate, roll, yaw, roll_rate, yaw_rate = sensed[[0, 1, 6, 7, 8, 9]]
    roll, yaw, roll_rate = np.clip([roll, yaw, roll_rate], [-0.6, -0.6, -5.0], [0.6, 0.6, 5.0])
    g = p["posture"]
    result[:3] += [g[0] * pitch, -g[1] * roll, g[2] * yaw]
    result[3:6] += [
        -g[3] * pitch - g[4] * pitch_rate,
        -g[5] * roll - g[6] * roll_rate,
        g[7] * yaw + g[8] * yaw_rate,
    ]
    return result


def feed_forward(values: np.ndarray, share: float) -> float:
    """Periodic cubic through ``values`` (n,), with tangents by central differences, at ``share`` of the
    cycle."""
    n = len(values)
    at = (share % 1.0) * n
    low, t = int(at), at - int(at)
    before, start, end, after = (values[(low + k) % n] for k in (-1, 0, 1, 2))
    tangents = 0.5 * (end - before), 0.5 * (after - start)
    basis = 2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, -2 * t**3 + 3 * t**2, t**3 - t**2
    return float(np.dot(basis, [start, tangents[0], end, tangents[1]]))


def pd_targets(skill: RunSkill, state: np.ndarray, sensed: np.ndarray, qpos: np.ndarray) -> np.ndarray:
    """PD targets (39,) [rad] before they are blended over a switch."""
    _, _, reference, rates, mean, _, _ = skill.tables
    p = parameters_at(skill, state[c.SPEED])
    side, phase = state[c.STANCE], state[c.PHASE]
    share = phase / 2 + (0.5 if side > 0 else 0.0)
    rows = np.arange(len(reference) + 1) / len(reference)
    pose, rate = (
        np.array([np.interp(share % 1.0, rows, np.append(column, column[0])) for column in table.T])
        for table in (reference, rates)
    )
    way = "climb" if state[c.SLOPE] >= 0 else "descend"
    step_time, legs_amplitude = p["timing"] + state[c.SLOPE] * p[f"{way}_timing"]
    moving = 0.1 / (2 * max(step_time, 0.2)) if phase < 1.0 else 0.0
    amplitude = np.ones(len(JOINT_NAMES))
    amplitude[9:25] = p["arms"][0]
    amplitude[25:] = legs_amplitude
    target = mean + amplitude * (pose - mean + rate * moving)
    knots = (p["feed_forward"] + state[c.SLOPE] * p[f"{way}_legs"]).reshape(3, c.N_KNOTS)
    joint = JOINT_NAMES.index
    for leg, at in (("right", share), ("left", share + 0.5)):
        for row, name in enumerate(("hip_flexion", "knee_flexion", "ankle_flexion")):
            target[joint(f"{leg}_{name}")] += feed_forward(knots[row], at)
    stance, swing = ("left", "right") if side > 0 else ("right", "left")
    a: dict[str, float] = {}
    a.update(zip(c.CLIMB, actions(skill, state, sensed), strict=True))
    for name in ("hip_flexion", "hip_abduction", "hip_rotation"):
        target[joint(f"{swing}_{name}")] += a[f"swing_{name}"]
        target[joint(f"{stance}_{name}")] += a[f"stance_{name}"]
    target[joint(f"{swing}_knee_flexion")] += a["swing_knee_flexion"]
    target[joint(f"{stance}_knee_flexion")] += a["stance_knee_flexion"]
    target[joint(f"{stance}_ankle_flexion")] += a["stance_ankle_flexion"]
    for axis, sign in (("pitch", 1.0), ("roll", -side), ("yaw", -side)):
        target[joint(f"waist_{axis}")] += sign * a[f"waist_{axis}"]
        target[joint(f"chest_{axis}")] += sign * a[f"waist_{axis}"]
    tilt = sensed[0], *(-side * np.clip(sensed[6:8], -0.6, 0.6))
    for axis, value, lean in (("pitch", tilt[0], 0.1), ("roll", tilt[1], 0.0), ("yaw", tilt[2], 0.0)):
        trunk = qpos[7 + joint(f"waist_{axis}")] + qpos[7 + joint(f"chest_{axis}")]
        target[joint(f"neck_{axis}")] += lean - value - trunk
    return target
