"""How well the person jumps from the run: the paper's test, with the take-off errors and what went wrong.

    python -m benchmarks.jumping [--every 0.1] [--heights 0.3 0.4 0.5] [--json jumping.json] [--film out/jump]

For every height the person starts from standing at d = 10 to 30 m before a stair, runs up, jumps and runs
on: the whole way that a mission takes (path tracking, speed planner, skill) on a triangle mesh. Cleared: both
feet have carried it on top and it still runs 3 s after the jump. Clean: nothing but the feet touched the
stair. The film strips (--film) need MuJoCo's renderer, with MUJOCO_GL=egl where there is no display.
"""

import argparse
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from locomotion import MOVING, Ground, Human, ObstacleAhead
from locomotion import controller as c
from locomotion.events import TookOff

AFTER = 3.0
"""[s] of running on after the jump."""
NEAREST, FARTHEST = 10.0, 30.0
TOP = 24.0
"""[m] of stair behind the edge."""


@dataclass(frozen=True)
class Attempt:
    """One start. ended: "cleared", "fell in the run-up", "fell in the jump", "fell afterwards" or what else
    stopped it."""

    height: float
    distance: float
    ended: str
    clean: bool
    takeoff_error: float
    speed_error: float
    time: float


def stair(height: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces: a floor up to x = 0 and one ``height`` [m] above it behind."""
    corners: list[tuple[float, float, float]] = []
    faces = []
    for quad in (
        [(-FARTHEST - 5, -5, 0), (0, -5, 0), (0, 5, 0), (-FARTHEST - 5, 5, 0)],
        [(0, 5, 0), (0, -5, 0), (0, -5, height), (0, 5, height)],
        [(0, -5, height), (TOP + 5, -5, height), (TOP + 5, 5, height), (0, 5, height)],
    ):
        first = len(corners)
        corners += quad
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(corners, dtype=np.float64), np.array(faces)


def touches_stair(human: Human, height: float, feet: set[int]) -> bool:
    """Whether anything but a foot touches the stair (its face or its top near the edge)."""
    data = human.data
    for k in range(data.ncon):
        contact = data.contact[k]
        if contact.pos[0] > -0.12 and contact.pos[0] < 1.0 and contact.pos[2] > 0.05:
            bodies = {int(human.model.geom_bodyid[g]) for g in contact.geom} - {0}
            if not bodies & feet:
                return True
    return False


def attempt(
    ground: Ground, height: float, distance: float, frames: list[np.ndarray] | None = None
) -> Attempt:
    """Run up from ``distance`` [m], jump, run on; ``frames`` collects qpos every 40 ms from the jump on."""
    human = Human(ground)
    names = ("right_foot", "right_toes", "left_foot", "left_toes")
    feet = {human.index.bodies[name] for name in names}
    path = np.array([[-distance, 0, 0], [-1e-3, 0, 0], [1e-3, 0, height], [TOP, 0, height]])
    human.reset(path[0], 0.0)
    ahead = ObstacleAhead(distance, "jump", height, np.array([0.0, 0.0, height]), np.array([-1.0, 0.0, 0.0]))
    human.follow(path, 3.5, [ahead])
    jumped, landed, clean = False, [False, False], True
    done_at = np.inf
    while human.status in MOVING and human.time < min(done_at + AFTER, 40.0):
        human.tick()
        jumped = jumped or human.status == "jumping"
        state = human.control
        if frames is not None and jumped and round(human.time * 100) % 4 == 0:
            frames.append(human.qpos)
        if jumped and not all(landed):
            clean = clean and not touches_stair(human, height, feet)
            for k in range(2):
                foot = state[c.FEET][3 * k : 3 * k + 3]
                if foot[0] > 0.0 and foot[2] > height - 0.02 and state[c.CONTACT][k] > 20.0:
                    landed[k] = True
        if jumped and human.status == "running" and done_at == np.inf:
            done_at = human.time
    took_off = next((e for e in human.events if isinstance(e, TookOff)), None)
    if human.status == "running" and all(landed):
        ended = "cleared"
    elif human.status == "fallen":
        ended = (
            "fell in the run-up"
            if not jumped
            else "fell in the jump"
            if done_at == np.inf
            else "fell afterwards"
        )
    else:
        ended = f"did not get on top ({human.status})"
    distance_error, speed_error = (
        (took_off.takeoff_error, took_off.speed_error) if took_off else (np.nan,) * 2
    )
    return Attempt(height, float(distance), ended, clean, distance_error, speed_error, human.time)


def summary(height: float, attempts: list[Attempt]) -> dict[str, Any]:
    """The figures of one height."""
    n = len(attempts)
    ends = sorted({a.ended for a in attempts})
    errors = np.array([a.takeoff_error for a in attempts if np.isfinite(a.takeoff_error)])
    speeds = np.array([a.speed_error for a in attempts if np.isfinite(a.speed_error)])
    return {
        "height": height,
        "starts": n,
        "cleared": sum(a.ended == "cleared" for a in attempts) / n,
        "clean": sum(a.ended == "cleared" and a.clean for a in attempts) / n,
        "takeoff_error_rms": float(np.sqrt(np.mean(errors**2))) if len(errors) else np.nan,
        "speed_error_mean": float(np.mean(speeds)) if len(speeds) else np.nan,
        "speed_error_sd": float(np.std(speeds)) if len(speeds) else np.nan,
        "ends": {end: sum(a.ended == end for a in attempts) for end in ends},
    }


def film(path: Path, height: float, frames: list[np.ndarray], count: int = 14) -> None:
    """Write a strip of ``count`` pictures of the jump, 80 ms apart, in two rows."""
    import matplotlib.image

    from locomotion.skill import load_run_skill
    from locomotion.training.jump_trial import JumpSimulator

    simulator = JumpSimulator(load_run_skill())
    simulator.place_stair(0.0, height)
    model, data = simulator.model, simulator.data
    model.geom_size[simulator.stair, 1] = 0.9  # seen from beside it
    model.stat.extent = 4.0
    renderer = mujoco.Renderer(model, 400, 340)
    camera = mujoco.MjvCamera()
    camera.distance, camera.azimuth, camera.elevation = 3.6, 90.0, -8.0
    pictures = []
    for qpos in frames[: 2 * count : 2]:
        data.qpos[:] = qpos
        mujoco.mj_forward(model, data)
        camera.lookat[:] = qpos[0], 0.0, 0.8 + 0.5 * height
        renderer.update_scene(data, camera)
        picture = renderer.render().copy()
        picture[(picture == 0).all(axis=2)] = 235
        pictures.append(picture)
    pictures += [np.full_like(pictures[0], 235)] * (count - len(pictures))
    rows = [np.hstack(pictures[: count // 2]), np.hstack(pictures[count // 2 :])]
    path.parent.mkdir(parents=True, exist_ok=True)
    matplotlib.image.imsave(path, np.vstack(rows))


def main() -> None:
    """Try every start, print a table, write JSON and film strips."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--heights", type=float, nargs="+", default=[0.3, 0.4, 0.5], help="[m]")
    parser.add_argument("--every", type=float, default=0.1, help="step of the distance [m]")
    parser.add_argument("--json", type=Path, help="file to write")
    parser.add_argument("--film", type=Path, help="beginning of the names of film strips to write")
    options = parser.parse_args()
    result: dict[str, Any] = {"summary": [], "attempts": []}
    print(f"{'height':>7} {'starts':>7} {'cleared':>8} {'clean':>7} {'d error':>12} {'v error':>16}  ends")
    for height in options.heights:
        ground = Ground.from_arrays(*stair(height))
        begun = time.perf_counter()
        distances = np.arange(round((FARTHEST - NEAREST) / options.every) + 1) * options.every + NEAREST
        attempts = [attempt(ground, height, float(d)) for d in distances]
        figures = summary(height, attempts)
        figures["seconds"] = time.perf_counter() - begun
        result["summary"].append(figures)
        result["attempts"] += [asdict(a) for a in attempts]
        print(
            f"{height:7.2f} {figures['starts']:7d} {100 * figures['cleared']:7.1f}%"
            f" {100 * figures['clean']:6.1f}% {figures['takeoff_error_rms']:10.3f} m"
            f" {figures['speed_error_mean']:+.2f} ± {figures['speed_error_sd']:.2f} m/s  {figures['ends']}",
            flush=True,
        )
        if options.film:
            good = next((a for a in attempts if a.ended == "cleared"), attempts[0])
            frames: list[np.ndarray] = []
            attempt(ground, height, good.distance, frames)
            film(options.film.parent / f"{options.film.name}-{height:g}.png", height, frames)
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
