"""How well the person rolls off drops: the paper's test, random heights, peaks, and film strips.

    python -m benchmarks.drop_rolling [--starts 701] [--heights 500] [--json drop.json] [--film out/drop]

The paper's test: the default height, starts from standing at d = 30 to 100 m before the edge (``--starts``
of them, evenly; 701 are 0.1 m apart). Then heights drawn evenly from 0.9 to 2.0 m, starts at 10 to 30 m. Both
with noise of 0.02 m/s and rad/s in the start's velocities, and all the way that a mission takes: path
tracking, speed planner, skill, a level made of triangles. Held: the person comes up again and arrives 15 m
behind the edge. The film strips (--film) show falls and rolls of 0.9, 1.5 and 2.0 m.
"""

import argparse
import json
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from runtime.drop_trials import DropAttempt, drop_attempt

DEFAULT_HEIGHT = 1.5
"""[m]"""
NOISE = 0.02
"""Standard deviation [m/s, rad/s] of the velocities at the start."""


def summary(attempts: list[DropAttempt]) -> dict[str, Any]:
    """The figures of one test."""
    rolled = [a for a in attempts if a.ended == "arrived"]
    peaks = np.array([a.peak for a in rolled]) if rolled else np.zeros(1)
    errors = np.array([a.takeoff_error for a in attempts if np.isfinite(a.takeoff_error)])
    return {
        "starts": len(attempts),
        "held": len(rolled) / len(attempts),
        "peak_median": float(np.median(peaks)),
        "peak_greatest": float(peaks.max()),
        "head_touches": float(np.mean([a.head > 0.0 for a in attempts])),
        "head_time": float(np.mean([a.head for a in attempts])),
        "takeoff_error_sd": float(errors.std()) if len(errors) else 0.0,
        "ends": dict(Counter(a.ended for a in attempts)),
    }


def show(name: str, figures: dict[str, Any]) -> None:
    """Print one test."""
    print(
        f"{name}: {100 * figures['held']:.1f} % of {figures['starts']} held; peak reaction"
        f" {figures['peak_median']:.1f} (median), {figures['peak_greatest']:.1f} (greatest) body"
        f" weights; the head touches in {100 * figures['head_touches']:.0f} %,"
        f" {figures['head_time']:.3f} s on average; take-off error {figures['takeoff_error_sd']:.3f} m;"
        f" {figures['ends']}",
        flush=True,
    )


def film(path: Path, height: float, count: int = 16) -> None:
    """Write a strip of ``count`` pictures from the take-off to a stand, in two rows."""
    import matplotlib.image
    import mujoco

    from locomotion.skill import load_run_skill
    from locomotion.training.drop_trial import DropSimulator

    frames: list[np.ndarray] = []
    for distance in np.arange(12.0, 16.0, 0.5):
        frames.clear()
        if drop_attempt(height, float(distance), frames=frames).ended == "arrived":
            break
    simulator = DropSimulator(load_run_skill())
    simulator.place(0.0, height)
    model, data = simulator.model, simulator.data
    model.geom_size[simulator.ledge, 1] = 0.9  # seen from beside it
    model.stat.extent = 4.0
    first = next(k for k, qpos in enumerate(frames) if qpos[0] > -0.2)
    renderer, camera = mujoco.Renderer(model, 400, 340), mujoco.MjvCamera()
    camera.distance, camera.azimuth, camera.elevation = 3.4, 75.0, -10.0
    pictures = []
    for qpos in frames[first : first + 12 * count : 12]:
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        camera.lookat[:] = qpos[0] + 0.15, qpos[1], max(qpos[2], 0.55 - height) - 0.1
        renderer.update_scene(data, camera)
        picture = renderer.render().copy()
        picture[(picture == 0).all(axis=2)] = 235
        pictures.append(picture)
    path.parent.mkdir(parents=True, exist_ok=True)
    half = len(pictures) // 2
    matplotlib.image.imsave(
        path, np.vstack([np.hstack(pictures[:half]), np.hstack(pictures[half : 2 * half])])
    )


def main() -> None:
    """Try every start, print the figures, write JSON and film strips."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--starts", type=int, default=701, help="of the paper's test")
    parser.add_argument("--heights", type=int, default=500, help="starts at random heights")
    parser.add_argument("--json", type=Path, help="file to write")
    parser.add_argument("--film", type=Path, help="beginning of the names of film strips to write")
    options = parser.parse_args()
    rng = np.random.default_rng(0)
    distances = np.linspace(30.0, 100.0, options.starts)
    tests = {
        "default height": [(DEFAULT_HEIGHT, float(d)) for d in distances],
        "random heights": [
            (float(rng.uniform(0.9, 2.0)), float(rng.uniform(10.0, 30.0))) for _ in range(options.heights)
        ],
    }
    result = {}
    for name, starts in tests.items():
        if starts:
            attempts = [drop_attempt(h, d, noise=NOISE * rng.normal(size=45)) for h, d in starts]
            result[name] = {"summary": summary(attempts), "attempts": [asdict(a) for a in attempts]}
            show(name, result[name]["summary"])
    if options.film:
        for height in (0.9, 1.5, 2.0):
            film(options.film.parent / f"{options.film.name}-{height:g}.png", height)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
