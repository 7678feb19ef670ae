"""How well the person vaults from the run: the paper's test, what went wrong, and whether it is a vault.

    python -m benchmarks.vaulting [--every 0.5] [--heights 0.6 0.7] [--json vaulting.json] [--film out/vault]

For every height the person starts from standing at d = 10 to 30 m before a wall 0.3 m thick, runs up, vaults
and runs on to a goal 12 m behind it: the whole way that a mission takes (path tracking, speed planner,
skill) on a triangle mesh, with noise of 0.02 m/s and rad/s in the start. Vaulted: it arrives and its hand
has held on to the top. Clean: nothing but hands and forearms has touched the wall. Middle: the hand held
within the middle half of the top. Without the joint: the same starts that vaulted, with the hand's joint
switched off. The film strips (--film) need MuJoCo's renderer, with MUJOCO_GL=egl where there is no display.
"""

import argparse
import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from locomotion.hand_hold import let_go_both
from locomotion.skill import load_run_skill
from locomotion.vault_skill import Vault, load_vault_skill
from runtime.clearing_trials import VaultAttempt, vault_attempt

NEAREST, FARTHEST = 10.0, 30.0
DEPTH = 0.3
NOISE = 0.02
_SPACING, _COUNT = 8, 14  # ticks between the pictures of a strip, pictures


class Handless(Vault):
    """A vault whose hand's joint never closes."""

    def tick(self, obstacle, memory, state, data):
        done = super().tick(obstacle, memory, state, data)
        let_go_both(data)
        return done


def start_noise(distance: float) -> np.ndarray:
    """Of the velocities at the start, (45,) [m/s, rad/s]; always the same for a distance."""
    return NOISE * np.random.default_rng([17, round(1000 * distance)]).normal(size=45)


def attempts_at(height: float, every: float) -> tuple[list[VaultAttempt], list[VaultAttempt]]:
    """All starts, and those that vaulted once more without the joint."""
    without = Handless(load_vault_skill(), load_run_skill())
    tried, handless = [], []
    for k in range(round((FARTHEST - NEAREST) / every) + 1):
        distance = NEAREST + k * every
        tried.append(vault_attempt(height, DEPTH, distance, noise=start_noise(distance)))
        if tried[-1].vaulted:
            handless.append(vault_attempt(height, DEPTH, distance, [without], start_noise(distance)))
    return tried, handless


def summary(height: float, tried: list[VaultAttempt], handless: list[VaultAttempt]) -> dict[str, Any]:
    """The figures of one height."""
    good = [a for a in tried if a.vaulted]

    def share(chosen: list[bool]) -> float:
        return float(np.mean(chosen)) if chosen else np.nan

    ends = sorted({a.ended for a in tried})
    return {
        "height": height,
        "starts": len(tried),
        "vaulted": share([a.vaulted for a in tried]),
        "clean": share([not a.touched for a in good]),
        "middle": share([abs(a.planted - 0.5) <= 0.25 for a in good]),
        "held": share([a.held for a in good]),
        "without_joint": share([a.ended == "arrived" for a in handless]),
        "takeoff_error_rms": float(np.sqrt(np.nanmean([a.takeoff_error**2 for a in tried]))),
        "ends": {end: sum(a.ended == end for a in tried) for end in ends},
    }


def film(path: Path, height: float, distance: float) -> None:
    """Write a strip of pictures of the vault, 80 ms apart, in two rows."""
    import matplotlib.image

    from locomotion.training.vault_trial import VaultSimulator

    frames: list[np.ndarray] = []
    vault_attempt(height, DEPTH, distance, noise=start_noise(distance), frames=frames)
    simulator = VaultSimulator(load_run_skill())
    simulator.place_wall(0.0, height, DEPTH)
    model, data = simulator.model, simulator.data
    model.geom_size[simulator.stair, 1] = 0.9  # seen from beside it
    model.stat.extent = 4.0
    renderer, camera = mujoco.Renderer(model, 400, 340), mujoco.MjvCamera()
    camera.distance, camera.azimuth, camera.elevation = 3.4, 65.0, -10.0
    first = next(i for i, qpos in enumerate(frames) if qpos[0] > -1.3)
    pictures = []
    for qpos in frames[first::_SPACING][:_COUNT]:
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        camera.lookat[:] = qpos[0], 0.0, 0.5 + 0.5 * height
        renderer.update_scene(data, camera)
        picture = renderer.render().copy()
        picture[(picture == 0).all(axis=2)] = 235
        pictures.append(picture)
    rows = [np.hstack(pictures[: _COUNT // 2]), np.hstack(pictures[_COUNT // 2 :])]
    path.parent.mkdir(parents=True, exist_ok=True)
    matplotlib.image.imsave(path, np.vstack(rows))


def main() -> None:
    """Try every start, print a table, write JSON and film strips."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--heights", type=float, nargs="+", help="[m]; default: those that were learned")
    parser.add_argument("--every", type=float, default=0.5, help="step of the distance [m]")
    parser.add_argument("--json", type=Path, help="file to write")
    parser.add_argument("--film", type=Path, help="beginning of the names of film strips to write")
    options = parser.parse_args()
    result: dict[str, Any] = {"summary": [], "attempts": []}
    print(" height  starts  vaulted   clean  middle    held  no joint  ends")
    for height in options.heights or load_vault_skill().heights.tolist():
        tried, handless = attempts_at(height, options.every)
        figures = summary(height, tried, handless)
        result["summary"].append(figures)
        result["attempts"] += [asdict(a) for a in tried]
        shares = [100.0 * figures[name] for name in ("vaulted", "clean", "middle", "without_joint")]
        print(
            f"{height:7.2f} {figures['starts']:7d} {shares[0]:7.1f}% {shares[1]:6.1f}% {shares[2]:6.1f}%"
            f" {figures['held']:5.2f} s {shares[3]:8.1f}%  {figures['ends']}",
            flush=True,
        )
        if options.film:
            good = next((a for a in tried if a.vaulted and not a.touched), tried[0])
            film(options.film.parent / f"{options.film.name}-{height:g}.png", height, good.distance)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
