"""Playtests and trainings in one process, in several, and on a cluster: the same bytes, and at what cost?

    python -m benchmarks.cluster [--bots 64] [--seconds 60] [--kills 20] [--memory 10000] [--json FILE]

A playtest of our courtyard and a short training run in one process, in two, on a cluster of two workers, and
on one whose workers are killed at random moments; the results are compared byte for byte. The cost is the
time on two workers over that of two processes, start and end left out. Then a command, its scheduler or a
worker is killed at random moments, ``kills`` times, with the same command called again each time; the last
one has to finish with the same report. ``memory``: of the client at its peak, for
so many bots of two seconds each.
"""

import argparse
import hashlib
import json
import logging
import os
import random
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import psutil

from benchmarks.cluster_tasks import Valley, busy, nothing
from locomotion.training.search.loop import learn
from runtime.playtest import playtest
from surefoot.workers.cluster import ClusterError
from surefoot.workers.pool import Place, worker_pool

COURTYARD = Path(__file__).resolve().parents[1] / "examples" / "levels" / "courtyard.obj"
TASKS, LONG = 64, 0.25  # tasks, and how long each computes [s], to measure what distributing costs


@contextmanager
def scheduler(workers: int) -> Iterator[tuple[str, Callable[[], list[psutil.Process]]]]:
    """A scheduler in a process of its own and ``workers``: its address, and what lists their processes."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        run = [sys.executable, "-m"]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
        head = subprocess.Popen(
            [*run, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
             "--scheduler-file", str(file)], **quiet,
        )  # fmt: skip
        while not file.exists():
            time.sleep(0.1)
        address = json.loads(file.read_text())["address"]
        crew = subprocess.Popen(
            [*run, "distributed.cli.dask_worker", address, "--nthreads", "1", "--nworkers", str(workers),
             "--no-dashboard", "--local-directory", folder], **quiet,
        )  # fmt: skip
        try:
            yield address, lambda: [each for each in psutil.Process(crew.pid).children() if is_worker(each)]
        finally:
            for process in (crew, head):
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def is_worker(process: psutil.Process) -> bool:
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.Error:
        return False


@contextmanager
def killing(
    workers: Callable[[], list[psutil.Process]], every: float, rng: random.Random
) -> Iterator[list[int]]:
    """Kill one of the ``workers`` now and then until the block ends; gives the number of kills."""
    over, killed = threading.Event(), [0]

    def kill() -> None:
        while not over.wait(rng.uniform(0.5 * every, 1.5 * every)):
            alive = workers()
            if alive:
                rng.choice(alive).kill()
                killed[0] += 1

    thread = threading.Thread(target=kill)
    thread.start()
    try:
        yield killed
    finally:
        over.set()
        thread.join()


def digest(text: str | bytes) -> str:
    return hashlib.sha256(text if isinstance(text, bytes) else text.encode()).hexdigest()[:16]


def played(bots: int, seconds: float, place: Place) -> str:
    """Digest of the report."""
    here = {"cluster": place} if isinstance(place, str) else {"processes": place}
    outcome = playtest(COURTYARD, bots=bots, seconds=seconds, seed=7, **here)
    return digest(json.dumps(outcome.report.to_dict()))


def learned(place: Place) -> str:
    """Digest of what a short training learns."""
    result = learn(Valley(), 3, workers=place, on_progress=lambda _: None)
    assert result is not None
    return digest(result.tobytes())


def cost(place: Place) -> float:
    """[s] that `TASKS` tasks take once the workers are there."""
    with worker_pool(place, nothing, ()) as workers:
        workers.map(busy, [0.01] * 8, chunksize=1)
        begun = time.perf_counter()
        workers.map(busy, [LONG] * TASKS, chunksize=1)
        return time.perf_counter() - begun


def interrupted(kills: int, bots: int, seconds: float, rng: random.Random) -> dict[str, Any]:
    """Kill a playtest's command, its scheduler or a worker at a random moment and call it again, ``kills``
    times: whether the report is right in the end, and how often there was a wrong one before."""
    wanted = played(bots, seconds, 1)
    asked = [sys.executable, "-m", "surefoot", "playtest", str(COURTYARD), "--seed", "7"]
    asked += ["--bots", str(bots), "--seconds", str(seconds)]
    victims = {"client": 0, "scheduler": 0, "worker": 0}
    torn = 0
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        while sum(victims.values()) < kills:
            with scheduler(2) as (address, workers):
                command = subprocess.Popen(
                    [*asked, "--cluster", address, "--out", str(out)], start_new_session=True,
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                )  # fmt: skip
                time.sleep(rng.uniform(1.0, 14.0))
                victim = rng.choice(list(victims))
                victims[victim] += 1
                if victim == "worker" and workers():
                    rng.choice(workers()).kill()
                    command.wait()
                elif victim == "client":
                    command.kill()
                    command.wait()
            if victim == "scheduler":  # it has just gone, and the workers with it
                command.wait()
            report = out / "report.json"
            if report.exists():
                torn += digest(json.dumps(json.loads(report.read_text()))) != wanted
                report.unlink()
        subprocess.run([*asked, "--out", str(out)], capture_output=True, check=False)
        whole = digest(json.dumps(json.loads((out / "report.json").read_text()))) == wanted
        left = sorted(each.name for each in out.iterdir())
    return {"kills": victims, "torn": torn, "the same in the end": whole, "left": left}


def client_memory(bots: int) -> float:
    """[MB] that a process of its own holds at its peak, with so many bots of two seconds each."""
    script = (
        "import resource, sys; from runtime.playtest import playtest; "
        f"playtest({str(COURTYARD)!r}, bots={bots}, seconds=2.0, seed=7); "
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return float(done.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bots", type=int, default=64)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--memory", type=int, nargs="*", default=[100, 1000, 10000])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="write every figure here")
    options = parser.parse_args()
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    rng = random.Random(options.seed)
    report: dict[str, Any] = {}

    def row(name: str, place: Place) -> None:
        report[name] = played(options.bots, options.seconds, place), learned(place)
        print(f"{name:26} report {report[name][0]}, learned {report[name][1]}", flush=True)

    row("one process", 1)
    row("two processes", 2)
    with scheduler(2) as (address, workers):
        row("cluster of two workers", address)
        with killing(workers, 4.0, rng) as killed:
            row("its workers killed", address)
        print(f"{killed[0]} workers were killed")
    same = len({tuple(each) for each in report.values()}) == 1
    print("the same bytes" if same else "NOT the same bytes")
    with scheduler(2) as (address, _):
        ratios = [cost(address) / cost(2) for _ in range(7)]
    report["cost"] = float(np.median(ratios))
    print(
        f"{TASKS} tasks of {LONG} s on a cluster of two workers over two processes: "
        f"{np.median(ratios):.3f} ({min(ratios):.3f} to {max(ratios):.3f} of seven)"
    )
    if options.kills:
        report["interrupted"] = interrupted(options.kills, options.bots, options.seconds, rng)
        print(f"killed and called again: {report['interrupted']}")
    for bots in options.memory:
        report[f"memory of {bots}"] = client_memory(bots)
        print(f"{bots} bots: {report[f'memory of {bots}']:.0f} MB at its peak in the client", flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1))
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    try:
        main()
    except ClusterError as error:
        sys.exit(str(error))
