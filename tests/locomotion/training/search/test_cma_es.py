"""The search of the covariance matrix adaptation against known minima and the cma package."""

import numpy as np
import pytest

from locomotion.training.search.cma_es import CmaEs


def minimise(function, start: np.ndarray, generations: int, sigma: float = 0.5) -> CmaEs:
    search = CmaEs(start, sigma, np.ones(len(start)), population=16)
    for generation in range(generations):
        asked = search.ask(np.random.default_rng(generation))
        search.tell(asked, np.array([function(x) for x in asked]))
    return search


def test_cma_finds_the_bottom_of_a_turned_valley() -> None:
    rng = np.random.default_rng(0)
    turn, _ = np.linalg.qr(rng.normal(size=(8, 8)))
    weights = np.logspace(0, 4, 8)

    def valley(x: np.ndarray) -> float:
        return float(np.sum(weights * (turn @ (x - 1.0)) ** 2))

    assert valley(minimise(valley, np.zeros(8), 300).best_guess) < 1e-8


def test_cma_keeps_up_with_the_cma_package() -> None:
    cma = pytest.importorskip("cma")

    def rosenbrock(x: np.ndarray) -> float:
        return float(np.sum(100 * (x[1:] - x[:-1] ** 2) ** 2 + (1 - x[:-1]) ** 2))

    mine = rosenbrock(minimise(rosenbrock, np.zeros(5), 250, 0.3).best_guess)
    options = {
        "popsize": 16,
        "seed": 1,
        "verbose": -9,
        "maxiter": 250,
        "tolfun": 0,
        "tolx": 0,
        "tolfunhist": 0,
    }
    theirs = cma.fmin2(rosenbrock, np.zeros(5), 0.3, options)[1].result.fbest
    assert mine < max(1e-6, 1e3 * theirs)
