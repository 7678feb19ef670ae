"""Map motion of the full figure to one of fewer joints, offline.

As in section 3.2 of Granieri, Crabtree and Badler (1995): a first guess for each joint (a copy, or the sum of
the joints that it stands for), then inverse kinematics that brings landmarks of the slave to those of the
master, most important first: a hand on a held object before the feet, and these before a free hand. Where a
landmark misses its tolerance, there is a warning. The solver is that of `mink` (``pip install
surefoot[record]``).

Each frame is solved from where the one before it ended, and held near its guess, so that the slave moves as
smoothly as its master. A cycle is gone through twice, so that its end meets its beginning.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES, JOINT_NAMES, person_spec
from locomotion.errors import LocomotionError
from locomotion.recorded.skeletons import Skeleton

__all__ = [
    "HELD_TOLERANCE", "LANDMARKS", "TOLERANCES", "Landmark", "Slaved", "guessed", "landmarks_of",
    "matched", "slaved",
]  # fmt: skip

TOLERANCES = {"full": 1e-6, "medium": 0.01, "low": 0.03}
"""[m] by which a landmark may miss that of the master, by level."""
HELD_TOLERANCE = 0.005
"""[m] the same of a hand on a held object."""
_HELD, _FOOT, _HAND, _HINT = 30.0, 5.0, 3.0, 0.5  # costs of missing, per m; a hint may be missed
_LIMBS, _TRUNK = 0.06, 1.0  # costs of leaving the guess, per rad
_ITERATIONS, _STILL = 60, 1e-4  # [rad] change in an iteration that ends the search
_DAMPING, _CAUTION = 1e-4, 1.0  # of a step, and in proportion to how far a landmark is off
_FARTHER = 0.3  # [rad]
_CLEARLY = 0.5  # share of a miss to which a fresh start has to bring it, if the motion is to jump for it


@dataclass(frozen=True)
class Landmark:
    """A point of the body called ``body``, in its frame [m]."""

    name: str
    body: str
    point: tuple[float, float, float]


LANDMARKS = tuple(
    Landmark(f"{side}_{name}", f"{side}_{body}", point)
    for side in ("right", "left")
    for name, body, point in (
        ("hand", "hand", HAND_POINT),
        ("heel", "foot", (-0.032, 0.0, -0.064)),
        ("ball", "foot", (0.118, 0.0, -0.064)),
        ("foot", "foot", (0.043, 0.0, -0.064)),
    )
)
"""What is matched: both hands where they hold something; the soles at heel and ball, or, by a figure that
cannot turn its foot out, in the middle between them."""


def matched(slave: Skeleton) -> tuple[bool, ...]:
    """Which of `LANDMARKS` the slave has to match; the others are hints, or are left out."""
    turns = "right_hip_rotation" in slave.channels
    left_out = "foot" if turns else ("heel", "ball")
    return tuple(not landmark.name.endswith(left_out) for landmark in LANDMARKS)


@dataclass(frozen=True, eq=False)
class Slaved:
    """``channels`` (n, c) of the slave [rad]; ``missed`` (n, 8) [m], how far each of `LANDMARKS` is from the
    master's; ``warnings``: those beyond their tolerance, in words."""

    channels: NDArray[np.float64]
    missed: NDArray[np.float64]
    warnings: tuple[str, ...]


def guessed(qpos: NDArray[np.float64], slave: Skeleton) -> NDArray[np.float64]:
    """The first guess, channels (n, c), for frames (n, 46) of the master: where the slave has no chest, its
    waist turns as far as waist and chest together."""
    joints = qpos[:, 7:].copy()
    if "chest" not in slave.bodies:
        for turn in ("pitch", "roll", "yaw"):
            joints[:, JOINT_NAMES.index(f"waist_{turn}")] += joints[:, JOINT_NAMES.index(f"chest_{turn}")]
    return joints[:, slave.joints]


def landmarks_of(qpos: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where `LANDMARKS` are, as seen from the pelvis, in frames (n, 46) of the person: (n, 8, 3) [m]."""
    model = figure()
    data, out = mujoco.MjData(model), np.empty((len(qpos), len(LANDMARKS), 3))
    bodies = [model.body(landmark.body).id for landmark in LANDMARKS]
    points = np.array([landmark.point for landmark in LANDMARKS])
    for k, frame in enumerate(qpos):
        data.qpos[:7], data.qpos[7:] = [0, 0, 0, 1, 0, 0, 0], frame[7:]
        mujoco.mj_kinematics(model, data)
        turned = Rotation.from_quat(data.xquat[bodies], scalar_first=True).apply(points)
        out[k] = data.xpos[bodies] + turned
    return out


def slaved(
    qpos: NDArray[np.float64],
    slave: Skeleton,
    held: Sequence[str] = (),
    name: str = "",
    rate: float = 60.0,
    cyclic: bool = False,
) -> Slaved:
    """Map frames (n, 46) of the full figure to ``slave``; ``cyclic``: the first follows the last.

    ``held``: landmarks that hold an object, such as "right_hand". ``name`` of the motion and its ``rate``
    [Hz] are used in warnings. Raises `LocomotionError` if mink is not installed, or for an unknown landmark.
    """
    known = [landmark.name for landmark in LANDMARKS]
    for each in held:
        if each not in known:
            raise LocomotionError(f"landmark {each!r}: valid: {', '.join(known)}")
    channels, targets = guessed(qpos, slave), landmarks_of(qpos)
    if slave.name != "full":
        solver = _solver(slave)
        channels = channels.clip(*solver.model.jnt_range.T)
        guesses, last = channels, channels[0]
        channels = guesses.copy()
        for k in [*range(len(qpos)), *range(len(qpos) if cyclic else 0)]:
            channels[k], off = solver.solved(last, guesses[k], targets[k], held)
            if off > TOLERANCES[slave.name]:  # it may have gone astray
                afresh, still_off = solver.solved(guesses[k], guesses[k], targets[k], held)
                if still_off < _CLEARLY * off:
                    channels[k] = afresh
            last = channels[k]
    roots = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (len(qpos), 1))
    missed = np.linalg.norm(landmarks_of(slave.as_qpos(channels, roots)) - targets, axis=2)
    return Slaved(channels, missed, _warnings(missed, slave, held, name, rate))


def _warnings(
    missed: NDArray[np.float64], slave: Skeleton, held: Sequence[str], name: str, rate: float
) -> tuple[str, ...]:
    found = []
    for landmark, off, counts in zip(LANDMARKS, missed.T, matched(slave), strict=True):
        if not counts:
            continue
        most = HELD_TOLERANCE if landmark.name in held else TOLERANCES[slave.name]
        if off.max() > most:
            share, at = (off > most).mean(), int(off.argmax()) / rate
            found.append(
                f"{name}, {slave.name}: {landmark.name} misses by up to {100 * off.max():.1f} cm, at "
                f"{at:.2f} s ({100 * most:g} cm are allowed; {share:.0%} of the frames miss them)"
            )
    return tuple(found)


class _Solver:
    """Inverse kinematics of one slave, with its pelvis held."""

    def __init__(self, slave: Skeleton) -> None:
        try:
            import mink
        except ImportError as error:
            raise LocomotionError("mapping motion needs mink: pip install surefoot[record]") from error
        self.mink: Any = mink
        spec = person_spec()
        for things in (spec.actuators, spec.equalities):
            for thing in list(things):
                spec.delete(thing)
        for joint in list(spec.joints):
            if joint.name not in slave.channels:
                spec.delete(joint)
        for name in BODY_NAMES[:1]:
            spec.body(name).pos = [0.0, 0.0, 0.0]
        for landmark in LANDMARKS:
            spec.body(landmark.body).add_site(name=f"landmark {landmark.name}", pos=landmark.point)
        self.model = spec.compile()
        # a joint that stands for several may turn farther than it does in a person
        low, high = self.model.jnt_range.T
        self.model.jnt_range[:] = np.stack([low - _FARTHER, high + _FARTHER], axis=1).clip(-np.pi, np.pi)
        self.configuration = mink.Configuration(self.model)
        self.tasks = [
            mink.FrameTask(
                f"landmark {landmark.name}",
                "site",
                position_cost=1.0,
                orientation_cost=0.0,
                lm_damping=_CAUTION,
            )
            for landmark in LANDMARKS
        ]
        trunk = [name.startswith(("waist", "chest", "neck")) for name in slave.channels]
        self.posture = mink.PostureTask(self.model, cost=np.where(trunk, _TRUNK, _LIMBS))
        self.matched = matched(slave)
        self.limits = [mink.ConfigurationLimit(self.model)]

    def solved(
        self,
        start: NDArray[np.float64],
        guess: NDArray[np.float64],
        targets: NDArray[np.float64],
        held: Sequence[str],
    ) -> tuple[NDArray[np.float64], float]:
        """Channels (c,) that bring the landmarks to ``targets`` (8, 3) and are near a ``guess`` (c,), from a
        ``start`` (c,); and how far the worst landmark that counts is off [m]."""
        mink = self.mink
        self.posture.set_target(guess)
        self.configuration.update(start)
        for landmark, task, target, counts in zip(LANDMARKS, self.tasks, targets, self.matched, strict=True):
            free = _HAND if landmark.name.endswith("hand") else _FOOT if counts else _HINT
            task.set_position_cost(_HELD if landmark.name in held else free)
            task.set_target(mink.SE3.from_translation(target))
        for _ in range(_ITERATIONS):
            step = mink.solve_ik(
                self.configuration, [*self.tasks, self.posture], 1.0, "daqp", _DAMPING, limits=self.limits
            )
            self.configuration.integrate_inplace(step, 1.0)
            if np.abs(step).max() < _STILL:
                break
        off = [
            float(np.linalg.norm(self.configuration.data.site(task.frame_name).xpos - target))
            for task, target, counts in zip(self.tasks, targets, self.matched, strict=True)
            if counts
        ]
        return self.configuration.q.copy(), max(off)


@cache
def _solver(slave: Skeleton) -> _Solver:
    return _Solver(slave)
