"""How strained a walk is, and that only strained steps are rehearsed."""

import math

import numpy as np
import pytest

from locomotion import Human
from locomotion.body import observed as seen
from locomotion.gaits.walk.layout import (
    CLOCK,
    DOUBLE,
    PHASE,
    SIDEWAYS,
    SINGLE,
    STAIRS_AHEAD,
    STRAINS,
    WALK_SPEED,
    WALK_STANCE,
    new_walk,
)
from locomotion.gaits.walk.strain import STRAINED, USUAL, note_strain, slope_ahead, strain
from locomotion.ground.ground import Ground
from locomotion.human.state import MOVING
from locomotion.paths.command import COMMAND_SIZE, SLOPE_THERE
from locomotion.rehearsal.choices import REHEARSALS


@pytest.mark.parametrize("stance", [-1.0, 1.0])
@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_it_is_how_far_the_velocity_is_off_and_the_slope(stance, heading):
    walk, command, observed = new_walk(heading), np.zeros(COMMAND_SIZE), np.zeros(seen.OBSERVED_SIZE)
    walk[[WALK_STANCE, WALK_SPEED, SIDEWAYS]] = stance, 1.0, 0.2
    ahead = np.array([math.cos(heading), math.sin(heading)])
    left = np.array([-ahead[1], ahead[0]])

    def moving(along, outward, up):
        observed[seen.COM_VELOCITY] = *(along * ahead + (0.2 + stance * outward) * left), up
        return strain(walk, observed, command)

    assert moving(0.83, 0.11, -0.03) == pytest.approx(0.0, abs=1e-12)
    assert moving(0.53, 0.11, -0.03) == pytest.approx(0.3) == moving(1.13, 0.11, -0.03)
    assert moving(0.83, 0.51, -0.33) == pytest.approx(0.5)
    command[SLOPE_THERE], walk[STAIRS_AHEAD] = -0.3, 0.2
    assert moving(0.53, 0.11, -0.03) == pytest.approx(0.6) and slope_ahead(walk, command) == 0.3
    walk[STAIRS_AHEAD] = 0.5
    assert moving(0.53, 0.11, -0.03) == pytest.approx(0.8)


def test_it_is_noted_when_a_foot_comes_down():
    walk, command, observed = new_walk(), np.zeros(COMMAND_SIZE), np.zeros(seen.OBSERVED_SIZE)
    for phase, clock in ((SINGLE, 0.0), (DOUBLE, 0.01)):
        walk[[PHASE, CLOCK]] = phase, clock
        note_strain(walk, observed, command)
        assert not walk[STRAINS].any()
    walk[[PHASE, CLOCK]] = DOUBLE, 0.0
    note_strain(walk, observed, command)
    first = strain(walk, observed, command)
    assert walk[STRAINS].tolist() == [first, 0.0]
    observed[seen.COM_VELOCITY] = 1.0, 0.0, 0.0
    note_strain(walk, observed, command)
    assert (
        walk[STRAINS].tolist() == [strain(walk, observed, command), first] and first < 1.0 < walk[STRAINS][0]
    )


def ramp(slope):
    corners = np.array([[x, y, slope * x] for x in (-9.0, 9.0) for y in (-5.0, 5.0)])
    return Ground.from_arrays(corners, np.array([[0, 2, 3], [0, 3, 1]]))


def rehearsed(slope, monkeypatch):
    """Strains at the steps of a person that walks up a slope, and for which of them it asked."""
    strains, asked, best = [], [], None
    human = Human(ramp(slope), clearing=(), rehearsals=REHEARSALS)
    best = human.decider.best
    monkeypatch.setattr(human.decider, "best", lambda *choice: (asked.append(human.ticks), best(*choice))[1])
    human.reset((-5.0, 0.0, -5.0 * slope), 0.0)
    human.follow([[x, 0.0, slope * x] for x in np.linspace(-5.0, 3.0, 33)], 1.0)
    while human.status in MOVING and human.time < 12.0:
        human.tick()
        if human.on_feet.begins_step and human.on_feet.on_uneven_ground:
            strains.append(float(human.on_feet.walk[STRAINS][0]))
    return np.array(strains), asked


def test_who_walks_steadily_up_a_ramp_does_not_rehearse_it(monkeypatch):
    strains, asked = rehearsed(math.tan(math.radians(10.0)), monkeypatch)
    assert len(strains) > 10 and np.median(strains) == pytest.approx(USUAL + 0.176, abs=0.15)
    assert len(asked) <= 0.3 * len(strains)


def test_who_walks_up_a_steep_slope_rehearses_it(monkeypatch):
    strains, asked = rehearsed(0.6, monkeypatch)
    assert np.median(strains) > STRAINED and len(asked) >= 1
