"""The nine dead-reckoning models of IEEE 1278.1, for many entities in one call.

Their names say what goes on: F (fixed) or R (rotating); P (the velocity stays) or V (the acceleration stays);
W (in the frame's axes) or B (in those of the body, which may turn). Angular velocities are in body axes in
all of them. Linear velocities and accelerations of the B models are, too.
"""

from dataclasses import dataclass, fields

import numpy as np

__all__ = ["MODELS", "ROTATES", "Motion", "reckoned", "velocities"]

MODELS = ("other", "static", "FPW", "RPW", "RVW", "FVW", "FPB", "RPB", "RVB", "FVB")
"""By number. "other" is not extrapolated."""
ROTATES = np.array([name.startswith("R") for name in MODELS])
"""Of each model, whether the body turns."""
_ACCELERATES = np.array(["V" in name for name in MODELS])
_IN_BODY = np.array([name.endswith("B") for name in MODELS])
_MOVES = np.arange(len(MODELS)) >= 2
_SMALL = 0.03  # [rad] below which the coefficients are taken from their series


@dataclass
class Motion:
    """What n entities last told of themselves, in one frame.

    ``algorithm`` (n,) int: index in `MODELS`. ``position`` (n, 3) [m]; ``rotation`` (n, 3, 3) from body axes
    to the frame; ``velocity`` [m/s] and ``acceleration`` [m/s²] (n, 3) in the frame, of B models in body
    axes; ``turning`` (n, 3) [rad/s] in body axes.
    """

    algorithm: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    turning: np.ndarray

    @classmethod
    def empty(cls, count: int) -> "Motion":
        """``count`` entities at rest."""
        still = np.zeros((4, count, 3))
        return cls(np.ones(count, np.int64), still[0], np.tile(np.eye(3), (count, 1, 1)), *still[1:])

    def of(self, rows: np.ndarray) -> "Motion":
        """Those of ``rows``, an index or a mask; copies."""
        return Motion(*(getattr(self, each.name)[rows] for each in fields(self)))

    def put(self, rows: np.ndarray, other: "Motion") -> None:
        """Make those of ``rows`` (k,) what ``other`` holds."""
        for each in fields(self):
            getattr(self, each.name)[rows] = getattr(other, each.name)


def reckoned(motion: Motion, seconds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (n, 3) and rotations (n, 3, 3) ``seconds`` (n,) [s] after what was told."""
    algorithm, t = motion.algorithm, np.asarray(seconds, dtype=np.float64)[:, None]
    speed = np.where(_MOVES[algorithm][:, None], motion.velocity, 0.0)
    gain = np.where(_ACCELERATES[algorithm][:, None], motion.acceleration, 0.0)
    turning = np.where(ROTATES[algorithm][:, None], motion.turning, 0.0)
    moved = speed * t + 0.5 * gain * t * t
    body = np.flatnonzero(_IN_BODY[algorithm])
    if len(body):
        along = _moved_in_body(speed[body], gain[body], turning[body], t[body])
        moved[body] = np.einsum("nij,nj->ni", motion.rotation[body], along)
    rotation = motion.rotation.copy()
    turns = np.flatnonzero(turning.any(axis=1))
    if len(turns):
        rotation[turns] = rotation[turns] @ _turned(turning[turns] * t[turns])
    return motion.position + moved, rotation


def velocities(motion: Motion, seconds: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(n, 3) [m/s] in the frame, ``seconds`` (n,) after what was told; ``rotation`` (n, 3, 3) as `reckoned`
    gives it for then."""
    algorithm, t = motion.algorithm, np.asarray(seconds, dtype=np.float64)[:, None]
    speed = np.where(_MOVES[algorithm][:, None], motion.velocity, 0.0)
    speed = speed + np.where(_ACCELERATES[algorithm][:, None], motion.acceleration, 0.0) * t
    in_frame = np.einsum("nij,nj->ni", rotation, speed)
    return np.where(_IN_BODY[algorithm][:, None], in_frame, speed)


def _turned(angle: np.ndarray) -> np.ndarray:
    """(n, 3, 3): turned by the rotation vectors ``angle`` (n, 3) [rad]."""
    size = np.linalg.norm(angle, axis=1)
    first = np.sinc(size / np.pi)
    second = 0.5 * np.sinc(0.5 * size / np.pi) ** 2
    x, y, z = angle.T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(-1, 3, 3)
    return np.eye(3) + first[:, None, None] * cross + second[:, None, None] * (cross @ cross)


def _moved_in_body(v: np.ndarray, a: np.ndarray, turning: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(n, 3) [m] in the axes of the body as it was at first: the integral of the velocity ``v`` + ``a`` t,
    which turns with the body. The standard's matrices R1 and R2, applied to vectors."""
    angle = np.linalg.norm(turning, axis=1, keepdims=True) * t
    s, c, u = np.sin(angle), np.cos(angle), angle * angle
    small = np.abs(angle) < _SMALL
    x = np.where(small, 1.0, angle)
    r10 = np.where(small, 1 - u / 6 + u * u / 120, s / x)
    r11 = np.where(small, 1 / 2 - u / 24 + u * u / 720, (1 - c) / x**2)
    r12 = np.where(small, 1 / 6 - u / 120 + u * u / 5040, (angle - s) / x**3)
    r20 = np.where(small, 1 / 2 - u / 8 + u * u / 144, (c + angle * s - 1) / x**2)
    r21 = np.where(small, 1 / 3 - u / 30 + u * u / 840, (s - angle * c) / x**3)
    r22 = np.where(small, 1 / 8 - u / 144 + u * u / 5760, (0.5 * u + 1 - c - angle * s) / x**4)
    w = turning * t
    return t * _apply(w, v, r10, r11, r12) + t * t * _apply(w, a, r20, r21, r22)


def _apply(
    w: np.ndarray, v: np.ndarray, along: np.ndarray, across: np.ndarray, axis: np.ndarray
) -> np.ndarray:
    """``along`` v + ``across`` w × v + ``axis`` w (w · v)."""
    return along * v + across * np.cross(w, v) + axis * w * np.sum(w * v, axis=1, keepdims=True)
