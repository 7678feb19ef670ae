"""What a walking person costs on the wire of `surefoot serve`, with each kind of state and level of detail.

    python -m benchmarks.server_states [--seconds 5]

A person walks on a floor of 40 x 40 m, told to a client 60 times a second. Printed are the bytes a second,
without the head of the messages, and the joint angles a second.
"""

import argparse
import json

import numpy as np

import navmesh
from runtime.server.hosted import HostedWorld
from runtime.server.messages import States

SIDE, SPEED, FRAME = 40.0, 1.3, 1.0 / 60.0
LEVELS = ("physics", "full", "medium", "low")
ANGLES = 11  # the first channel that is a joint angle


class Somebody:
    """A client of the world."""


def told(graph: navmesh.NodeGraph, level: str, states: States, seconds: float) -> tuple[float, float]:
    """Bytes and joint angles a second of a person that walks."""
    hosted = HostedWorld("world1", "floor", graph, 1, manual=True)
    client = Somebody()
    hosted.join(states)
    hosted.begin(client, states)  # type: ignore[arg-type]
    hosted.spawn("human", (2.0, 20.0, 0.0), 0.0, "ada", level)
    hosted.go_to("ada", [(38.0, 20.0, 0.0)], SPEED, None)
    hosted.step(2.0)
    hosted.state_for(client)  # type: ignore[arg-type]
    size, angles = 0, 0
    for _ in range(round(seconds / FRAME)):
        hosted.step(FRAME)
        message = json.loads(hosted.state_for(client) or b"{}")  # type: ignore[arg-type]
        for told in [*message["agents"], *message.get("moved", ())]:
            size += len(json.dumps(told, separators=(",", ":"))) + 1
        angles += sum(index >= ANGLES for _, indices, _ in message.get("moved", ()) for index in indices)
    return size / seconds, angles / seconds


def main() -> None:
    """Print all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seconds", type=float, default=5.0)
    seconds = parser.parse_args().seconds
    corners = SIDE * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    graph = navmesh.NodeGraph.build(navmesh.Terrain(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    whole, _ = told(graph, "low", "world", seconds)
    figures = {level: told(graph, level, "changes", seconds) for level in LEVELS}
    print(f"transforms of all bodies: {whole:.0f} bytes/s")
    for level in LEVELS:
        size, angles = figures[level]
        print(f"changes, {level}: {size:.0f} bytes/s, {angles:.0f} joint angles/s; {whole / size:.1f} x less")
    (full, many), (low, few) = figures["full"], figures["low"]
    print(f"low against full: {full / low:.1f} x fewer bytes, {many / few:.1f} x fewer joint angles")


if __name__ == "__main__":
    main()
