"""Routes are what they were."""

import json

import pytest

from tests.navmesh.routes.pinned_routes import NAMES, PINNED, routes


@pytest.mark.parametrize("name", NAMES)
def test_routes_are_what_they_were(name: str) -> None:
    pinned = json.loads(PINNED.read_text())[name]
    for number, (now, before) in enumerate(zip(routes(name), pinned, strict=True)):
        assert now[0] == before[0] and now[2] == before[2], f"query {number}: {before} before, {now} now"
        assert now[1] == pytest.approx(before[1], abs=2e-3), f"query {number}: {before} before, {now} now"
