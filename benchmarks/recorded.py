"""Recorded motion: the figures of `docs/guides/recorded-motion.md`, one row or all.

python -m benchmarks.recorded
python -m benchmarks.recorded --rows posing slide --seed 5
"""

import argparse
import json
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.body.traits import by_chance
from locomotion.recorded.changes import changes, encoded, in_steps
from locomotion.recorded.foot_planting import planted
from locomotion.recorded.footfalls import BALL, BEARS, FEET, HEEL, STRIKES, Steps, footing_at
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.posing import pose_bodies, posed
from locomotion.recorded.sampling import sample_clips, sample_gait
from locomotion.recorded.skeletons import FULL, LEVELS, LOW, MEDIUM, skeleton
from locomotion.recorded.slaving import LANDMARKS, landmarks_of, matched

MOTIONS = load_motions()


def slaving(seed: int) -> None:
    """Hands and feet of the lower figures against those of the full one, in every frame that is kept."""
    for level in (MEDIUM, LOW):
        own, kept = skeleton(LEVELS[level]), MOTIONS.levels[level]
        off, held, least = [], [], []
        for clip, about in enumerate(MOTIONS.clips):
            count, rows = int(kept.count[clip]), slice(kept.first[clip], kept.first[clip] + kept.count[clip])
            steps = np.arange(count) / max(count - (about.kind != "cycle"), 1)
            full = sample_clips(MOTIONS, FULL, np.full(count, clip), steps * about.seconds)
            master = landmarks_of(skeleton("full").as_qpos(*full))
            mine = landmarks_of(own.as_qpos(kept.channels[rows], kept.roots[rows]))
            missed = np.linalg.norm(mine - master, axis=2)
            counts = np.array(matched(own))
            off.append(missed[:, counts])
            least.append((float(np.percentile(missed[:, counts], 95)), about.name))
            if all("/" in end for end in about.name.split(" to ")):
                held.append(missed[:, [mark.name.endswith("hand") for mark in LANDMARKS]])
        every, holding = np.concatenate(off), np.concatenate(held)
        worst = ", ".join(f"{name} {100 * value:.1f}" for value, name in sorted(least)[:-4:-1])
        print(
            f"slaving, {LEVELS[level]}: {len(every)} frames, hands and feet off by "
            f"{100 * np.percentile(every, 95):.2f} cm at the 95th percentile, held objects by "
            f"{1000 * np.percentile(holding, 95):.1f} mm (most {1000 * holding.max():.1f}); "
            f"worst clips [cm]: {worst}"
        )


def playback(seed: int) -> None:
    """The same pose at the same time, at any frame rate."""
    rng, clips, different = np.random.default_rng(seed), np.arange(len(MOTIONS.clips)), 0
    for level in range(len(LEVELS)):
        for clip in clips:
            marks = rng.uniform(0.0, 3.0, 20)
            alone = [sample_clips(MOTIONS, level, [clip], [mark]) for mark in marks]
            for step in (1 / 20, 1 / 33, 1 / 60, 1 / 144, None):
                frames = np.cumsum(rng.exponential(0.03, 60) if step is None else np.full(60, step))
                times = np.sort(np.concatenate([frames, marks]))
                together = sample_clips(MOTIONS, level, np.full(len(times), clip), times)
                for mark, (channels, roots) in zip(marks, alone, strict=True):
                    at = int(np.flatnonzero(times == mark)[0])
                    same = together[0][at].tobytes() == channels[0].tobytes()
                    different += not (same and together[1][at].tobytes() == roots[0].tobytes())
    rates = "20, 33, 60, 144 Hz and random steps"
    print(f"playback: {len(clips)} clips at {rates}: {different} poses differ in a bit")


def _level(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return np.zeros(len(points)), np.tile([0.0, 0.0, 1.0], (len(points), 1))


def _slope(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    normal = np.array([-0.15, 0.08, 1.0])
    return 0.15 * points[:, 0] - 0.08 * points[:, 1], np.tile(
        normal / np.linalg.norm(normal), (len(points), 1)
    )


def _stairs(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    return 0.17 * np.floor(points[:, 0] / 0.3), np.tile([0.0, 0.0, 1.0], (len(points), 1))


def slide(seed: int) -> None:
    """What stands of a foot, and how far it moves in a stance, along bends at a speed that varies."""
    rng = np.random.default_rng(seed)
    for ground in (_level, _slope, _stairs):
        for level in (FULL, MEDIUM, LOW):
            found = np.concatenate([_slides(level, ground, rng) for _ in range(10)])
            print(
                f"slide, {ground.__name__[1:]}, {LEVELS[level]}: {len(found)} stances, "
                f"{100 * np.median(found):.2f} cm in the median, {100 * found.max():.2f} cm at most"
            )


def _slides(level: int, ground: Callable, rng: np.random.Generator, count: int = 600) -> NDArray[np.float64]:
    angle, radius, swing = np.linspace(0.0, 1.0, 80), rng.uniform(6.0, 12.0), rng.uniform(1.0, 6.0)
    path = radius * np.stack([np.sin(angle), 1.0 - np.cos(angle), 0.0 * angle], axis=1)
    path[:, 2] = ground(path)[0]
    speeds = 1.1 + 0.5 * np.sin(swing * angle + rng.uniform(0.0, 6.0))
    steps = Steps(MOTIONS, "walk", path, speeds, ground)
    distances = np.linspace(0.0, steps.length, count)
    phases, places = zip(*(steps.at(distance) for distance in distances), strict=True)
    at, gaits = [steps.speed_at(d) for d in distances], np.full(count, MOTIONS.gait("walk"))
    footfalls = np.array([steps.footfalls(phase) for phase in phases])
    sample, own = sample_gait(MOTIONS, level, gaits, at, phases), skeleton(LEVELS[level])
    bodies = posed(own, *planted(MOTIONS, level, (gaits, at, phases), sample, places, footfalls))
    table, out = footing_at(MOTIONS, gaits[0], at), []
    for side, name in enumerate(FEET):
        foot = bodies[:, own.bodies.index(name)]
        turns = Rotation.from_quat(foot[:, 3:], scalar_first=True)
        ends = np.stack([foot[:, :3] + turns.apply(end) for end in (HEEL, BALL)], axis=1)
        since, lowest = np.array(phases) - table[:, side, STRIKES], ends[:, :, 2].min(axis=1)
        bears, numbers = since % 1.0 < table[:, side, BEARS], np.floor(since)
        for number in np.unique(numbers)[1:-1]:
            rows = bears & (numbers == number)
            moved = [
                np.ptp(ends[rows & (ends[:, k, 2] < lowest + 0.003), k, :2], axis=0)
                for k in range(2)
                if (rows & (ends[:, k, 2] < lowest + 0.003)).any()
            ]
            out.append(max(float(np.linalg.norm(each)) for each in moved))
    return np.array(out)


def wire(seed: int) -> None:
    """Joint angles a second, and bytes, of a figure that walks, sits down and runs: full against low."""
    script = [("walk 1.25", 6.0), ("stand to crouch", 0.7), ("crouch to sit", 1.0), ("run 3", 4.0)]
    told = {}
    for level in range(len(LEVELS)):
        rate, angles, size, seconds, sent = skeleton(LEVELS[level]).rate, 0, 0, 0.0, None
        for name, lasts in script:
            count = int(lasts * rate)
            clips = np.full(count, MOTIONS.clip(name))
            channels, _ = sample_clips(MOTIONS, level, clips, np.arange(count) / rate)
            for frame in in_steps(level, channels):
                update, sent = changes(sent, frame), frame
                if update is not None:
                    angles, size = angles + len(update.indices), size + len(encoded(1, update))
            seconds += lasts
        told[level] = angles / seconds, size / seconds
        most = len(skeleton(LEVELS[level]).channels) * rate
        print(
            f"wire, {LEVELS[level]}: {most:.0f} joint angles a second at most, {told[level][0]:.0f} changed, "
            f"{told[level][1]:.0f} bytes/s"
        )
    angles, size = (told[FULL][k] / told[LOW][k] for k in range(2))
    print(f"wire: full takes {angles:.1f} x the angles of low, {size:.1f} x the bytes")


def _best(call: Callable[[], object], rounds: int = 30) -> float:
    """[ms]"""
    call()
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return 1000.0 * min(times)


def posing(seed: int) -> None:
    """Milliseconds to pose many figures, and to sample and pose them."""
    rng = np.random.default_rng(seed)
    for level, count in ((LOW, 10_000), (MEDIUM, 1000), (FULL, 1000)):
        own, gaits = skeleton(LEVELS[level]), np.full(count, MOTIONS.gait("walk"))
        speeds, phases = rng.uniform(0.3, 1.8, count), rng.random(count)
        sample = sample_gait(MOTIONS, level, gaits, speeds, phases)
        out = np.empty((count, len(own.bodies), 7))
        tables = own.parents, own.offsets, own.first, own.axes, own.signs
        alone = _best(lambda t=tables, s=sample, o=out: pose_bodies(*t, *s, o))
        both = _best(
            lambda a=level, g=gaits, v=speeds, p=phases, o=own: posed(o, *sample_gait(MOTIONS, a, g, v, p))
        )
        print(f"posing {count} {LEVELS[level]} figures: {alone:.2f} ms; sampled and posed: {both:.2f} ms")


def three(seed: int) -> None:
    """1,000 full figures here and with three.js's AnimationMixer in node, in the same run."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        print("three: needs node and npm")
        return
    own, count = skeleton("full"), 1000
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run([npm, "install", "--prefix", folder, "three"], capture_output=True, text=True)
        module = Path(folder) / "node_modules/three/build/three.module.js"
        if made.returncode or not module.exists():
            print("three: npm could not install it")
            return
        setup = {"parents": own.parents.tolist(), "figures": count, "rounds": 60, "keys": 67}
        file = Path(folder) / "skeleton.json"
        file.write_text(json.dumps(setup), encoding="utf-8")
        script = Path(__file__).with_suffix(".mjs")
        told = subprocess.run([node, script, module, file], capture_output=True, text=True, check=True).stdout
    theirs, clip = json.loads(told), MOTIONS.clip("walk 1.25")
    times = np.random.default_rng(seed).uniform(0.0, 60.0, count)
    clips = np.full(count, clip)
    ours = _best(lambda: posed(own, *sample_clips(MOTIONS, FULL, clips, times)))
    print(
        f"three: 1000 figures of {len(own.bodies)} bodies, sampled and posed: {ours:.2f} ms; "
        f"three.js r{theirs['version']}: {theirs['update']:.2f} ms to sample, {theirs['both']:.2f} ms with "
        f"its matrices; ratio {ours / theirs['both']:.2f} (sampling alone {ours / theirs['update']:.2f})"
    )


def memory(seed: int) -> None:
    """Bytes of one figure beyond the shared set: its traits, clip, time or phase, speed and two footfalls of
    each foot."""
    own = by_chance(seed).nbytes + 5 * 8 + 4 * 8 + 2 * 2 * 6 * 8
    print(f"memory: {own} bytes a figure; the shared set: {MOTIONS.nbytes / 1e6:.2f} MB")


ROWS = {row.__name__: row for row in (slaving, playback, slide, wire, posing, three, memory)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", nargs="+", choices=list(ROWS), default=list(ROWS))
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for name in options.rows:
        ROWS[name](options.seed)


if __name__ == "__main__":
    main()
