"""Which of our agents have to be told of, and what: thresholds, changes of appearance, heartbeats, the end.

A sender dead-reckons what it told last just as a receiver does. It tells anew when that is off by more than a
threshold.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from runtime.bodies.registry import kind_of
from runtime.dis.appearance import Appearance, appearance_of
from runtime.dis.dead_reckoning import MODELS, Motion, reckoned
from runtime.dis.entity_state import make_records
from runtime.dis.enumerations import Force, LifeForm
from runtime.dis.geodesy import LevelFrame, yaw_rotations
from runtime.world.agent import Agent
from runtime.world.world import World

__all__ = ["Identity", "Outgoing", "Thresholds"]

_HALF_LIFE = 0.25
"""[s] of the averages that are sent for velocity and heading: strides sway and turn a body to and fro, which
is not where it is going."""
_STATIC, _MOVES, _TURNS = MODELS.index("static"), MODELS.index("FPW"), MODELS.index("RPW")
_TURNING = 0.15  # [rad/s] of a turn that is worth telling


@dataclass(frozen=True)
class Thresholds:
    """When to tell of an agent again. ``position`` [m] and ``orientation`` [rad] that a receiver may be off;
    ``heartbeat`` [s] after which to tell all the same, ``spread`` the share by which that differs."""

    position: float = 1.0
    orientation: float = float(np.radians(3.0))
    heartbeat: float = 5.0
    spread: float = 0.1


@dataclass(frozen=True)
class Identity:
    """What our entities have in common. ``site`` and ``application`` (0 to 65534) name this simulator in its
    ``exercise`` (1 to 255); ``version``: 5, 6 or 7; ``types``: entity types by
    body, in place of those of `BodyKind.entity_type`."""

    site: int
    application: int
    exercise: int
    version: int = 7
    force: int = Force.NEUTRAL
    types: Mapping[str, tuple[int, ...]] = field(default_factory=dict)

    def type_of(self, body: str) -> tuple[int, ...]:
        """Kind, domain, country, category, subcategory, specific, extra of a body."""
        return self.types.get(body) or kind_of(body).entity_type(body)


class _Told:
    """What is remembered of an agent: averages, and what it was last told as."""

    def __init__(self, number: int, agent: Agent) -> None:
        self.number, self.agent = number, agent
        self.place, self.velocity = agent.position, np.zeros(3)
        self.yaw, self.turning = agent.facing, 0.0
        self.looks, self.appearance = Appearance(), -1
        self.motion = Motion.empty(1)
        self.due = self.since = 0.0
        self.told = False

    def follow(self, seconds: float) -> None:
        """Take note of where the agent is ``seconds`` [s] later."""
        place, keep = self.agent.position, 0.5 ** (seconds / _HALF_LIFE)
        self.velocity = keep * self.velocity + (1.0 - keep) * (place - self.place) / seconds
        self.place = place
        before, off = self.yaw, _wrapped(self.agent.facing - self.yaw)
        self.yaw = _wrapped(before + (1.0 - keep) * off)
        self.turning = keep * self.turning + (1.0 - keep) * _wrapped(self.yaw - before) / seconds
        self.looks = appearance_of(self.agent, float(np.linalg.norm(self.velocity)), self.looks.life_form)


class Outgoing:
    """Makes the PDUs of a world's own agents. Equal worlds and seeds give equal PDUs, but for absolute
    timestamps."""

    def __init__(
        self, world: World, frame: LevelFrame, identity: Identity, thresholds: Thresholds, seed: int = 0
    ) -> None:
        self._world, self._frame, self._identity, self._limits = world, frame, identity, thresholds
        self._known: dict[str, _Told] = {}
        self._chance = np.random.default_rng(seed)
        self._numbers = 0
        self._last = -1.0

    def due(self) -> np.ndarray:
        """(k,) of `ENTITY_STATE`: what has to be told now, without timestamps. Call it after each step."""
        now, seconds = self._world.time, self._world.time - self._last
        if seconds == 0.0:
            return make_records(0)
        if seconds < 0.0:  # the world has gone back
            self._known = {name: self._anew(told) for name, told in self._known.items()}
            seconds = 0.0
        self._last = now
        ours = {
            name: agent for name, agent in self._world.agents.items() if not agent.driver.comes_from_elsewhere
        }
        gone = [self._known.pop(name) for name in tuple(self._known) if self._left(name, ours)]
        for name, agent in ours.items():
            known = self._known.get(name)
            if known is None:
                self._numbers = self._numbers % 65534 + 1
                self._known[name] = _Told(self._numbers, agent)
            elif seconds > 0.0:
                known.follow(seconds)
        changed = self._changed(list(self._known.values()), now)
        records = [self._record(told, now) for told in changed]
        records += [self._record(told, now, deactivated=True) for told in gone]
        return _joined(records)

    def leave(self) -> np.ndarray:
        """(k,) of `ENTITY_STATE`: that all are gone."""
        gone, self._known = list(self._known.values()), {}
        return _joined([self._record(told, self._last, deactivated=True) for told in gone])

    def _anew(self, told: _Told) -> _Told:
        return _Told(told.number, told.agent)

    def _left(self, name: str, ours: Mapping[str, Agent]) -> bool:
        return name not in ours or ours[name] is not self._known[name].agent

    def _changed(self, known: list[_Told], now: float) -> list[_Told]:
        """Those that have to be told of."""
        if not known:
            return []
        motion = Motion.empty(len(known))
        for row, told in enumerate(known):
            motion.put(np.array([row]), told.motion)
        since = np.array([told.since for told in known])
        places, rotations = reckoned(motion, now - since)
        off = np.linalg.norm(places - np.array([told.place for told in known]), axis=1)
        headings = np.arctan2(rotations[:, 1, 0], rotations[:, 0, 0])
        turned = np.array([_wrapped(told.yaw - each) for told, each in zip(known, headings, strict=True)])
        far = (off > self._limits.position) | (np.abs(turned) > self._limits.orientation)
        return [
            told
            for told, beyond in zip(known, far, strict=True)
            if beyond or not told.told or now >= told.due or told.looks.bits != told.appearance
        ]

    def _record(self, told: _Told, now: float, deactivated: bool = False) -> np.ndarray:
        """(1,) of `ENTITY_STATE`; remembers that it was told."""
        moves = told.looks.life_form is not LifeForm.STANDING and not deactivated
        turns = abs(told.turning) > _TURNING and not deactivated
        model = _TURNS if turns else _MOVES if moves else _STATIC
        velocity = told.velocity[None] if moves else np.zeros((1, 3))
        turning = np.array([[0.0, 0.0, -told.turning if turns else 0.0]])
        told.motion = Motion(
            np.array([model]),
            told.place[None],
            yaw_rotations(np.array([told.yaw])),
            velocity,
            np.zeros((1, 3)),
            turning,
        )
        told.since, told.told = now, True
        spread = self._limits.spread
        told.due = now + self._limits.heartbeat * float(self._chance.uniform(1.0 - spread, 1.0 + spread))
        told.appearance = told.looks.bits
        identity, record = self._identity, make_records(1, self._identity.version, self._identity.exercise)
        record["site"], record["application"] = identity.site, identity.application
        record["entity"], record["force"] = told.number, identity.force
        for kind in ("type", "alternative_type"):
            record[kind] = identity.type_of(told.agent.body)
        record["location"] = self._frame.to_geocentric(told.motion.position)
        record["velocity"] = self._frame.vectors_to_geocentric(velocity)
        record["orientation"] = self._frame.orientations(told.motion.rotation)
        record["algorithm"], record["angular_velocity"] = model, turning
        record["appearance"] = replace(told.looks, deactivated=deactivated).bits
        record["marking"] = told.agent.name.encode("ascii", "replace")[:11]
        return record


def _joined(records: list[np.ndarray]) -> np.ndarray:
    """Records one after the other; `numpy.concatenate` would turn their bytes round."""
    joined = make_records(len(records))
    for row, record in enumerate(records):
        joined[row] = record[0]
    return joined


def _wrapped(angle: float) -> float:
    """[rad, -π to π)"""
    return float((angle + np.pi) % (2.0 * np.pi) - np.pi)
