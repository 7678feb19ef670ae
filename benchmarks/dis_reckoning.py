"""Dead reckoning against integration in small steps: the slow, obvious version."""

import numpy as np

from runtime.dis.dead_reckoning import MODELS, Motion, reckoned
from runtime.dis.geodesy import LevelFrame, rotations_of

__all__ = ["errors_against_integration", "integrated", "random_motion"]

PLACES = ((90.0, 0.0), (-90.0, 0.0), (0.0, 180.0), (10.0, -180.0), (48.0, 11.0), (89.99, -179.99))
"""Latitude and longitude [°]: poles, the other side of the prime meridian, and elsewhere."""


def random_motion(count: int, model: int, seed: int) -> Motion:
    """People, vehicles and things that tumble, of one model, at `PLACES`."""
    chance = np.random.default_rng(seed)
    centres = [LevelFrame((*place, 100.0)).centre for place in PLACES]
    return Motion(
        np.full(count, model),
        np.array([centres[k % len(centres)] for k in range(count)]),
        rotations_of(chance.uniform(-np.pi, np.pi, (count, 3))),
        chance.normal(0.0, 5.0, (count, 3)),
        chance.normal(0.0, 1.0, (count, 3)),
        chance.normal(0.0, 1.0, (count, 3)),
    )


def integrated(motion: Motion, seconds: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) and rotations (n, 3, 3) after steps of ``step`` [s], velocities taken at the middle of
    each and rotations by the exponential's first terms; no formula of the standard."""
    names = [MODELS[each] for each in motion.algorithm]
    rotates = np.array([name.startswith("R") for name in names])[:, None]
    accelerates = np.array(["V" in name for name in names])[:, None]
    in_body = np.array([name.endswith("B") for name in names])[:, None]
    moves = np.array([name not in ("other", "static") for name in names])[:, None]
    moved, rotation = np.zeros_like(motion.position), motion.rotation.copy()
    x, y, z = np.where(rotates, motion.turning, 0.0).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(-1, 3, 3)

    def turn(by: float) -> np.ndarray:
        small = cross * by
        return np.eye(3) + small + 0.5 * small @ small + small @ small @ small / 6.0

    half = turn(0.5 * step)
    for k in range(round(seconds / step)):
        middle = rotation @ half
        speed = motion.velocity + np.where(accelerates, motion.acceleration, 0.0) * (k + 0.5) * step
        in_frame = np.einsum("nij,nj->ni", middle, speed)
        moved += step * np.where(moves, np.where(in_body, in_frame, speed), 0.0)
        rotation = middle @ half
    return motion.position + moved, rotation


def errors_against_integration(
    model: int, count: int, seconds: float, step: float, seed: int
) -> tuple[float, float]:
    """The largest differences [m], [rad]."""
    motion = random_motion(count, model, seed)
    places, rotations = reckoned(motion, np.full(count, seconds))
    truth, turned = integrated(motion, seconds, step)
    between = np.swapaxes(rotations, 1, 2) @ turned
    skew = np.stack(
        [
            between[:, 2, 1] - between[:, 1, 2],
            between[:, 0, 2] - between[:, 2, 0],
            between[:, 1, 0] - between[:, 0, 1],
        ],
        axis=1,
    )
    angles = np.arctan2(0.5 * np.linalg.norm(skew, axis=1), 0.5 * (np.trace(between, axis1=1, axis2=2) - 1.0))
    return float(np.linalg.norm(places - truth, axis=1).max()), float(angles.max())
