"""What decides whether a skill holds, what predicts it best, and how many samples that takes.

    surefoot train preconditions --checkpoint kept -o out      # samples all skills into the folder kept
    python -m benchmarks.preconditions kept [--skills jump vault]

For each skill, cross-validated over four parts of the starts (never of the moments of one start): area under
the curve (AUC) and Brier score of the support vector machine that ships (reduced, on chosen features), of
boosted trees, a small network and a whole machine on all features, and on the whole state (joints, their
rates and the controller's memory); then the features that count most, and the figures of the machine learned
from a half, a quarter and an eighth of the starts. Needs scikit-learn.
"""

import argparse
from pathlib import Path
from typing import Any, cast

import numpy as np

from locomotion.preconditions.precondition import features_of
from locomotion.preconditions.svm import odds_exactly
from locomotion.training.preconditions.fitting import (
    Learning,
    Samples,
    counting_features,
    fit_machine,
    ranked_features,
    samples_of,
)
from locomotion.training.preconditions.outcomes import STARTS, Outcomes, read_outcomes
from runtime.evaluation.preconditions import area_under_curve

PARTS = 4


def whole_state(outcomes: Outcomes) -> np.ndarray:
    """(m, k) every moment's joints, rates, memory, plan and obstacle, from the obstacle's edge."""
    moments, starts = outcomes.moments, outcomes.starts[outcomes.start_of]
    qpos = moments["qpos"].astype(np.float64)
    qpos[:, 0] -= starts[:, STARTS.index("distance")]
    memory = moments["state"][:, :13]
    site = [STARTS.index(name) for name in ("size", "depth", "friction")]
    told = [qpos, moments["qvel"], memory, moments["plan"], moments["variation"], starts[:, site]]
    return np.concatenate(told, axis=1)


def estimators(seed: int) -> dict:
    """What the machine is compared with, by name."""
    from sklearn.neural_network import MLPClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler
    from sklearn.svm import SVC

    return {
        "boosted trees": Learning().trees(seed),
        "small network (32, 16)": make_pipeline(
            StandardScaler(), MLPClassifier((32, 16), alpha=1.0, early_stopping=True, random_state=seed)
        ),
        "whole machine, unscaled features": make_pipeline(
            StandardScaler(), SVC(C=1.0, gamma=cast(Any, 0.02))
        ),
    }


def sigmoid(decided: np.ndarray, holds: np.ndarray) -> np.ndarray:
    """Calibrated odds of cross-validated decisions."""
    return Learning().logistic().fit(decided[:, None], holds).predict_proba(decided[:, None])[:, 1]


def shown(name: str, odds: np.ndarray, samples: Samples) -> None:
    """Print a line."""
    inside, off = samples.within, samples.within & (samples.steps == 0)
    areas = [area_under_curve(odds[part], samples.holds[part]) for part in (odds >= 0.0, inside, off)]
    brier = float(((odds - samples.holds) ** 2).mean())
    print(f"| {name} | {areas[0]:.3f} | {areas[1]:.3f} | {areas[2]:.3f} | {brier:.3f} |", flush=True)


def machine_odds(skill: str, samples: Samples, part: np.ndarray, share: float = 1.0) -> np.ndarray:
    """Cross-validated odds of the machine, its features chosen anew in each part, learned from a ``share`` of
    the starts."""
    odds = np.zeros(len(part))
    for k in range(PARTS):
        seen = (part != k) & (samples.start < share * (samples.start.max() + 1))
        learned = samples.part(seen)
        ranked = counting_features(skill, learned)
        odds[part == k] = odds_exactly(fit_machine(learned, ranked, 0), samples.features[part == k])
    return odds


def compare(file: Path) -> None:
    """Print the table of a skill."""
    outcomes = read_outcomes(file)
    samples = samples_of(outcomes)
    starts = len(outcomes.ends)
    part = np.random.default_rng(0).integers(0, PARTS, starts)[samples.start]
    print(
        f"\n{outcomes.skill}: {starts} starts, {len(part)} moments, {100 * samples.holds.mean():.0f} % hold"
    )
    print("| learned by | AUC, all sizes | sizes to clear | of these at take-off | Brier |")
    print("| --- | --- | --- | --- | --- |")
    shown("machine", machine_odds(outcomes.skill, samples, part), samples)
    inputs = {"": samples.features, ", whole state": whole_state(outcomes)[outcomes.learned_from]}
    for name, model in estimators(0).items():
        for more, features in inputs.items():
            decided = np.zeros(len(part))
            for k in range(PARTS):
                model.fit(features[part != k], samples.holds[part != k])
                if hasattr(model, "decision_function"):
                    decided[part == k] = model.decision_function(features[part == k])
                else:
                    chance = np.clip(model.predict_proba(features[part == k])[:, 1], 1e-6, 1 - 1e-6)
                    decided[part == k] = np.log(chance / (1.0 - chance))
            shown(f"{name}{more}", sigmoid(decided, samples.holds), samples)
    for share in (0.5, 0.25, 0.125):
        shown(
            f"machine, {share * starts:.0f} starts",
            machine_odds(outcomes.skill, samples, part, share),
            samples,
        )
    ranked = ranked_features(samples, 0)[:8]
    print("what counts:", ", ".join(f"{features_of(outcomes.skill)[k]} {counts:.3f}" for k, counts in ranked))


def main() -> None:
    """Print a table for each skill."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="of outcomes, one file for each skill")
    parser.add_argument("--skills", nargs="+", help="default: all there are")
    options = parser.parse_args()
    for file in sorted(options.folder.glob("*.npz")):
        if options.skills is None or file.stem in options.skills:
            compare(file)


if __name__ == "__main__":
    main()
