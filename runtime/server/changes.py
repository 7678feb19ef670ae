"""What has changed of a world's agents, for clients that keep what they were told before.

Simulated agents are looked at for each state, recorded ones 60, 30 or 15 times a second by their level of
detail (`locomotion.recorded.changes.moment_of`). A person's joint angles are whole numbers of a step that
cannot be seen at the distance at which its level is used. A client is told the fields and the angles that
differ from what it was told last.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from locomotion.recorded.changes import STEPS, changes, in_steps, moment_of
from locomotion.recorded.skeletons import FULL, LEVELS
from runtime.world.agent import Agent
from runtime.world.world import World
from surefoot.pausing import pause

__all__ = ["NOTHING", "Changes", "Shown"]

_DECIMALS = (4, 4, 3)
"""Of the root's position [m] and quaternion, by level."""


NOTHING: "Mapping[str, Shown]" = {}
"""What a client knows that has just joined."""


@dataclass(frozen=True, eq=False)
class Shown:
    """An agent as it was at a moment. ``moment``: level of detail and number. ``fields``: all of its
    `runtime.server.messages.AgentChange` but for the angles; ``angles`` (j,) int16 in multiples of ``step``
    [rad], None for one that is told by transforms."""

    agent: Agent
    moment: tuple[str, float]
    fields: dict[str, Any]
    angles: NDArray[np.int16] | None
    step: float


class Changes:
    """Of one world. ``describe`` gives the fields that all kinds of states tell of an agent."""

    def __init__(self, describe: Callable[[Agent], dict[str, Any]]) -> None:
        self._describe = describe
        self._shown: dict[str, Shown] = {}
        self._head = b""
        self._texts: dict[int, bytes] = {}

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
                known = self._looked_at(agent, moment)
                pause()
            shown[agent.name] = known
        self._shown = shown
        self._texts = {}
        self._head = to_json({"type": "changes", "world": name, "time": now})[:-1]

    def text(self, told: Mapping[str, Shown]) -> bytes | None:
        """The message for a client that was told of ``told`` last; the same for all who were. None before the
        first `refresh`."""
        if not self._head:
            return None
        text = self._texts.get(id(told))
        if text is None:
            entries = []
            for name, shown in self._shown.items():
                entry = _difference(told.get(name), shown)
                if entry:
                    entries.append({"name": name, **entry})
            text = self._texts[id(told)] = b'%b,"agents":%b}' % (self._head, to_json(entries))
        return text

    def _looked_at(self, agent: Agent, moment: tuple[str, float]) -> Shown:
        fields, pose = self._describe(agent), agent.driver.joint_pose()
        if pose is None:
            fields["transforms"] = agent.pose.transforms.round(5).ravel().tolist()
            return Shown(agent, moment, fields, None, 1.0)
        level = _level(agent)
        fields["root"] = pose[:7].round(_DECIMALS[level]).tolist()
        return Shown(agent, moment, fields, in_steps(level, pose[7:]), STEPS[level])


def _level(agent: Agent) -> int:
    return LEVELS.index(agent.level) if agent.level in LEVELS else FULL


def _moment(agent: Agent, now: float) -> tuple[str, float]:
    level = agent.level
    return level, moment_of(LEVELS.index(level), now) if level in LEVELS else now


def _difference(told: Shown | None, shown: Shown) -> dict[str, Any]:
    """The fields of ``shown`` that are not as in ``told``."""
    if told is shown:
        return {}
    if told is not None and told.agent is not shown.agent:
        told = None  # another one of the same name
    before = {} if told is None else told.fields
    entry = {key: value for key, value in shown.fields.items() if key not in before or before[key] != value}
    if shown.angles is not None:
        same_steps = told is not None and told.step == shown.step
        update = changes(told.angles if told is not None and same_steps else None, shown.angles)
        if update is not None:
            entry["angles"] = {
                "step": shown.step, "indices": update.indices.tolist(), "values": update.values.tolist()
            }  # fmt: skip
    return entry
