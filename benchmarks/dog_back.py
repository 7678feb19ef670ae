"""Rows of `benchmarks.dog` about backs, heads and tails, measured on the poses that a host gets.

Animals of each body go straight on at even speeds; others stand for two minutes.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion import Ground
from locomotion.quadruped import Body, Herd, lay_trail, load_body
from locomotion.quadruped.motion import DT
from locomotion.quadruped.pose import body_names

Array = NDArray[np.floating[Any]]

BODIES = ("dog", "cat", "horse", str(Path(__file__).parent / "foal.yaml"))
GALLOPS = (0.7, 1.0)
"""Shares of the top speed at which the gallop is measured."""
_SETTLED, _MEASURED = 4.0, 4.0  # [s]
_STANDS = 120.0  # [s]


def angles(poses: Array) -> Array:
    """(..., 3) yaw, elevation and roll (left side up) [rad] of frames (..., 7)."""
    w, x, y, z = np.moveaxis(poses[..., 3:], -1, 0)
    yaw = np.arctan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z))
    up = np.arcsin(np.clip(-2 * (w * y - x * z), -1.0, 1.0))
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return np.stack([yaw, up, roll], axis=-1)


def plane(half: float) -> Ground:
    corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0.0]])
    return Ground.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))


def going(body: Body, speed: float, gait: str) -> tuple[Array, NDArray[np.bool_]]:
    """Ticks at an even speed on a straight: poses (t, bodies, 7), and which feet stand (t, 4)."""
    before = speed / body.movement.acceleration + _SETTLED
    length = speed * (before + _MEASURED) + 10.0
    ground = plane(length)
    herd = Herd(ground)
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    herd.follow(0, lay_trail([[0.0, 0.0, 0.0], [length, 0.0, 0.0]], body, ground), speed, gait=gait)
    poses, stands = [], []
    for tick in range(round((before + _MEASURED) / DT)):
        herd.tick()
        if tick * DT >= before:
            poses.append(herd.pose(0))
            stands.append(herd.standing_feet(0))
    return np.array(poses), np.array(stands)


def strides(body: Body, speed: float, gait: str) -> dict[str, float]:
    """What the trunk does over a stride: ranges [deg] of the back's flexion, of its bend to the sides, of the
    rolls of hips and shoulders, of the neck and of the tail's tip; how many nods the head makes; where in the
    stride the back is most flexed and most extended, from the landing of the right hind foot on, which is the
    first of the two in the gallops that ship."""
    poses, stands = going(body, speed, gait)
    names = body_names(body.spine.bones)
    of = {name: angles(poses[:, k]) for k, name in enumerate(names)}
    pelvis, chest = of["pelvis"], of[f"spine_{body.spine.bones}"]
    flexion = np.degrees(pelvis[:, 1] - chest[:, 1])
    landings = np.flatnonzero(~stands[:-1, 3] & stands[1:, 3]) + 1
    stride = float(np.diff(landings).mean())
    neck = np.degrees(of["neck"][:, 1])
    rate = np.fft.rfft(neck - neck.mean())
    nods = np.fft.rfftfreq(len(neck))[np.abs(rate).argmax()] * stride
    whole = flexion[landings[0] : landings[-1]]
    when = (np.arange(len(whole)) % stride) / stride
    return {
        "speed": speed, "top_speed": body.top_speed,
        "flexion_deg": float(np.ptp(flexion)),
        "most_flexed": _mean_phase(when, whole, True), "most_extended": _mean_phase(when, whole, False),
        "undulation_deg": float(np.degrees(np.ptp(chest[:, 0] - pelvis[:, 0]))),
        "hip_roll_deg": float(np.degrees(np.ptp(pelvis[:, 2]))),
        "shoulder_roll_deg": float(np.degrees(np.ptp(chest[:, 2]))),
        "nod_deg": float(np.ptp(neck)), "nods": float(nods),
        "tail_deg": float(np.degrees(np.ptp(np.unwrap(of["tail_3"][:, :2], axis=0), axis=0)).max()),
    }  # fmt: skip


def _mean_phase(when: Array, values: Array, most: bool) -> float:
    """Where in the stride the mean course has its greatest or least value."""
    bins = (when * 50).astype(int).clip(0, 49)
    mean = np.array([values[bins == k].mean() if (bins == k).any() else np.nan for k in range(50)])
    return float((np.nanargmax(mean) if most else np.nanargmin(mean)) / 50)


def standing(body: Body, seeds: int) -> dict[str, float]:
    """What ``seeds`` animals do that only stand, side by side: breaths a minute of the first; the least range
    of gaze and of the hips' roll [deg] among them; the greatest correlation of two of them in gaze and in
    roll; how far their toes moved [m]."""
    herd = Herd(plane(50.0))
    for k in range(seeds):
        herd.add(body, (0.0, 3.0 * k, 0.0), 0.0, seed=11)
    names = body_names(body.spine.bones)
    head, pelvis, chest = (names.index(name) for name in ("head", "pelvis", f"spine_{body.spine.bones}"))
    toes = herd.feet[:, :, :3].copy()
    seen = []
    for tick in range(round(_STANDS / DT)):
        herd.tick()
        poses = angles(herd.poses.reshape(seeds, -1, 7)[:, [head, pelvis, chest]])
        if tick * DT >= _SETTLED:
            seen.append([poses[:, 0, 0], poses[:, 1, 2], poses[:, 1, 1] - poses[:, 2, 1]])
    shown = np.degrees(np.array(seen))
    back = shown[:, 2, 0] - shown[:, 2, 0].mean()
    alike = [np.corrcoef(shown[:, k].T) - 2.0 * np.eye(seeds) for k in range(2)]
    return {
        "breaths": 60.0 * float(np.abs(np.fft.rfft(back)).argmax()) / (len(back) * DT),
        "gaze_deg": float(np.ptp(shown[:, 0], axis=0).min()),
        "roll_deg": float(np.ptp(shown[:, 1], axis=0).min()),
        "alike": float(max(each.max() for each in alike)),
        "slide": float(np.abs(herd.feet[:, :, :3] - toes).max()),
    }


def backs(quick: bool) -> dict[str, Any]:
    """Every body in walk, trot and gallop, and standing."""
    found: dict[str, Any] = {}
    for name in BODIES:
        body = load_body(name)
        runs = {gait: 0.8 * body.gaits[gait].up_to for gait in ("walk", "trot")}
        for gait, speed in runs.items():
            found[f"{body.name} {gait}"] = strides(body, speed, gait)
        for share in GALLOPS:
            speed = share * body.top_speed
            found[f"{body.name} gallop, {speed:.1f} m/s"] = strides(body, speed, "gallop")
        found[f"{body.name} stands"] = standing(body, 3 if quick else 8)
    return found
