"""Learning to run: first guess, curriculum and objective."""

import numpy as np

from locomotion import controller as c
from locomotion.skill import RunSkill, run_clip
from locomotion.training.rollout import Scenario, Trial

__all__ = ["cost", "first_guess", "first_state_reference", "scales", "skill_of"]

_SPREAD = np.array([0.1, 1.0, 0.03, 0.3, 0.5, 0.1, 0.05, 0.1, 1.0, 1.0, 0.2, 0.04])
"""Typical deviation of each sensor while running."""


def first_guess() -> np.ndarray:
    """Parameters (p,) float64 from which learning starts: SIMBICON's balance feedback around the clip."""
    x = np.zeros(sum(c.PARAMETERS.values()))
    part = c.parameter_slices()
    m_ap, m_sp = np.zeros((9, c.RANK)), np.zeros((c.RANK, 12))
    sensor = {name: i for i, name in enumerate(c.SENSORS)}
    action = {name: i for i, name in enumerate(c.ACTIONS)}
    m_sp[0, sensor["vx"]], m_sp[0, sensor["dx"]] = 0.15, 0.3
    m_ap[action["swing_hip_flexion"], 0] = 1.0
    m_sp[1, sensor["vy"]], m_sp[1, sensor["dy"]] = 0.2, 0.4
    m_ap[action["swing_hip_abduction"], 1] = 1.0
    m_ap[action["stance_hip_flexion"], 2] = 1.0
    x[part["m_ap"]], x[part["m_sp"]] = m_ap.ravel(), m_sp.ravel()
    x[part["posture"]] = [1.0, 1.0, 0.7, 0.8, 0.1, 0.8, 0.1, 0.5, 0.05]
    x[part["timing"]] = [0.36, 1.0]
    x[part["arms"]] = 1.0
    return x


def scales() -> np.ndarray:
    """How far a parameter may reasonably move, (p,) float64."""
    x = np.ones(sum(c.PARAMETERS.values()))
    part = c.parameter_slices()
    x[part["m_ap"]] = 1.0
    x[part["m_sp"]] = np.tile(0.1 / _SPREAD, c.RANK)
    x[part["posture"]] = [0.5, 0.5, 0.5, 0.5, 0.05, 0.5, 0.05, 0.5, 0.05]
    x[part["a_hat"]] = 0.15
    x[part["feed_forward"]] = 0.3
    x[part["turn"]] = 0.2
    x[part["climb"]] = 0.5
    x[part["timing"]] = [0.06, 0.25]
    x[part["arms"]] = 0.2
    return x


def first_state_reference() -> np.ndarray:
    """Reference sensors over a step, (9, 12) float64, before any running has been seen."""
    phase = np.linspace(0.0, 1.0, 9)
    table = np.zeros((9, 12))
    table[:, 0] = 0.09
    table[:, 2] = 0.93
    table[:, 5] = 0.36 * (phase - 0.28)
    table[:, 11] = 0.06
    return table


def skill_of(knots: np.ndarray, table: np.ndarray, reference: np.ndarray, max_lateral: float = 2.0) -> RunSkill:
    """A skill from its parts, with the product's reference clip."""
    return RunSkill(np.asarray(knots, dtype=np.float64), table, reference, max_lateral, (0.2, 0.4), run_clip())


def cost(trial: Trial, scenario: Scenario, style: float) -> float:
    """Objective of one trial; ``style`` in [0, 1] weighs looks against survival."""
    f = trial.figures
    lost = 1.0 - f["time"] / scenario.duration
    wanted_rate = 2.75 * (0.2 * f["speed"] / 3.5 + 0.8)
    return (
        10.0 * lost
        + 1.0 * f["speed_error"]
        + 1.0 * f["side_drift"]
        + 1.5 * f["heading_error"]
        + 2.0 * f["trunk"]
        + style
        * (
            4.0 * f["reaction"]
            + 0.08 * f["effort"]
            + 0.05 * f["head"]
            + 0.5 * abs(f["step_rate"] - wanted_rate)
        )
    )
