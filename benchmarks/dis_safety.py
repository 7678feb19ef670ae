"""DIS under attack and under load: random, cut and mutated packets; hundreds of figures."""

import time
import tracemalloc

import numpy as np

import navmesh
from benchmarks.dis_wireshark import random_pdus
from locomotion.body.person import CONTROL_DT
from runtime import World
from runtime.dis import Exchange, Place
from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import ENTITY_STATE, PART, SIZE, make_records
from runtime.dis.geodesy import LevelFrame, yaw_rotations
from runtime.dis.timestamps import timestamp

__all__ = ["crowd_cost", "fuzz"]

ORIGIN = (48.137, 11.575, 520.0)
GOOD, STRANGER = ("127.0.0.1", 3001), ("127.0.0.1", 6666)


def figures(places: np.ndarray, velocities: np.ndarray, stamp: float) -> list[bytes]:
    """One PDU for each of people at ``places`` (n, 3)."""
    frame, records = LevelFrame(ORIGIN), make_records(len(places))
    records["site"], records["application"] = 1, 9
    records["entity"] = np.arange(1, len(places) + 1)
    records["type"]["kind"], records["type"]["domain"], records["type"]["category"] = 3, 1, 130
    records["location"] = frame.to_geocentric(places)
    records["velocity"] = frame.vectors_to_geocentric(velocities)
    yaws = np.arctan2(velocities[:, 1], velocities[:, 0])
    records["orientation"] = frame.orientations(yaw_rotations(yaws))
    records["appearance"], records["algorithm"] = 2 << 16, MODELS.index("FPW")
    records["timestamp"] = timestamp(stamp, False)
    return [record.tobytes() for record in records]


def fuzz(graph: navmesh.NodeGraph, packets: int, seed: int) -> tuple[int, int, dict[str, int], float]:
    """Bombard a world that knows ten good entities. Returns how many packets raised, how many good entities
    were changed, what the packets were counted as, and how much memory grew [MB] in the second half."""
    chance = np.random.default_rng(seed)
    places = graph.positions[chance.integers(0, len(graph), 10)]
    world, twin = World(graph), World(graph)
    exchanges = [Exchange(each, Place(1, 1, 1), ORIGIN) for each in (world, twin)]
    good = figures(places, np.full((10, 3), [0.3, 0.1, 0.0]), 0.0)
    seeds = [record.tobytes() + parts.tobytes() for record, parts in random_pdus(200, seed)] + good
    raised, begun = 0, 0
    tracemalloc.start()
    for block in range(0, packets, 1000):
        stamp = world.time
        for exchange in exchanges:
            moved = figures(
                places + np.array([0.3, 0.1, 0.0]) * stamp, np.full((10, 3), [0.3, 0.1, 0.0]), stamp
            )
            exchange.receive([(data, GOOD) for data in moved])
        try:
            exchanges[0].receive([(_spoilt(seeds, good, chance), STRANGER) for _ in range(1000)])
        except Exception as error:
            raised += 1
            print(f"raised by a packet of block {block}: {error!r}")
        for each in (world, twin):
            each.step(0.2)
        if block == packets // 2000 * 1000:
            begun = tracemalloc.get_traced_memory()[0]
    grown = tracemalloc.get_traced_memory()[0] - begun
    tracemalloc.stop()
    changed = sum(
        agent.driver.state_hash() != world.agents[name].driver.state_hash()
        for name, agent in twin.agents.items()
    )
    return raised, changed, dict(exchanges[0].counts), grown / 1e6


def _spoilt(seeds: list[bytes], good: list[bytes], chance: np.random.Generator) -> bytes:
    """Random bytes; or a PDU that is cut, lengthened, or has some of its bytes changed; half of these are of
    good entities."""
    kind = chance.integers(0, 4)
    if kind == 0:
        return chance.bytes(int(chance.integers(0, 300)))
    source = good if chance.integers(0, 2) else seeds
    data = bytearray(source[int(chance.integers(0, len(source)))])
    if kind == 1:
        return bytes(data[: int(chance.integers(0, len(data)))])
    if kind == 2:
        data += chance.bytes(int(chance.integers(1, 200)))
    for _ in range(int(chance.integers(1, 8))):
        data[int(chance.integers(0, len(data)))] = int(chance.integers(0, 256))
    if chance.integers(0, 2):  # a header that fits, so that what is behind it is looked at
        data[:4] = bytes([int(chance.integers(5, 8)), 1, 1, 1])
        parts = (len(data) - SIZE) // PART.itemsize
        if parts >= 0:
            data = data[: SIZE + PART.itemsize * parts]
            data[8:10] = len(data).to_bytes(2, "big")
            data[19] = parts & 255
    return bytes(data)


def crowd_cost(graph: navmesh.NodeGraph, count: int, seconds: float, seed: int) -> tuple[float, float, float]:
    """[ms] a frame of 1/60 s for receiving and dead reckoning of ``count`` people that tell of themselves
    once a second: median, 99th percentile; and [ms] for posing all of them."""
    chance = np.random.default_rng(seed)
    starts = graph.positions[chance.integers(0, len(graph), count)]
    headings = chance.uniform(-np.pi, np.pi, count)
    speeds = chance.uniform(0.5, 4.0, count)[:, None] * np.column_stack(
        [np.cos(headings), np.sin(headings), np.zeros(count)]
    )
    world = World(graph)
    exchange = Exchange(world, Place(1, 1, 1), ORIGIN)
    turns, spent, posing = chance.integers(0, 60, count), [], 0.0
    population = None
    for frame in range(round(seconds * 60)):
        now = frame / 60.0
        ones = np.flatnonzero(turns == frame % 60) if frame else np.arange(count)
        every = figures(starts + speeds * now, speeds, now)
        packets = [(every[k], GOOD) for k in ones]
        begun = time.process_time()
        exchange.receive(packets)
        ticks = round((frame + 1) / 60.0 / CONTROL_DT) - round(frame / 60.0 / CONTROL_DT)
        population = population or next(iter(world.agents.values())).driver.population
        for _ in range(ticks):
            population.tick()
        ended = time.process_time()
        world._clock.ticks += ticks
        if frame > 60:
            spent.append(ended - begun)
    begun = time.process_time()
    population.poses()
    posing = time.process_time() - begun
    median, high = np.percentile(spent, [50, 99])
    assert ENTITY_STATE.itemsize == SIZE and len(world.agents) == count
    return 1e3 * float(median), 1e3 * float(high), 1e3 * posing
