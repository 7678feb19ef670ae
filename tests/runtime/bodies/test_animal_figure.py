"""What animals look like: shapes on bones, the same on both sides, with the paws on the ground."""

import numpy as np
import pytest

from locomotion.quadruped import BODY_NAMES, load_body
from runtime import World
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.figure import rotate


def lowest(shapes):
    """(m,) [m] the lowest point of each shape."""
    down = rotate(shapes.place[:, 3:] * [1, -1, -1, -1], np.array([[0.0, 0.0, -1.0]] * len(shapes.size)))
    ellipsoid = np.linalg.norm(shapes.size * down, axis=1)
    capsule = shapes.size[:, 0] + shapes.size[:, 1] * np.abs(down[:, 2])
    return shapes.place[:, 2] - np.where(shapes.round, ellipsoid, capsule)


@pytest.mark.parametrize("name", BODY_NAMES)
def test_it_stands_on_the_ground_on_four_paws(name, graph):
    agent = World(graph).spawn(name, (5.0, 3.0, 0.0))
    shapes = agent.figure.posed(agent.pose.transforms)
    below = lowest(shapes)
    paws = [agent.figure.bodies[k].endswith("_foot") for k in agent.figure.owner]
    size = load_body(name).trunk.chest
    assert below.min() > -0.5 * size
    by_leg = {agent.figure.bodies[k]: 9.0 for k in agent.figure.owner[paws]}
    for owner, low in zip(agent.figure.owner, below, strict=True):
        if agent.figure.bodies[owner] in by_leg:
            by_leg[agent.figure.bodies[owner]] = min(by_leg[agent.figure.bodies[owner]], low)
    assert len(by_leg) == 4 and max(by_leg.values()) < 0.1 * size


@pytest.mark.parametrize("name", BODY_NAMES)
def test_left_is_as_right(name):
    figure = animal_figure(load_body(name))

    def of(side):
        rows = [k for k, owner in enumerate(figure.owner) if side in figure.bodies[owner]]
        return np.hstack([figure.shapes.place[rows], figure.shapes.size[rows], figure.shapes.colour[rows]])

    assert len(of("left")) == 8 and np.array_equal(of("left"), of("right"))
    ears = figure.shapes.place[[figure.bodies[k] == "head" for k in figure.owner], 1]
    assert ears.sum() == pytest.approx(0.0) and (ears > 0.0).sum() == 1


def test_bones_are_as_long_as_the_body_file_says():
    body = load_body("dog")
    figure = animal_figure(body)
    rows = [figure.bodies[k] == "neck" for k in figure.owner]
    (neck,) = figure.shapes.size[rows]
    assert 2.0 * neck[1] == pytest.approx(body.neck.length)
    assert figure.shapes.colour.max() == pytest.approx(max(body.colour))
