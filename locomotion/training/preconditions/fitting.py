"""Fitting preconditions to outcomes: features on physical grounds, a support vector machine, calibrated odds.

Boosted trees say on half of the starts how much each feature counts; the `MOST` best ones, scaled by that, go
into the machine. It is a support vector machine with the kernel exp(-γ |x - y|²), restricted to a fixed
number of support vectors ("reduced", Lee and Mangasarian, 2001): Nyström's features and a linear machine. Its
decisions on starts that it was not fitted to are turned into odds (Platt, 1999). scikit-learn does the work
(the extra "learn").
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.preconditions.changes import CHANGES, CHOICES, Changing, describe_change
from locomotion.preconditions.features import BEFORE, FEATURES, before_run_up, describe, site_of
from locomotion.preconditions.precondition import Precondition, features_of, skill_and_run
from locomotion.preconditions.svm import Machine, decide_exactly
from locomotion.training.preconditions.outcomes import STARTS, Outcomes, kind_for

__all__ = [
    "Learning",
    "Samples",
    "counting_features",
    "fit_machine",
    "fit_precondition",
    "ranked_features",
    "samples_before",
    "samples_of",
]

MOST = 12
"""Features that count in a run-up."""
_CENTRES, _CENTRES_BEFORE = 128, 48
_GAMMA, _COST = 0.05, 1.0
_LEAST_WEIGHT, _MOST_WEIGHT = 0.3, 2.0  # of a feature, against the fourth best
_FOLDS, _SEED = 4, 0


@dataclass(frozen=True)
class Samples:
    """Moments with what came of them. features: (n, k). holds: (n,) bool. start: (n,) number of the start
    that each belongs to. within: (n,) whether the obstacle's size is one that people are to clear. steps:
    (n,) left in the run-up, 0 at take-off."""

    features: NDArray[np.float64]
    holds: NDArray[np.bool_]
    start: NDArray[np.int64]
    within: NDArray[np.bool_]
    steps: NDArray[np.int64]

    def part(self, chosen: NDArray[Any]) -> Samples:
        """Those of some rows."""
        return Samples(
            self.features[chosen], self.holds[chosen], self.start[chosen], self.within[chosen],
            self.steps[chosen],
        )  # fmt: skip


def _samples_of_change(outcomes: Outcomes) -> Samples:
    """The moments before a change, one of each start that came to one."""
    moments, start = outcomes.moments, outcomes.start_of
    told = (
        moments[name].astype(np.float64) for name in ("state", "plan", "beside", "qpos", "qvel", "variation")
    )
    rows = [
        describe_change(Changing(state, plan, float(beside[0]), qpos, qvel), choice[None])[0]
        for state, plan, beside, qpos, qvel, choice in zip(*told, strict=True)
    ]
    every = np.ones(len(start), dtype=bool)
    return Samples(np.array(rows), outcomes.ends[start] == 0, start, every, np.zeros_like(start))


def _sites(outcomes: Outcomes) -> NDArray[np.float64]:
    kind = kind_for(outcomes.skill)
    sites = []
    for row in outcomes.starts:
        start = dict(zip(STARTS, row, strict=True))
        depth = {"over": start["depth"], "across": start["size"]}.get(kind.obstacle.crossing, 0.0)
        edge, normal = np.array([start["distance"], 0.0, start["edge height"]]), np.array([-1.0, 0.0, 0.0])
        height = 0.0 if kind.obstacle.crossing == "across" else start["size"]
        obstacle = ObstacleAhead(start["distance"], kind.affordance, height, edge, normal, depth)
        sites.append(site_of(obstacle, start["friction"]))
    return np.array(sites)


def samples_of(outcomes: Outcomes) -> Samples:
    """The moments of all run-ups, but those before a push and of people who never took off; of a change those
    before it."""
    if outcomes.skill in CHANGES:
        return _samples_of_change(outcomes)
    sites, moments, start = _sites(outcomes), outcomes.moments, outcomes.start_of
    state, plan = moments["state"].astype(np.float64), moments["plan"].astype(np.float64)
    variation, beside = moments["variation"].astype(np.float64), moments["beside"].astype(np.float64)
    features = np.empty((len(start), len(FEATURES)))
    for k, row in enumerate(features):
        farther, faster = variation[k]
        describe(state[k], plan[k], farther, faster, beside[k, 0], sites[start[k]], row)
    low, high = kind_for(outcomes.skill).sizes
    size = outcomes.starts[start, STARTS.index("size")]
    steps = np.where(moments["off"], 0, np.maximum(plan[:, 0], 1.0)).astype(np.int64)
    every = Samples(features, outcomes.ends[start] == 0, start, (size >= low) & (size <= high), steps)
    return every.part(outcomes.learned_from)


def samples_before(outcomes: Outcomes) -> Samples:
    """All starts from a stand without a push, as they are before the run-up."""
    sites, column = _sites(outcomes), {name: outcomes.starts[:, k] for k, name in enumerate(STARTS)}
    features = np.array([before_run_up(*each) for each in zip(sites, column["distance"], strict=True)])
    low, high = kind_for(outcomes.skill).sizes
    within = (column["size"] >= low) & (column["size"] <= high)
    number = np.arange(len(sites))
    every = Samples(features, outcomes.ends == 0, number, within, np.zeros_like(number))
    return every.part((column["running"] == 0.0) & (column["pushed"] == 0.0) & (outcomes.ends != 1))


def ranked_features(samples: Samples, seed: int) -> list[tuple[int, float]]:
    """Numbers of the features and how much each counts, the best first: by how much the area under the curve
    of boosted trees falls when its values are shuffled, on starts that these were not fitted to."""
    learning = Learning()
    fitted = samples.start % 2 == 0
    rest = samples.part(~fitted & samples.within)
    trees = learning.trees(seed).fit(samples.features[fitted], samples.holds[fitted])
    if len(set(rest.holds.tolist())) < 2:
        raise LocomotionError("too few outcomes to rank features; sample more starts")
    counts: Any = learning.permutation_importance(
        trees, rest.features, rest.holds, scoring="roc_auc", n_repeats=3, random_state=seed
    )
    found = counts.importances_mean
    return [(int(k), float(found[k])) for k in np.argsort(-found, kind="stable")]


def counting_features(skill: str, samples: Samples) -> list[tuple[int, float]]:
    """The `MOST` best of `ranked_features`; of a change first what is chosen, if anything is."""
    ranked = ranked_features(samples, _SEED)
    if skill in CHANGES:
        varies = np.ptp(samples.features, axis=0) > 0.0
        ranked.sort(key=lambda each: each[0] >= len(CHOICES) or not varies[each[0]])
    return ranked[:MOST]


def fit_machine(
    samples: Samples, ranked: list[tuple[int, float]], seed: int, centres: int = _CENTRES
) -> Machine:
    """A machine of the features ``ranked``, with odds that are calibrated on starts left out in turn."""
    learning = Learning()
    fold = np.random.default_rng(seed).integers(0, _FOLDS, int(samples.start.max()) + 1)[samples.start]
    decided = np.zeros(len(fold))
    for k in range(_FOLDS):
        machine = _uncalibrated(samples.part(fold != k), ranked, seed, centres)
        decided[fold == k] = decide_exactly(machine, samples.features[fold == k])
    sigmoid = learning.logistic().fit(decided[:, None], samples.holds)
    machine = _uncalibrated(samples, ranked, seed, centres)
    machine.numbers[2:] = sigmoid.coef_[0, 0], sigmoid.intercept_[0]
    return machine


def _uncalibrated(samples: Samples, ranked: list[tuple[int, float]], seed: int, centres: int) -> Machine:
    columns = np.array([number for number, _ in ranked], dtype=np.int32)
    usual = max(ranked[min(3, len(ranked) - 1)][1], 1e-6)
    weight = np.clip([counts / usual for _, counts in ranked], _LEAST_WEIGHT, _MOST_WEIGHT)
    counting = samples.features[:, columns]
    mean, scale = counting.mean(axis=0), np.maximum(counting.std(axis=0), 1e-6) / weight
    scaled = (counting - mean) / scale
    model = Learning().machine(_GAMMA, _COST, min(centres, len(scaled)), seed).fit(scaled, samples.holds)
    mapped, linear = model[0], model[1]
    return Machine(
        columns, counting.min(axis=0), counting.max(axis=0), mean, scale,
        np.ascontiguousarray(mapped.components_.T), mapped.normalization_.T @ linear.coef_[0],
        np.array([_GAMMA, float(linear.intercept_[0]), 1.0, 0.0]),
    )  # fmt: skip


def fit_precondition(outcomes: Outcomes) -> Precondition:
    """The precondition of a skill. Raises `LocomotionError` without scikit-learn, or if there are too few
    outcomes, or only of one sort."""
    samples = samples_of(outcomes)
    before = None if outcomes.skill in CHANGES else samples_before(outcomes)
    for each in (samples, before):
        if each is not None and (len(each.holds) < 20 or each.holds.all() or not each.holds.any()):
            raise LocomotionError(f"too few outcomes of {outcomes.skill} to learn from; sample more starts")
    with Learning().one_thread():
        return _fitted(outcomes, samples, before)


def _fitted(outcomes: Outcomes, samples: Samples, before: Samples | None) -> Precondition:
    skill = outcomes.skill
    names, ranked = features_of(skill), counting_features(skill, samples)
    meta = {
        "starts": len(outcomes.ends), "seed": outcomes.header["seed"],
        "holds": round(float((outcomes.ends == 0).mean()), 4),
        "features": {names[k]: round(counts, 4) for k, counts in ranked},
    }  # fmt: skip
    sizes = [(k, 1.0) for k in range(len(BEFORE))]
    return Precondition(
        skill, (0.0, 0.0) if before is None else kind_for(skill).sizes, fit_machine(samples, ranked, _SEED),
        None if before is None else fit_machine(before, sizes, _SEED, _CENTRES_BEFORE),
        skill_and_run(skill), meta,
    )  # fmt: skip


class Learning:
    """What is used of scikit-learn, which only learning needs."""

    def __init__(self) -> None:
        try:
            import sklearn  # noqa: F401
        except ImportError:
            raise LocomotionError(
                "learning preconditions needs the extra 'learn': pip install surefoot[learn]"
            ) from None
        from sklearn.inspection import permutation_importance
        from threadpoolctl import threadpool_limits

        self.permutation_importance = permutation_importance
        self.one_thread = partial(threadpool_limits, limits=1)  # several wait for one another

    def trees(self, seed: int) -> Any:
        from sklearn.ensemble import HistGradientBoostingClassifier

        return HistGradientBoostingClassifier(
            max_iter=150, learning_rate=0.05, max_leaf_nodes=15, min_samples_leaf=30, random_state=seed
        )

    def logistic(self) -> Any:
        from sklearn.linear_model import LogisticRegression

        return LogisticRegression()

    def machine(self, gamma: float, cost: float, centres: int, seed: int) -> Any:
        from sklearn.kernel_approximation import Nystroem
        from sklearn.pipeline import make_pipeline
        from sklearn.svm import LinearSVC

        return make_pipeline(
            Nystroem(kernel="rbf", gamma=gamma, n_components=centres, random_state=seed),
            LinearSVC(C=cost, dual=cast(Any, False), max_iter=5000, random_state=seed),
        )
