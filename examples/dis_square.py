"""Two simulators share a square: each moves half of the people, and each shows all of them in a browser.

    python examples/dis_square.py [--seconds 60]

starts both, which talk by DIS on this machine, and prints the addresses of their pages. Needs the extra
'dis'. ``--half 1`` or ``--half 2`` starts one of them alone, say to let another simulator be the other.
"""

import argparse
import subprocess
import sys
import time

import numpy as np

import navmesh
import runtime
from runtime.dis import Gateway, Options

SIDE, PEOPLE = 20.0, 6  # [m], in each half
ORIGIN = (48.1372, 11.5755, 519.0)  # [°], [°], [m]: Marienplatz in Munich
PORTS = (3001, 3002)
POSTURES = ("kneel", "sit", "crouch", "stand", "stand")


def square() -> navmesh.NodeGraph:
    """A flat square with a fountain in the middle."""
    half, pool = 0.5 * SIDE, 1.5
    ring = [(-half, -half), (half, -half), (half, half), (-half, half)]
    inner = [(-pool, -pool), (pool, -pool), (pool, pool), (-pool, pool)]
    corners = [(x, y, 0.0) for x, y in ring + inner]
    faces = []
    for here in range(4):
        there = (here + 1) % 4
        faces += [(here, there, 4 + here), (there, 4 + there, 4 + here)]
    return navmesh.NodeGraph.build(navmesh.Terrain.from_arrays(corners, faces))


def half(number: int, seconds: float) -> None:
    """Run one half in real time."""
    world, chance = runtime.World(square(), seed=number), np.random.default_rng(number)
    people = []
    while len(people) < PEOPLE:
        place = chance.uniform(-0.45 * SIDE, 0.45 * SIDE, 2)
        if np.abs(place).max() > 2.5:
            people.append(world.spawn("human", (*place, 0.0), name=f"p{number}{len(people)}", detail="full"))
    rests = [float(chance.uniform(0.0, 3.0)) for _ in people]
    listen, to = PORTS[number - 1], PORTS[2 - number]
    options = Options(listen=("127.0.0.1", listen))
    with (
        Gateway(world, number, 1, 1, ORIGIN, ("127.0.0.1", to), options) as gateway,
        runtime.LiveView(world) as view,
    ):
        print(f"half {number}: {view.address}", flush=True)
        begun = time.monotonic()
        while world.time < seconds:
            world.step(1 / 60)
            gateway.exchange()
            view.show()
            for k, person in enumerate(people):
                if not person.moving and world.time >= rests[k]:
                    rests[k] = world.time + float(chance.uniform(4.0, 9.0))
                    if chance.uniform() < 0.3:
                        person.take_posture(str(chance.choice(POSTURES)))
                    else:
                        goal = chance.uniform(-0.45 * SIDE, 0.45 * SIDE, 2)
                        person.go_to((*goal, 0.0), speed=float(chance.choice([1.2, 1.6, 3.0])))
            time.sleep(max(begun + world.time - time.monotonic(), 0.0))
        others = [agent for agent in world.agents.values() if agent.body == "remote"]
        print(f"half {number}: {len(people)} of ours and {len(others)} of the other's", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Two simulators share a square, by DIS.")
    parser.add_argument("--half", type=int, choices=(1, 2))
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    if options.half:
        half(options.half, options.seconds)
        return
    command = [sys.executable, __file__, "--seconds", str(options.seconds), "--half"]
    halves = [subprocess.Popen([*command, str(number)]) for number in (1, 2)]
    for each in halves:
        each.wait()


if __name__ == "__main__":
    main()
