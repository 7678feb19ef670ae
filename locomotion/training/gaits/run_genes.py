"""The parameters that training to run changes: genes, from which a table of the run's parameters by speed is
made."""

import numpy as np

from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, run_clip
from locomotion.training.gaits.run_trials import MIDDLE

__all__ = [
    "BLOCKS",
    "DOWN",
    "KNOTS",
    "LEVEL",
    "SIZE",
    "STRAIGHT",
    "UP",
    "first_guess",
    "first_state_reference",
    "genes_scale",
    "inner_scale",
    "row_scale",
    "rows_scale",
    "skill_of",
]

STRAIGHT = ("m_ap", "m_sp", "posture", "a_hat", "feed_forward", "timing", "arms")
"""Blocks of `controller.PARAMETERS` for running straight on level ground."""
LEVEL = (*STRAIGHT, "turn", "bend")
"""Those for level ground."""
UP, DOWN = (tuple(f"{way}{term}" for term in ("", "_legs", "_timing")) for way in ("climb", "descend"))
"""Those for uphill and downhill."""
KNOTS = np.array([1.2, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0])
"""Speeds [m/s] of the rows of a learned table; the first is that of the walk from which it starts to run."""
SPEED_RANGE = (1.5, 5.0)
"""Speeds [m/s] that users may ask for."""
SIZE = sum(c.PARAMETERS.values())
BLOCKS = ("base", "slope", "bend", "slow", "slowest", "faster", "fastest", "fast", "inner")
"""Of SIZE genes each: parameters at `MIDDLE`, their change per m/s and per (m/s)^2 from 2.5 to 4 m/s; how the
rows beyond differ from their neighbours in this family: that at 2 from that at 2.5 m/s, that at 1.2 from that
at 2, that at 4.5 from that at 4 and that at 5 from that at 4.5; how that at 4 itself differs; at last how all
rows do, each by its share in `_INNER`."""
_INNER = np.array([0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 0.4, 0.0])
"""Weights of the rows in the last block: none for those beyond the middle, which keep what they learned."""
_SPREAD = np.array([0.1, 1.0, 0.03, 0.3, 0.5, 0.1, 0.05, 0.1, 1.0, 1.0, 0.2, 0.04])
"""Typical deviation of each sensor while running."""


def first_guess() -> np.ndarray:
    """First guess of the genes: SIMBICON's balance feedback around the clip at every speed, with longer steps
    at higher speeds."""
    x = np.zeros(SIZE)
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
    x[part["timing"]] = [0.3, 1.0]
    x[part["arms"]] = 1.0
    longer = np.zeros(SIZE)
    longer[part["timing"].start + 1] = 0.08
    return _genes(x, longer)


def skill_of(
    genes: np.ndarray, reference: np.ndarray, max_lateral: float = 1.6, meta: dict | None = None
) -> RunSkill:
    """The skill of ``genes`` (len(BLOCKS) * SIZE,), see `BLOCKS`."""
    base, slope, bend, slow, slowest, faster, fastest, fast, inner = genes.reshape(len(BLOCKS), SIZE)
    u = (KNOTS[2:6] - MIDDLE)[:, None]
    table = np.empty((len(KNOTS), SIZE))
    table[2:6] = base + u * slope + u * u * bend
    table[1] = table[2] + slow
    table[0] = table[1] + slowest
    table[6] = table[5] + faster
    table[7] = table[6] + fastest
    table[5] += fast
    table += np.outer(_INNER, inner)
    time = c.parameter_slices()["timing"].start
    table[:, time] = np.clip(table[:, time], 0.22, 0.5)
    return RunSkill(KNOTS, table, reference, SPEED_RANGE, max_lateral, (0.3, 0.25), run_clip(), meta or {})


def genes_scale(base: float, slope: float, bend: float, *names: str) -> np.ndarray:
    """Scale of the genes of the family where only the blocks ``names`` of `controller.PARAMETERS` are free,
    each weighted; of the third only those that shape the step."""
    shape = row_scale(*(name for name in names if name not in ("m_ap", "m_sp", "posture")))
    return _genes(base * row_scale(*names), slope * row_scale(*names), bend * shape)


def _genes(*blocks: np.ndarray) -> np.ndarray:
    """All genes from those of the first `BLOCKS`; the others are 0."""
    return np.concatenate([*blocks, np.zeros((len(BLOCKS) - len(blocks)) * SIZE)])


def rows_scale(
    slow: float = 0.0, slowest: float = 0.0, faster: float = 0.0, fastest: float = 0.0, fast: float = 0.0
) -> np.ndarray:
    """Scale of all genes where only rows of their own are free, each weighted; slopes are left to what was
    learned between them."""
    own = np.outer([slow, slowest, faster, fastest, fast], row_scale(*LEVEL))
    return _genes(*np.zeros((3, SIZE)), *own)


def inner_scale(*names: str) -> np.ndarray:
    """Scale of all genes where only the last block is free, and of it the blocks ``names`` of
    `controller.PARAMETERS`."""
    return _genes(*np.zeros((len(BLOCKS) - 1, SIZE)), row_scale(*names))


def row_scale(*names: str) -> np.ndarray:
    """How far the parameters of a row may reasonably move, (SIZE,) float64; 0 but in the blocks ``names`` of
    `controller.PARAMETERS`."""
    x, part = np.ones(SIZE), c.parameter_slices()
    x[part["m_sp"]] = np.tile(0.1 / _SPREAD, c.RANK)
    x[part["posture"]] = [0.5, 0.5, 0.5, 0.5, 0.05, 0.5, 0.05, 0.5, 0.05]
    x[part["a_hat"]] = 0.15
    x[part["feed_forward"]] = 0.3
    x[part["turn"]] = 0.5
    x[part["climb"]] = 2.0
    x[part["descend"]] = 2.0
    x[part["climb_legs"]] = x[part["descend_legs"]] = 1.5
    x[part["bend"]] = 0.1
    x[part["climb_timing"]] = x[part["descend_timing"]] = [0.2, 0.8]
    x[part["timing"]] = [0.06, 0.25]
    x[part["arms"]] = 0.2
    free = np.zeros(SIZE)
    for name in names:
        free[part[name]] = x[part[name]]
    return free


def first_state_reference() -> np.ndarray:
    """Reference sensors over a step, (9, 12) float64, before any running has been seen."""
    phase = np.linspace(0.0, 1.0, 9)
    table = np.zeros((9, 12))
    table[:, 0] = 0.09
    table[:, 2] = 0.93
    table[:, 5] = 0.36 * (phase - 0.28)
    table[:, 11] = 0.06
    return table
