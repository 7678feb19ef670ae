"""Obstacles that recorded people clear: a recorded skill, warped to the obstacle's size.

A person runs up to where the recording takes off, in its gait, and plays the recording from there. Before the
edge and behind the landing it goes as recorded, so that feet stand where they stood; what lies between is as
wide as the real obstacle, and the whole figure is lifted by what that is higher, while it is over it::

    skill = recorded_skills(motions)["vault"]             # `locomotion.recorded_people.recorded_skills`
    moment = skill.moment(crossing, 0.4)                  # [s] of the recording, 0.4 s after it began
    pose = skill.pose(motions, LOW, crossing, moment)     # (46,)

All of it is a function of the time since it began.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.recorded.footfalls import FEET
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.posing import posed
from locomotion.recorded.sampling import sample_clips
from locomotion.recorded.skeletons import FULL, LEVELS, skeleton
from locomotion.recorded_people.crossing import Crossing
from locomotion.recorded_people.hand_holds import HandHold, hand_of, with_hand_at

__all__ = ["RecordedSkill", "out_of_the_floor"]

_FASTEST = 3.4  # [m/s] of a run-up
_GAINS = 3.0  # [m/s²]
_SLOWEST = 0.8  # [m/s] at which it begins
_RATES = (0.6, 1.1)  # least and greatest rate at which a take-off is played
_CADENCE, _HASTE, _LATE, _EARLY = 1.65, (0.65, 1.6), 0.05, 0.4
# cycles a second at the end of a run-up; least and greatest haste; [s] before its end, too late to hasten;
# cycles by which steps are slowed down at most
_INSIDE = 0.03  # [m] from a wall's sides to a hand on it
_REACHES = 0.15  # [s] in which a hand comes to what it holds on to, and goes back
_SPRING = 0.12  # [s] before leaving the ground in which one makes ready for what is higher


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


@dataclass(frozen=True)
class RecordedSkill:
    """A clip of a skill, and when what happens in it [s]: ``begins`` to be played, ``leaves`` the ground,
    ``crosses`` the edge with the first foot, has ``passed`` the obstacle with the last, ``lands``, and
    ``ends``. ``lead``: [m] before the edge at which it begins. ``edge``, ``depth``, ``size``: of its own
    obstacle, from the clip's begin [m]. ``sideways``: y at begin and end [m]. ``pace``: at the
    begin [m/s]. ``phase``: of a gait's cycle that it goes on from: 0 or 0.5, the right or the left foot
    strikes. ``holds``: when hands rest on the obstacle."""

    clip: int
    crossing: str
    begins: float
    leaves: float
    crosses: float
    passed: float
    lands: float
    ends: float
    lead: float
    edge: float
    depth: float
    size: float
    sideways: tuple[float, float]
    pace: float
    phase: float
    holds: tuple[HandHold, ...] = ()

    # --- the run-up
    def haste(self, of: Crossing, elapsed: float, phase: float, cadence: float) -> float | None:
        """How many times as quick a person's steps have to be to be in step with the skill at the end of its
        run-up: it is in this ``phase`` and takes so many cycles a second now. None shortly before that."""
        left = self.run_up(of, elapsed)[2]
        if left < _LATE:
            return None
        cycles = left * 0.5 * (cadence + _CADENCE)
        off = (self.phase - phase - cycles + _EARLY) % 1.0 - _EARLY  # rather quicker than slower
        return min(max((cycles + off) / cycles, _HASTE[0]), _HASTE[1])

    def run_up(self, of: Crossing, elapsed: float) -> tuple[NDArray[np.float64], float, float]:
        """Where a person is ``elapsed`` [s] after its run-up has begun, x and y [m]; its speed [m/s]; and for
        how long it still runs [s], 0 or less when it takes off."""
        begin, target = np.array(of.origin[:2]), np.array(of.edge[:2]) - self._lead(of) * of.way
        length = float(np.linalg.norm(target - begin))
        slow = max(of.origin[3], _SLOWEST)
        fast = max(slow, _FASTEST)
        until = (fast - slow) / _GAINS
        to = slow * until + 0.5 * _GAINS * until * until
        if length <= to:
            seconds = (math.sqrt(slow * slow + 2.0 * _GAINS * length) - slow) / _GAINS
        else:
            seconds = until + (length - to) / fast
        at = min(max(elapsed, 0.0), seconds)
        gone = slow * min(at, until) + 0.5 * _GAINS * min(at, until) ** 2 + fast * max(at - until, 0.0)
        share = gone / length if length > 1e-6 else 1.0
        return begin + share * (target - begin), min(slow + _GAINS * at, fast), seconds - elapsed

    def _lead(self, of: Crossing) -> float:
        return min(self.lead, math.dist(of.start[:2], of.edge[:2]))

    # --- the skill
    def _clock(self, of: Crossing) -> tuple[list[float], list[float]]:
        """Seconds since it began, and moments of the clip: between these it is played evenly."""
        entry = self.run_up(of, math.inf)[1]
        rate = min(max(entry / self.pace, _RATES[0]), _RATES[1])
        # falls take longer by the root of their height, and leaps by that of their width
        flies = math.sqrt(self._share(of)) if self.crossing in ("off", "across") else 1.0
        moments = [self.begins, self.leaves, self.lands, self.ends]
        lasts = [
            (self.leaves - self.begins) / rate,
            (self.lands - self.leaves) * flies,
            self.ends - self.lands,
        ]
        return [0.0, *np.cumsum(lasts).tolist()], moments

    def _share(self, of: Crossing) -> float:
        return of.size / self.size

    def seconds(self, of: Crossing) -> float:
        """[s] from the end of the run-up until it goes on in its gait."""
        return self._clock(of)[0][-1]

    def moment(self, of: Crossing, elapsed: float) -> float:
        """[s] of the clip, ``elapsed`` [s] after the end of the run-up."""
        return float(np.interp(elapsed, *self._clock(of)))

    def _along(self, of: Crossing, x: float) -> float:
        """[m] behind the real edge, of what is at ``x`` [m] in the clip."""
        ahead = x - self.edge
        if ahead <= 0.0:
            return ahead * self._lead(of) / self.lead
        deep = {"over": of.depth, "across": of.size}.get(self.crossing, 0.0)
        if ahead < self.depth:
            return ahead * deep / self.depth
        return ahead - self.depth + deep

    def _lifted(self, of: Crossing, moment: float, size: float) -> float:
        """[m] by which a figure of a ``size`` is higher than in the clip, over the floor at its start."""
        up, own = of.end[2] - of.start[2], size * self.size
        if self.crossing == "onto":
            return (up - own) * _ramp(moment, self.leaves - _SPRING, self.crosses)
        if self.crossing == "over":
            more = of.size - own
            rises = more * _ramp(moment, self.leaves - _SPRING, self.crosses)
            return rises + (up - more) * _ramp(moment, self.passed, self.lands)
        if self.crossing == "off":
            fallen = (moment - self.off) / (self.lands - self.off)
            return (up + own) * min(max(fallen, 0.0), 1.0) ** 2
        return up * _ramp(moment, self.leaves, self.lands)

    def pose(
        self, motions: MotionSet, level: int, of: Crossing, moment: float, size: float = 1.0
    ) -> NDArray[np.float64]:
        """(46,) pose of a person of a ``level`` of detail and a ``size`` at a ``moment`` of the clip [s]."""
        sample = sample_clips(motions, level, [self.clip], [moment])
        pose = skeleton(LEVELS[level]).as_qpos(*sample)[0]
        beside = pose[1] - np.interp(moment, (self.begins, self.ends), self.sideways)
        x, y = self._point(of, float(pose[0]), moment)
        c, s = of.way
        pose[:2] = x - s * beside, y + c * beside
        pose[2] = size * pose[2] + of.start[2] + self._lifted(of, moment, size)
        half_c, half_s = math.cos(0.5 * of.heading), math.sin(0.5 * of.heading)
        w, i, j, k = pose[3:7]
        pose[3:7] = (
            half_c * w - half_s * k,
            half_c * i - half_s * j,
            half_c * j + half_s * i,
            half_c * k + half_s * w,
        )
        return pose

    def on_its_hands(
        self,
        motions: MotionSet,
        of: Crossing,
        moment: float,
        pose: NDArray[np.float64],
        look: tuple[int, float],
    ) -> NDArray[np.float64]:
        """``pose`` (46,) at a ``moment`` [s], with hands on the top of the obstacle that rest on it in the
        clip: where they come down, or next to it. ``look``: level and size of the person."""
        level, size = look
        for hold in self.holds:
            share = _ramp(moment, hold.first - _REACHES, hold.first)
            share -= _ramp(moment, hold.last, hold.last + _REACHES)
            if share <= 0.0:
                continue
            then = self.pose(motions, level, of, 0.5 * (hold.first + hold.last), size)
            point = hand_of(then, hold.side, size)
            ahead = float((point[:2] - of.edge[:2]) @ of.way)
            point[:2] += (min(max(ahead, _INSIDE), of.depth - _INSIDE) - ahead) * of.way
            point[2] = of.start[2] + of.size
            pose = with_hand_at(pose, hold.side, point, share, size)
        return pose

    def _point(self, of: Crossing, x: float, moment: float) -> tuple[float, float]:
        """x and y [m] of what is at ``x`` [m] in the clip."""
        along = self._along(of, x)
        if moment > self.lands and along > of.last:
            along = of.last
        px, py = (np.array(of.edge[:2]) + along * of.way).tolist()
        return px, py

    @property
    def off(self) -> float:
        """[s] when no foot bears any more before the edge, and one is over it."""
        return max(self.leaves, self.crosses)

    def floor(self, of: Crossing, moment: float) -> tuple[float, float]:
        """Height [m] of the floor that its feet are on at a ``moment``, and how firmly they are, 0 to 1."""
        if moment < self.off:
            return of.start[2], 1.0 - _ramp(moment, self.off - _SPRING, self.off)
        return of.end[2], _ramp(moment, self.lands, self.lands + 0.5 * _SPRING)

    def place(self, motions: MotionSet, of: Crossing, moment: float) -> NDArray[np.float64]:
        """(3,) the floor under it, or where that would be [m]."""
        x = float(sample_clips(motions, FULL, [self.clip], [moment])[1][0, 0])
        height = of.start[2] + (of.end[2] - of.start[2]) * _ramp(moment, self.crosses, self.lands)
        return np.array([*self._point(of, x, moment), height])


def out_of_the_floor(
    pose: NDArray[np.float64], floor: float, firmly: float, size: float = 1.0
) -> NDArray[np.float64]:
    """``pose`` (46,) of a figure of a ``size``, lifted so far that no toe is under a ``floor`` [m], or by a
    share of that, ``firmly``: a pose that fades into another may sink in."""
    if firmly <= 0.0:
        return pose
    own = skeleton("full")
    bodies = posed(own, pose[None, 7 + own.joints], pose[None, :7])[0]
    toes = [own.bodies.index(name) for name in ("right_toes", "left_toes", *FEET)]
    sunk = floor - float(pose[2] + size * (bodies[toes, 2].min() - pose[2]))
    if sunk > 0.0:
        pose = pose.copy()
        pose[2] += firmly * sunk
    return pose


def _ramp(moment: float, first: float, last: float) -> float:
    return _smooth((moment - first) / max(last - first, 1e-3))
