"""A world of the server, watched from another process."""

import asyncio
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("websockets", reason="needs the extra 'serve'")

from websockets.asyncio.client import connect

from runtime import RuntimeInputError
from runtime.traces.recording import level_trace
from runtime.views.served import ServedWorld
from tests.browser import BROWSER, opened
from tests.runtime.server.serving import Client, serving

ROOT = Path(__file__).resolve().parents[3]


def talk(graph, conversation, **options):
    """Run ``conversation(server, client, address)`` against a server."""

    async def main():
        async with serving(graph, **options) as (server, port):
            address = f"ws://127.0.0.1:{port}"
            client = Client(await connect(address, compression=None))
            await client.ask("hello", version=2, token=options.get("token", ""))
            return await conversation(server, client, address)

    return asyncio.run(asyncio.wait_for(main(), 240))


def test_it_is_seen_as_it_is_in_the_server(graph):
    async def conversation(server, client, address):
        name = (await client.ask("create", level="small", clock="manual"))["world"]
        world = server.worlds[name].world
        await client.ask("spawn", world=name, body="human", at=[2, 3, 0], name="ada")
        await client.ask("go_to", world=name, agent="ada", points=[[9, 3, 0]])
        watched = await asyncio.to_thread(ServedWorld, address)

        async def seen(**request):
            if request:
                await client.ask(**request)
            return await asyncio.to_thread(watched.moment)

        level = level_trace(graph)
        for field in ("vertices", "faces", "positions", "radii", "edges", "rim", "normal", "height"):
            assert getattr(watched.level, field) == pytest.approx(getattr(level, field), abs=1e-3), field
        first = await seen()
        ada = world.agents["ada"]
        assert list(first.figures) == ["ada"] and first.figures["ada"].bodies == ada.figure.bodies
        planned = await seen(type="step", world=name, dt=0.1)  # its path is smoothed in the first ticks
        (path,) = planned.paths
        for line, there in ((path.raw, ada.way.raw), (path.smooth, ada.way.points)):
            assert line == pytest.approx(there, abs=1e-3)

        moved = await seen(type="step", world=name, dt=0.5)
        assert moved.time == pytest.approx(0.6) and moved.poses.shape == first.poses.shape
        assert moved.poses == pytest.approx(ada.pose.transforms, abs=1e-3)
        assert moved.paths[0] is path

        await client.ask("go_to", world=name, agent="ada", points=[[9, 1, 0]])
        turned = await seen(type="step", world=name, dt=0.1)
        assert turned.paths[0].smooth[-1] == pytest.approx([9, 1, 0], abs=0.1)
        more = await seen(type="spawn", world=name, body="dog", at=[2, 1, 0], name="rex")
        assert list(more.figures) == ["ada", "rex"] and len(more.paths) == 1
        fewer = await seen(type="remove", world=name, agent="ada")
        assert list(fewer.figures) == ["rex"] and not fewer.paths
        assert await seen(type="close", world=name) is None
        watched.close()

    talk(graph, conversation)


def test_it_says_what_there_is_to_watch(graph):
    async def conversation(server, client, address):
        async def refusal(*arguments):
            with pytest.raises(RuntimeInputError) as error:
                await asyncio.to_thread(ServedWorld, *arguments)
            return str(error.value)

        assert "no world yet" in await refusal(address, None, "s3cret")
        assert "wrong token" in await refusal(address)
        assert "cannot be reached" in await refusal("ws://127.0.0.1:1")
        names = [(await client.ask("create", level="small"))["world"] for _ in range(2)]
        assert ", ".join(names) in await refusal(address, None, "s3cret")
        assert ", ".join(names) in await refusal(address, "mine", "s3cret")

    talk(graph, conversation, token="s3cret")


@pytest.mark.skipif(BROWSER is None, reason="no Chromium here to open the page in")
def test_the_command_shows_it_in_a_browser(graph, tmp_path):
    async def conversation(server, client, address):
        name = (await client.ask("create", level="small", states="none"))["world"]
        await client.ask("spawn", world=name, body="walker", at=[6, 3, 0], name="tom")
        viewer = subprocess.Popen(
            [sys.executable, "-c", "import runtime.cli.app; runtime.cli.app.main()", "view", address],
            cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            line = await asyncio.to_thread(viewer.stdout.readline)
            page = next(word for word in line.split() if word.startswith("http"))
            await asyncio.to_thread(_until_orange, page, tmp_path / "profile")
            await client.ask("close", world=name)
            assert await asyncio.to_thread(viewer.wait, 60) == 0
        finally:
            viewer.kill()

    talk(graph, conversation)


def _until_orange(address, profile):
    """Look at the page until the walker is there; TimeoutError when it does not come."""
    with opened(address, profile, (1200, 450), 100.0) as page:
        assert page is not None
        count = 0
        while count < 15:
            free = page.picture()[:, 330:860]
            count = np.sum((free[..., 0] - free[..., 2] > 0.25) & (free[..., 0] > free[..., 1] + 0.08))
