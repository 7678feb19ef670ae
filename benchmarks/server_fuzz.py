"""A million wrong messages, and fifty clients at once: does the server hold up?

    python -m benchmarks.server_fuzz [--messages 1000000] [--clients 50] [--seconds 20] [--json server.json]

The server is a separate process with a small floor. First fifty clients each request, at 60 Hz, a step of
their own world with a moving dog; response times are printed, and sequence numbers show that answers and
events came completely and in order. Then eight clients send malformed, cut, oversized and out-of-order
messages, and valid ones with one value of a wrong type (one in 500 is too long and ends the connection, which
is opened again), while a ninth steps a world. Finally attacks: floods of pings, pings and requests whose
answers nobody reads, silent connections, and paths to files. Exit code 0 if nothing was lost, no wrong type
passed, the ninth was always served, no file was found, the server logged no more than 100 lines and its
memory grew by no more than 64 MB.
"""

import argparse
import asyncio
import json
import os
import random
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

ROOT = Path(__file__).resolve().parents[1]
FLOOR = "v 0 0 0\nv 12 0 0\nv 12 6 0\nv 0 6 0\nf 1 2 3\nf 1 3 4\n"
START = "import runtime.cli.app; runtime.cli.app.main()"
GROWTH = 64.0  # [MB]
LINES = 100  # of the log
STATE = b'{"type":"state"'  # of which a client gets the newest only, without a number
GOOD = [
    {"type": "spawn", "id": 1, "world": "world1", "body": "dog", "at": [2, 3, 0], "facing": 0.1},
    {"type": "go_to", "id": 2, "world": "world1", "agent": "rex", "points": [[3, 3, 0]], "speed": 1},
    {"type": "join", "id": 3, "world": "world2", "states": "local"},
    {"type": "restore", "id": 4, "world": "world999"},
    {"type": "hello", "id": 5, "version": 2},
    {"type": "step", "id": 6, "world": "world999", "dt": 0.01},
]


TYPED = [
    {
        "type": "spawn",
        "id": 1,
        "world": "{world}",
        "body": "dog",
        "at": [2, 3, 0],
        "facing": 0.1,
        "name": "new",
    },
    {"type": "go_to", "id": 2, "world": "{world}", "agent": "rex", "points": [[3, 3, 0]], "speed": 1.5},
    {"type": "join", "id": 3, "world": "{world}", "states": "local"},
    {"type": "step", "id": 4, "world": "{world}", "dt": 0.01},
    {"type": "create", "id": 5, "level": "floor", "seed": 1, "clock": "manual"},
    {"type": "hello", "id": 6, "version": 2, "token": ""},
    {"type": "level", "id": 7, "level": "floor"},
]  # whose every value is given another type


@contextmanager
def serving(
    level: Path, *options: str, log: Path | None = None
) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """A server of ``level`` in a process of its own: its address, and the process. ``log``: where its
    messages go."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with open(log or os.devnull, "w") as errors:
        server = subprocess.Popen(
            [sys.executable, "-c", START, "serve", str(level), "--port", "0", *options],
            env=environment, stdout=subprocess.PIPE, stderr=errors, text=True,
        )  # fmt: skip
        try:
            assert server.stdout is not None
            yield server.stdout.readline().split()[-1], server
        finally:
            server.terminate()
            server.wait(30)


class Client:
    """Asks, and checks that no answer or event is missing or out of order."""

    def __init__(self, socket) -> None:
        self.socket, self.seq, self.id = socket, 0, 0

    async def ask(self, kind: str, **fields) -> dict:
        self.id += 1
        await self.socket.send(json.dumps({"type": kind, "id": self.id, **fields}))
        async with asyncio.timeout(60):
            while True:
                text = await self.socket.recv(decode=False)
                if text.startswith(STATE):
                    continue
                message = json.loads(text)
                self.seq += 1
                if message["seq"] != self.seq:
                    raise SystemExit(f"message {self.seq} came as {message['seq']}")
                if message.get("id") == self.id:
                    return message


async def greeted(address: str) -> Client:
    client = Client(await connect(address, compression=None, max_size=None))
    await client.ask("hello", version=2)
    return client


def malformed(rng: random.Random, good: Sequence[Mapping]) -> str | bytes:
    """A message that is wrong in some way, made of ``good`` ones."""
    text = bytearray(json.dumps(rng.choice(good)).encode())
    way = rng.randrange(5)
    if way == 0:
        return bytes(text[: rng.randrange(len(text))]).decode(errors="ignore")
    if way == 1:
        return rng.randbytes(rng.randrange(200))
    if way == 2:
        for _ in range(rng.randrange(1, 6)):
            text[rng.randrange(len(text))] = rng.randrange(256)
        return bytes(text).decode(errors="ignore")
    if way == 3:
        return rng.choice(['{"id":1' * 300, "[" * 5000, "null", "", '{"id":NaN}', '{"type":[]}', "1e999"])
    return json.dumps({**rng.choice(good), **rng.choice(good), "id": rng.choice([-1, "x", None, 1e300])})


def wrong(rng: random.Random, number: int) -> str | bytes:
    """A malformed message; or one that comes at a wrong time; or, one in 500, one that is too long."""
    if number % 500 == 499:
        return "x" * 70_000
    if rng.randrange(6) == 0:
        return json.dumps({**rng.choice(GOOD[3:]), "id": rng.randrange(2**40)})
    return malformed(rng, GOOD)


async def latencies(address: str, clients: int, seconds: float) -> np.ndarray:
    """[ms] from asking for a step to its answer, of all clients."""

    async def one(number: int) -> list[float]:
        client = await greeted(address)
        world = (await client.ask("create", level="floor", clock="manual", states="world"))["result"]["world"]
        await client.ask("spawn", world=world, body="dog", at=[2, 3, 0], name="rex")
        await client.ask("go_to", world=world, agent="rex", points=[[10, 3, 0]])
        taken, due = [], time.perf_counter() + number / clients / 60
        for _ in range(round(60 * seconds)):
            await asyncio.sleep(max(due - time.perf_counter(), 0.0))
            begun = time.perf_counter()
            await client.ask("step", world=world, dt=1 / 60)
            taken.append(1e3 * (time.perf_counter() - begun))
            due = max(due + 1 / 60, begun)
        await client.ask("close", world=world)
        await client.socket.close()
        return taken

    return np.concatenate(await asyncio.gather(*(one(number) for number in range(clients))))


async def flood(address: str, count: int, seed: int, done: list[int]) -> None:
    """Send wrong messages, each answered by an error or the end of the connection."""
    rng, client, unanswered = random.Random(seed), await greeted(address), 0
    for number in range(count):
        try:
            await client.socket.send(wrong(rng, number))
            unanswered += 1
            if unanswered >= 64:
                while unanswered:
                    unanswered -= "seq" in json.loads(await asyncio.wait_for(client.socket.recv(), 60))
        except ConnectionClosed:
            client, unanswered = await greeted(address), 0
        done[0] += 1
    await client.socket.close()


async def fuzz(address: str, messages: int, pid: int) -> dict:
    other = await greeted(address)
    world = (await other.ask("create", level="floor", clock="manual", states="places"))["result"]["world"]
    done, ticks, slowest, sizes = [0], 0, 0.0, []
    floods = [asyncio.ensure_future(flood(address, messages // 8, seed, done)) for seed in range(8)]
    while not all(each.done() for each in floods):
        begun = time.perf_counter()
        ticks += (await other.ask("step", world=world, dt=0.01))["result"]["ticks"]
        slowest = max(slowest, time.perf_counter() - begun)
        if done[0] > len(sizes) * messages // 10:
            sizes.append(memory(pid))
            print(f"{done[0]:9} messages, {sizes[-1]:6.1f} MB", flush=True)
        await asyncio.sleep(0.05)
    await asyncio.gather(*floods)
    served = round((await other.ask("step", world=world, dt=0.01))["result"]["time"] / 0.01) == ticks + 1
    sizes.append(memory(pid))
    return {
        "messages": done[0], "memory_mb": sizes, "other_served": served, "other_steps": ticks,
        "other_slowest_ms": 1e3 * slowest,
    }  # fmt: skip


async def types(address: str) -> list[str]:
    """Messages that passed although one of their values is of a wrong type."""
    client, passed = await greeted(address), []
    world = (await client.ask("create", level="floor", clock="manual", states="none"))["result"]["world"]
    await client.ask("spawn", world=world, body="dog", at=[2, 3, 0], name="rex")
    for good in TYPED:
        for field in [key for key in good if key not in ("type", "id")]:
            right = world if good[field] == "{world}" else good[field]
            for value in mistyped(right):
                whole = {**good, field: value}
                if "world" in good and field != "world":
                    whole["world"] = world
                kind = whole.pop("type")
                whole.pop("id")
                if "result" in await client.ask(kind, **whole):
                    passed.append(f"{kind} {field} {value!r}")
    return passed


def mistyped(right) -> list:
    """Values of other types that say the same, or nearly."""
    if isinstance(right, list):
        inner = [[each, *right[1:]] for each in mistyped(right[0])]
        return [*inner, dict(enumerate(right)), json.dumps(right), right[0], True]
    if isinstance(right, str):
        return [[right], {right: right}, 1, True, 0.5]
    whole = [float(right)] if isinstance(right, int) and right in (0, 1) else []
    return [str(right), True, False, [right], {"value": right}, *(whole if right == 1 else [])]


async def attacks(address: str) -> None:
    """Whatever takes memory, time or the log, from connections that want no answers."""

    async def flood_of_pings(read: bool) -> None:
        for _ in range(20):
            with suppress(ConnectionClosed, OSError):
                client = await greeted(address)
                if not read:
                    client.socket.transport.pause_reading()
                for number in range(5000):
                    await client.socket.ping(f"{number:0125}")
                client.socket.transport.abort()

    async def unread() -> None:
        client = await greeted(address)
        client.socket.transport.pause_reading()
        with suppress(ConnectionClosed, TimeoutError):
            async with asyncio.timeout(10):
                for number in range(100_000):
                    await client.socket.send(json.dumps({"type": "graph", "id": number, "level": "floor"}))
                    await asyncio.sleep(0)
        client.socket.transport.abort()

    async def silent() -> None:
        sockets = []
        for _ in range(200):
            with suppress(Exception):
                sockets.append(await connect(address, compression=None))
        for socket in sockets:
            socket.transport.abort()

    await asyncio.gather(*(flood_of_pings(read) for read in (True, False) for _ in range(4)))
    await asyncio.gather(*(unread() for _ in range(4)))
    await silent()


def pages_found(address: str, folder: Path) -> list[str]:
    """Paths of a folder that are served and should not be."""
    secrets = [".git/config", ".env", "code.py", "key.pem", ".hidden/page.html", "out.html"]
    outside = folder.parent / "outside.html"
    outside.write_text("no")
    for name in secrets[:-1]:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("no")
    (folder / "out.html").symlink_to(outside)
    found = []
    for path in [*secrets, "../outside.html", "%2e%2e/outside.html", ".%67it/config", "//etc/passwd"]:
        with (
            suppress(urllib.error.HTTPError),
            urllib.request.urlopen(f"http{address[2:]}/{path}", timeout=20),
        ):
            found.append(path)
    return found


def memory(pid: int) -> float:
    """Resident memory of a process [MB]."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--messages", type=int, default=1_000_000)
    parser.add_argument("--clients", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        level, pages, log = (Path(folder) / name for name in ("floor.obj", "pages", "log"))
        level.write_text(FLOOR)
        pages.mkdir()
        with serving(level, "--pages", str(pages), log=log) as (address, server):
            taken = asyncio.run(latencies(address, options.clients, options.seconds))
            p50, p99 = np.percentile(taken, [50, 99])
            print(
                f"{options.clients} clients at 60 Hz: {len(taken)} answers, none lost or out of order; ",
                end="",
            )
            print(f"p50 {p50:.1f} ms, p99 {p99:.1f} ms, slowest {taken.max():.1f} ms", flush=True)
            found = asyncio.run(fuzz(address, options.messages, server.pid))
            passed = asyncio.run(types(address))
            asyncio.run(attacks(address))
            served = pages_found(address, pages)
            found["memory_mb"].append(memory(server.pid))
            alive = server.poll() is None
        lines = len(log.read_text().splitlines())
    growth = found["memory_mb"][-1] - found["memory_mb"][0]
    print(
        f"{found['messages']} wrong messages: memory grew by {growth:.1f} MB; the other client was served ",
        end="",
    )
    print(f"{found['other_steps']} times, at the slowest in {found['other_slowest_ms']:.0f} ms")
    print(f"wrong types that passed: {', '.join(passed) or 'none'}; files: {', '.join(served) or 'none'}")
    print(f"{lines} lines in the log")
    held = alive and found["other_served"] and growth <= GROWTH
    held = held and not passed and not served and lines <= LINES
    if options.json:
        result = {"p50_ms": p50, "p99_ms": p99, "answers": len(taken), **found, "held": held}
        result |= {"wrong_types": passed, "files": served, "log_lines": lines}
        options.json.write_text(json.dumps(result, indent=1) + "\n")
    sys.exit(not held)


if __name__ == "__main__":
    main()
