"""What has changed of a world's agents, for clients that keep what they were told before.

Simulated agents are looked at for each state, recorded ones 60, 30 or 15 times a second by their level of
detail (`locomotion.recorded.changes.moment_of`). Where a person is and its joint angles are channels: whole
numbers of steps that cannot be seen at the distance at which its level is used. A client is told the fields
and the channels that differ from what it was told last.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from locomotion.recorded.changes import STEPS, in_steps, moment_of
from locomotion.recorded.skeletons import FULL, LEVELS
from runtime.world.agent import Agent
from runtime.world.world import World
from surefoot.pausing import pause

__all__ = ["NOTHING", "Changes", "Shown"]

_PLACES = (0.001, 0.004, 0.01)
"""[m] of one step of a place, by level."""

NOTHING: "Mapping[str, Shown]" = {}
"""What a client knows that has just joined."""


@dataclass(frozen=True, eq=False)
class Shown:
    """An agent as it was at a moment. ``moment``: level of detail and number. ``fields``: all of its
    `runtime.server.messages.AgentChange`; ``channels`` (c,) int64 as `runtime.server.messages.Changes` has
    them, None for one that is told by transforms."""

    agent: Agent
    moment: tuple[str, float]
    fields: dict[str, Any]
    channels: NDArray[np.int64] | None


class Changes:
    """Of one world. ``describe`` gives the fields that all kinds of states tell of an agent."""

    def __init__(self, describe: Callable[[Agent], dict[str, Any]]) -> None:
        self._describe = describe
        self._shown: dict[str, Shown] = {}
        self._head = b""
        self._texts: dict[int, bytes] = {}
        self._numbers = count()

    @property
    def newest(self) -> Mapping[str, Shown]:
        """The agents as the newest text tells them. This mapping is never changed afterwards."""
        return self._shown

    def refresh(self, name: str, world: World, anew: bool = False) -> None:
        """Look at the agents of the ``world`` called ``name`` whose moment has come; ``anew``: at all."""
        now, shown = world.time, {}
        for agent in world.agents.values():
            known, moment = self._shown.get(agent.name), _moment(agent, now)
            if anew or known is None or known.agent is not agent or known.moment != moment:
                number = known.fields.get("number") if known is not None and known.agent is agent else None
                known = self._looked_at(agent, moment, number)
                pause()
            shown[agent.name] = known
        self._shown = shown
        self._texts = {}
        self._head = to_json({"type": "changes", "world": name, "time": round(now, 6)})[:-1]

    def text(self, told: Mapping[str, Shown]) -> bytes | None:
        """The message for a client that was told of ``told`` last; the same for all who were. None before the
        first `refresh`."""
        if not self._head:
            return None
        text = self._texts.get(id(told))
        if text is None:
            entries, moved = [], []
            for name, shown in self._shown.items():
                fields, channels = _difference(told.get(name), shown)
                if fields:
                    entries.append({"name": name, **fields})
                if channels is not None:
                    moved.append([shown.fields["number"], *channels])
            text = b'%b,"agents":%b,"moved":%b}' % (self._head, to_json(entries), to_json(moved))
            self._texts[id(told)] = text
        return text

    def _looked_at(self, agent: Agent, moment: tuple[str, float], number: int | None) -> Shown:
        fields, pose = self._describe(agent), agent.driver.joint_pose()
        if pose is None:
            fields["transforms"] = agent.pose.transforms.round(5).ravel().tolist()
            return Shown(agent, moment, fields, None)
        del fields["position"], fields["facing"]
        level = _level(agent)
        place, turn = _PLACES[level], STEPS[level]
        fields["number"] = next(self._numbers) if number is None else number
        fields["steps"] = [place, turn]
        where = np.concatenate([agent.position, pose[:3] - agent.position]) / place
        turns = 2.0 * pose[3:7] / turn
        channels = [*where[:3], agent.facing / turn, *where[3:], *turns, *in_steps(level, pose[7:])]
        return Shown(agent, moment, fields, np.rint(channels).astype(np.int64))


def _level(agent: Agent) -> int:
    return LEVELS.index(agent.level) if agent.level in LEVELS else FULL


def _moment(agent: Agent, now: float) -> tuple[str, float]:
    level = agent.level
    return level, moment_of(LEVELS.index(level), now) if level in LEVELS else now


def _difference(told: Shown | None, shown: Shown) -> tuple[dict[str, Any], list[list[int]] | None]:
    """The fields of ``shown`` that are not as in ``told``, and the indices and values of such channels, None
    if there are none."""
    if told is shown:
        return {}, None
    if told is not None and told.agent is not shown.agent:
        told = None  # another one of the same name
    before = {} if told is None else told.fields
    fields = {key: value for key, value in shown.fields.items() if key not in before or before[key] != value}
    if shown.channels is None:
        return fields, None
    differs = np.ones(len(shown.channels), np.bool_)
    if told is not None and told.channels is not None and "steps" not in fields:
        differs = told.channels != shown.channels
    indices = np.flatnonzero(differs)
    return fields, [indices.tolist(), shown.channels[indices].tolist()] if len(indices) else None
