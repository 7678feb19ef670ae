"""What is saved of an agent is looked at before anybody goes on from it."""

import math
from dataclasses import replace

import pytest

from runtime.errors import RuntimeInputError
from runtime.traffic.waiting_and_deadlock import Headway
from runtime.world.agent_state import AgentState, Errand

GOAL = (4.0, 2.0, 0.0)
ERRAND = Errand((GOAL,), 3.5)
STATE = AgentState("human", 0.0, None, False, GOAL, ERRAND, Headway())


def test_what_an_agent_saves_passes():
    STATE.check("ann")
    replace(STATE, style={"size": 1.05}).check("ann")


@pytest.mark.parametrize(
    ("changed", "reason"),
    [
        ({"born": math.nan}, "not finite"),
        ({"goal": (math.inf, 0.0, 0.0)}, "not finite"),
        ({"errand": Errand((GOAL,), 0.0)}, "nobody can do"),
        ({"errand": replace(ERRAND, attempts=-1)}, "nobody can do"),
        ({"errand": replace(ERRAND, waits=True)}, "waits for nothing"),
        ({"headway": Headway(since=math.nan)}, "no number"),
        ({"style": {"height": 1.0}}, "the style of 'ann'"),
    ],
)
def test_what_no_agent_can_have_saved_is_refused(changed, reason):
    with pytest.raises(RuntimeInputError, match=reason):
        replace(STATE, **changed).check("ann")
