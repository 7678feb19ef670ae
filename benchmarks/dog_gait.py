"""Rows of `benchmarks.dog` about gaits: our dog against a real one, measured in the same way."""

from typing import Any

import numpy as np

from benchmarks.shared_data import shared_folder
from locomotion import Ground
from locomotion.quadruped import Herd, lay_trail, load_body

RATE = 60.0
"""[Hz] of the recordings; ours is sampled at the same."""
CLIPS = {"trot": ("dog_trot", 1.86, "trot"), "pace": ("dog_pace", 1.13, "pace")}
"""Recording, its speed [m/s], our gait."""
TOES = {"front_left": 10, "front_right": 15, "rear_left": 19, "rear_right": 23}
_SHARE = 0.5  # of the mean speed of the body: a toe that is slower stands


def contacts(toes: np.ndarray, pace: float) -> np.ndarray:
    """(t, 4) whether each toe of (t, 4, 3) [m] stands, in a recording that is repeated end to end: it is
    slower over the ground than a share of the body's ``pace`` [m/s]."""
    steps = np.diff(toes, axis=0) * RATE
    speed = np.linalg.norm(steps, axis=2)
    speed = np.vstack([speed[:1], 0.5 * (speed[1:] + speed[:-1]), speed[-1:]])
    return speed < _SHARE * pace


def measure(stands: np.ndarray, cycle: int) -> dict[str, float]:
    """Duty factors and diagonal phase of one cycle of ``cycle`` samples: (cycle, 4) bool, left and right
    front, left and right rear."""
    stands = stands[:cycle]
    middle = []
    for leg in range(4):
        turns = np.exp(2j * np.pi * np.flatnonzero(stands[:, leg]) / cycle)
        middle.append(np.angle(turns.mean()) / (2.0 * np.pi) % 1.0)
    apart = [(middle[rear] - middle[front]) % 1.0 for front, rear in ((0, 3), (1, 2))]
    mean = np.angle(np.exp(2j * np.pi * np.array(apart)).mean()) / (2.0 * np.pi)
    return {
        "frequency": RATE / cycle,
        "duty_front": float(stands[:, :2].mean()),
        "duty_rear": float(stands[:, 2:].mean()),
        "diagonal_phase": float(mean),
    }


def real_dog(clip: str) -> dict[str, float] | None:
    """The recorded cycle, or None without shared data."""
    folder = shared_folder()
    path = None if folder is None else folder / "mocap" / "dog" / "keypoints" / f"{clip}_joint_pos.txt"
    if path is None or not path.is_file():
        return None
    rows = [[float(v) for v in line.replace(",", " ").split()] for line in path.read_text().splitlines()]
    frames = np.array(rows).reshape(len(rows), -1, 3)
    toes = frames[:, list(TOES.values())]
    pace = float(np.linalg.norm(frames[-1, 0, [0, 2]] - frames[0, 0, [0, 2]])) / (len(frames) - 1) * RATE
    cycle = period(frames)
    return measure(contacts(toes, pace), cycle) | {"speed": pace}


def period(frames: np.ndarray) -> int:
    """Samples after which the posture of (t, points, 3) repeats: the whole recording is one cycle unless an
    earlier frame is like the first."""
    posture = frames - frames[:, :1] * np.array([1.0, 0.0, 1.0])
    ways = np.linalg.norm((posture[12:] - posture[0]).reshape(len(frames) - 12, -1), axis=1)
    return int(np.argmin(ways)) + 12


def our_dog(gait: str, speed: float) -> dict[str, float]:
    """Our dog on a plane, once it goes at an even speed."""
    half = 60.0
    corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0.0]])
    ground = Ground.from_arrays(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    body = load_body("dog")
    herd = Herd(ground)
    index = herd.add(body, (-50.0, 0.0, 0.0), 0.0)
    trail = lay_trail([[-50.0, 0.0, 0.0], [50.0, 0.0, 0.0]], body, ground)
    herd.follow(index, trail, speed, gait=gait)
    for _ in range(600):
        herd.tick()
    toes, clock = [], []
    for _ in range(400):
        herd.tick()
        toes.append(herd.toes(index))
        clock.append(herd.standing_feet(index))
    down = np.flatnonzero(np.diff(np.array(clock)[:, 0].astype(int)) > 0)
    ticks = float(np.diff(down).mean())
    times = np.arange(0.0, 400.0, 100.0 / RATE)
    sampled = np.stack(
        [[np.interp(times, np.arange(400), np.array(toes)[:, leg, k]) for k in range(3)] for leg in range(4)]
    ).transpose(2, 0, 1)
    measured = measure(contacts(sampled, speed), round(ticks * RATE / 100.0))
    return measured | {"frequency": 100.0 / ticks, "speed": speed}


def against_real(_: bool) -> dict[str, Any]:
    """Each gait: ours, the real one's, and by how much ours differs."""
    result: dict[str, Any] = {}
    for name, (clip, speed, gait) in CLIPS.items():
        real, ours = real_dog(clip), our_dog(gait, speed)
        result[name] = {"ours": ours, "real": real}
        if real is not None:
            phase = abs((ours["diagonal_phase"] - real["diagonal_phase"] + 0.5) % 1.0 - 0.5)
            result[name]["off"] = {
                key: ours[key] / real[key] - 1.0 for key in ("frequency", "duty_front", "duty_rear")
            } | {"diagonal_phase": phase}
    return result
