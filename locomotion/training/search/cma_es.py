"""CMA-ES whose whole state is a few arrays, so that a run can be stopped, saved and resumed exactly.

The algorithm is that of N. Hansen, "The CMA Evolution Strategy: A Tutorial" (2016), with his default weights
and rates, positive recombination weights only. (The `cma` package keeps its state in a pickle; the tests
compare the two on the same functions.)
"""

from dataclasses import dataclass

import numpy as np

from surefoot.files.schema import Array, Numbers

__all__ = ["CmaEs", "search_arrays"]


def search_arrays(count: int) -> dict[str, Array]:
    """Schema of `CmaEs.arrays` for ``count`` parameters."""
    return {
        "mean": Numbers(count),
        "sigma": Numbers(low=1e-12),
        "covariance": Numbers(count, count),
        "path_c": Numbers(count),
        "path_s": Numbers(count),
        "generation": Numbers(low=0, dtype="int64"),
    }


@dataclass
class CmaEs:
    """State of the search; minimises. Lengths: n parameters, ``population`` candidates per generation.

    Attributes:
        mean: (n,) float64, centre of the search distribution in units of ``scale``.
        sigma: overall step size.
        scale: (n,) float64, how large one unit of each parameter is.
    """

    mean: np.ndarray
    sigma: float
    scale: np.ndarray
    population: int = 32
    generation: int = 0

    def __post_init__(self) -> None:
        n, lam = len(self.mean), self.population
        self.mean = np.asarray(self.mean, dtype=np.float64) / self.scale
        mu = lam // 2
        weights = np.log((lam + 1) / 2) - np.log(np.arange(1, mu + 1))
        self.weights = weights / weights.sum()
        mueff = 1.0 / np.sum(self.weights**2)
        self.mueff = mueff
        self.cc = (4 + mueff / n) / (n + 4 + 2 * mueff / n)
        self.cs = (mueff + 2) / (n + mueff + 5)
        self.c1 = 2 / ((n + 1.3) ** 2 + mueff)
        self.cmu = min(1 - self.c1, 2 * (mueff - 2 + 1 / mueff) / ((n + 2) ** 2 + mueff))
        self.damps = 1 + 2 * max(0.0, np.sqrt((mueff - 1) / (n + 1)) - 1) + self.cs
        self.chi = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
        self.path_c, self.path_s = np.zeros(n), np.zeros(n)
        self.covariance = np.eye(n)
        self._decompose()

    def _decompose(self) -> None:
        values, vectors = np.linalg.eigh(self.covariance)
        self._roots = np.sqrt(np.maximum(values, 1e-20))
        self._vectors = vectors

    @property
    def best_guess(self) -> np.ndarray:
        """Mean of the distribution in the parameters' own units, (n,) float64."""
        return self.mean * self.scale

    @property
    def parents(self) -> int:
        """Number of best candidates of a generation that it learns from."""
        return len(self.weights)

    def ask(self, rng: np.random.Generator) -> np.ndarray:
        """Candidates of the next generation in the parameters' own units, (population, n) float64."""
        z = rng.standard_normal((self.population, len(self.mean)))
        return (self.mean + self.sigma * (z * self._roots) @ self._vectors.T) * self.scale

    def tell(self, candidates: np.ndarray, costs: np.ndarray) -> None:
        """Update from candidates of `ask`, at least the best `parents` of them, and their costs."""
        n = len(self.mean)
        order = np.argsort(costs, kind="stable")[: self.parents]
        steps = (candidates[order] / self.scale - self.mean) / self.sigma
        step = self.weights @ steps
        self.mean = self.mean + self.sigma * step
        whitened = self._vectors @ ((self._vectors.T @ step) / self._roots)
        self.path_s = (1 - self.cs) * self.path_s + np.sqrt(self.cs * (2 - self.cs) * self.mueff) * whitened
        self.generation += 1
        norm = np.linalg.norm(self.path_s)
        slack = np.sqrt(1 - (1 - self.cs) ** (2 * self.generation))
        h = float(norm / slack / self.chi < 1.4 + 2 / (n + 1))
        self.path_c = (1 - self.cc) * self.path_c + h * np.sqrt(self.cc * (2 - self.cc) * self.mueff) * step
        rank_one = np.outer(self.path_c, self.path_c) + (1 - h) * self.cc * (2 - self.cc) * self.covariance
        rank_mu = (steps.T * self.weights) @ steps
        self.covariance = (1 - self.c1 - self.cmu) * self.covariance + self.c1 * rank_one + self.cmu * rank_mu
        self.covariance = 0.5 * (self.covariance + self.covariance.T)
        self.sigma *= float(np.exp(min(1.0, (self.cs / self.damps) * (norm / self.chi - 1))))
        self._decompose()

    def arrays(self) -> dict[str, np.ndarray]:
        """Everything that changes, for a checkpoint."""
        return {
            "mean": self.mean,
            "sigma": np.array(self.sigma),
            "covariance": self.covariance,
            "path_c": self.path_c,
            "path_s": self.path_s,
            "generation": np.array(self.generation),
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Continue from `arrays`."""
        self.mean, self.covariance = arrays["mean"].copy(), arrays["covariance"].copy()
        self.path_c, self.path_s = arrays["path_c"].copy(), arrays["path_s"].copy()
        self.sigma, self.generation = float(arrays["sigma"]), int(arrays["generation"])
        self._decompose()
