"""How much one client of the server slows the others down, as ratios of times in one run.

    python -m benchmarks.server_fairness [--people 15 60 240] [--asks 300] [--json fairness.json]

The server is a separate process with a floor of 40 x 40 m. A light client steps a world with one dog by one
tick at a time, alone and then beside a heavy client, which has walking people in its own world and keeps
requesting steps of a second. Measured is the light client's wait by number of people. Then heavy clients
request paths through 64 points, and leave in the middle of a step with as many worlds as allowed. Exit code 0
if the light client waits at most 10 times as long on average, whatever the number of people; with two
clients, an equal share would be twice as long.
"""

import argparse
import asyncio
import json
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import numpy as np

from benchmarks.server_fuzz import Client, greeted, serving

SIDE = 40.0  # [m]
GROWTH = 10.0  # of the mean wait
KINDS = ("mean", "median", "p99", "most")
PARALLEL = 4  # who leave worlds behind


def floor() -> str:
    return f"v 0 0 0\nv {SIDE} 0 0\nv {SIDE} {SIDE} 0\nv 0 {SIDE} 0\nf 1 2 3\nf 1 3 4\n"


async def waits(light: Client, world: str, asks: int) -> np.ndarray:
    """[ms] until each of ``asks`` steps of a tick is answered."""
    taken = []
    for _ in range(asks):
        begun = time.perf_counter()
        await light.ask("step", world=world, dt=0.01)
        taken.append(1e3 * (time.perf_counter() - begun))
    return np.array(taken)


async def crowd_of(client: Client, people: int) -> str:
    """A world in which so many people walk."""
    world = (await client.ask("create", level="floor", clock="manual", states="none"))["result"]["world"]
    side = int(np.ceil(np.sqrt(people)))
    for number in range(people):
        x, y = (1.0 + (SIDE - 2.0) * k / side for k in divmod(number, side))
        name = f"p{number}"
        made = await client.ask("spawn", world=world, body="human", at=[x, y, 0], name=name)
        if "result" not in made:
            raise SystemExit(f"the server refuses: {made['message']}")
        await client.ask("go_to", world=world, agent=name, points=[[SIDE - x, SIDE - y, 0]], speed=1.2)
    return world


async def while_(light: Client, world: str, asks: int, bother) -> tuple[np.ndarray, np.ndarray]:
    """The light client's waits before ``bother`` goes on, and while it does."""
    alone = await waits(light, world, asks)
    bothering = asyncio.ensure_future(bother)
    await asyncio.sleep(0.5)
    taken = await waits(light, world, asks)
    bothering.cancel()
    with suppress(asyncio.CancelledError):
        await bothering
    return alone, taken


async def steps(client: Client, world: str) -> None:
    while True:
        await client.ask("step", world=world, dt=1.0)


async def long_ways(client: Client, world: str) -> None:
    """Send a person through 64 points, again and again."""
    points = [[1 + (SIDE - 2) * (k % 2), 1 + (SIDE - 2) * k / 63, 0] for k in range(64)]
    while True:
        await client.ask("go_to", world=world, agent="p0", points=points)


async def leavers(address: str) -> None:
    """Make as many worlds as one may, have one person in each, and leave in the middle of a step."""

    async def one() -> None:
        while True:
            client, worlds = await greeted(address), []
            while "result" in (
                made := await client.ask("create", level="floor", clock="manual", states="none")
            ):
                worlds.append(made["result"]["world"])
                await client.ask("spawn", world=worlds[-1], body="human", at=[5, 5, 0])
            for number, world in enumerate(worlds):
                await client.socket.send(
                    json.dumps({"type": "step", "id": number, "world": world, "dt": 1.0})
                )
            client.socket.transport.abort()

    await asyncio.gather(*(one() for _ in range(PARALLEL)))


async def measure(address: str, counts: list[int], asks: int) -> dict:
    light = await greeted(address)
    world = (await light.ask("create", level="floor", clock="manual", states="none"))["result"]["world"]
    await light.ask("spawn", world=world, body="dog", at=[2, 3, 0], name="rex")
    await light.ask("go_to", world=world, agent="rex", points=[[SIDE - 2, SIDE - 3, 0]])
    await waits(light, world, asks)
    rows = {}
    for people in counts:
        heavy = await greeted(address)
        crowd = await crowd_of(heavy, people)
        label = f"steps of {people} people"
        rows[label] = await while_(light, world, asks, steps(heavy, crowd))
        await heavy.socket.close()
    heavy = await greeted(address)
    rows["ways through 64 points"] = await while_(
        light, world, asks, long_ways(heavy, await crowd_of(heavy, 1))
    )
    await heavy.socket.close()
    rows["worlds left behind"] = await while_(light, world, asks, leavers(address))
    late = await greeted(address)
    created = await late.ask("create", level="floor", clock="manual", states="none")
    found = {
        name: [
            dict(zip(KINDS, (row.mean(), *np.percentile(row, [50, 99]), row.max()), strict=True))
            for row in both
        ]
        for name, both in rows.items()
    }
    return {"waits_ms": found, "late_one_creates": "result" in created}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--people", type=int, nargs="+", default=[15, 60, 240])
    parser.add_argument("--asks", type=int, default=300)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        level = Path(folder) / "floor.obj"
        level.write_text(floor())
        with serving(level) as (address, _):
            found = asyncio.run(measure(address, options.people, options.asks))
    rows = found["waits_ms"]
    print(
        f"{'':24}{''.join(f'{kind:>9}' for kind in KINDS)} [ms]; how many times that of it alone just before"
    )
    for name, (alone, row) in rows.items():
        times = "".join(f"{row[kind] / alone[kind]:9.1f}" for kind in KINDS)
        print(f"{name:24}{''.join(f'{row[kind]:9.2f}' for kind in KINDS)} {times}")
    print(f"after that another client {'can' if found['late_one_creates'] else 'cannot'} create a world")
    both = [rows[f"steps of {people} people"] for people in options.people]
    held = all(during["mean"] <= GROWTH * alone["mean"] for alone, during in both)
    held = held and found["late_one_creates"]
    if options.json:
        options.json.write_text(json.dumps({**found, "held": held}, indent=1) + "\n")
    sys.exit(not held)


if __name__ == "__main__":
    main()
