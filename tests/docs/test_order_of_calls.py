"""The page about the way from an order to the first physics step names what is called, in order."""

import re
import sys
from types import FrameType
from typing import Any

import navmesh
import runtime
from tests.docs import pages
from tests.docs.pages import ROOT

PAGE = ROOT / "docs" / "how-it-works" / "from-order-to-physics.md"
MOST = 15
"""Modules between an order and the first physics step."""


def test_the_modules_are_called_in_the_order_of_the_page() -> None:
    (drawing,) = pages.blocks(PAGE, "text")
    named = re.findall(r"([\w/]+\.py) +([\w.]+)", drawing.text)
    numbers = [int(number) for number in re.findall(r"^ ?(\d+) ", drawing.text, re.MULTILINE)]
    assert len(numbers) == len({module for module, _ in named}) <= MOST
    assert numbers == sorted(numbers)
    calls = iter(_calls())
    for call in named:
        assert call in calls, f"{call} is not called, or not after those before it on the page"


def _calls() -> list[tuple[str, str]]:
    """Module and function of every call from `Agent.go_to` to the first `mj_step`, and that in the end."""
    world = runtime.World(navmesh.Terrain.load(ROOT / "examples/levels/courtyard.obj", up="z"))
    ada = world.spawn("human", at=(6.0, 4.0, 0.0))
    calls: list[tuple[str, str]] = []

    def note(frame: FrameType, event: str, function: Any) -> None:
        file = frame.f_code.co_filename
        if event == "call" and file.startswith(str(ROOT)):
            calls.append((file.removeprefix(f"{ROOT}/"), frame.f_code.co_qualname))
        elif event == "c_call" and function.__name__ == "mj_step":
            sys.setprofile(None)
            calls.append(("mujoco", "mj_step"))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        ada.go_to((46.0, 4.0, 0.3), speed=3.3)
        while calls[-1] != ("mujoco", "mj_step") and world.time < 1.0:
            world.step(0.01)  # some slices of planning, then it sets out
    finally:
        sys.setprofile(before)
    assert calls[-1] == ("mujoco", "mj_step")
    return calls
