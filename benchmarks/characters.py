"""Characters of other proportions show our persons: how well do feet and hands fit?

    python -m benchmarks.characters [--characters HERO.glb ...] [--motions walk jump] [--seed 0]

Three characters (`examples/make_characters.py`), or your own, show what simulated persons do, and a walk
through the posture graph. Of every frame in which a foot of the person stands (its lowest point within 1 mm
of the ground, the shank not lying) is measured, of the person itself and of each character:

  over, under   lowest point of the foot over or under the ground [mm]: worst and 95th percentile
  slide         how far what touches the ground moves along it while the foot stands [mm]: worst and 95th
                percentile of the stances in which the person's own foot slides by less than 10 mm and turns
                by less than 10 degrees (how many of all); then of all stances
  hand          from the hand to where the person's is, while that touches something [mm]: worst and 95th
                percentile; with a rifle, how much further from each other the hands are than the person's

Then the time to pose one character once, and in a batch.
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from examples.make_characters import CHARACTERS, write_character
from locomotion import Ground, Rig
from locomotion.body.person import BODY_NAMES
from locomotion.characters.contacts import contacts_with
from locomotion.characters.person_measures import person_arrays
from locomotion.characters.skinning import posed_points
from locomotion.ground.ground import extruded
from locomotion.postures.playback import asked_for, at_rest, pose_at
from locomotion.postures.posture_file import load_postures
from locomotion.recorded.posing import posed, whole_figures
from locomotion.recorded.skeletons import skeleton
from navmesh import Terrain
from runtime import World
from runtime.evaluation.courses import make_course, run_course

__all__ = ["MOTIONS", "Recorded", "measure", "recorded"]

_STANDS, _TOUCHES = 0.001, 0.99  # [m]; weight of a hand
_STAYS, _STRAIGHT = 0.01, np.radians(10.0)
"""[m], [rad] of a foot that stays where it is while it stands."""
_STEEP = 0.5  # cosine of the lean of a shank on which one stands
_SEEN = 0.06  # [m] above a point in which ground over it is looked for
_STAIRS = (0.30, 0.16, 8)  # [m] depth and height of a step, and how many
_POSTURES = Path(__file__).parent.parent / "locomotion/data/postures/person.yaml"


@dataclass(frozen=True, eq=False)
class Recorded:
    """What a person did: places (n, 20, 7) of its bodies, ``step`` [s] apart; vertices and faces of the level
    on which it was; grip: whether both hands hold one thing."""

    name: str
    places: NDArray[np.float64]
    step: float
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    grip: bool = False

    @property
    def ground(self) -> Ground:
        return Ground.from_arrays(self.vertices, self.faces)


def _flat() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    return extruded([(-3.0, 0.0), (30.0, 0.0)], 4.0)


def _stairs() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    depth, height, count = _STAIRS
    line = [(-3.0, 0.0)]
    for k in range(count):
        line += [(3.0 + k * depth, k * height), (3.0 + k * depth, (k + 1) * height)]
    top = 3.0 + count * depth + 2.0
    for k in range(count):
        line += [(top + k * depth, (count - k) * height), (top + k * depth, (count - k - 1) * height)]
    return extruded([*line, (top + count * depth + 4.0, 0.0)], 2.0)


def _slope() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    rise = 4.0 * np.tan(np.radians(15.0))
    return extruded([(-3.0, 0.0), (2.0, 0.0), (6.0, rise), (8.0, rise), (12.0, 0.0), (16.0, 0.0)], 2.0)


def _in_world(
    name: str, level: tuple[NDArray[np.float64], NDArray[np.int64]], far: float, speed: float, seed: int
) -> Recorded:
    """A person goes along x from the origin."""
    world = World(Terrain.from_arrays(*level), seed=seed)
    agent = world.spawn("human", at=(0.0, 0.0, 0.0))
    agent.go_to((far, 0.0, 0.0), speed=speed)
    order = [agent.pose.names.index(name) for name in BODY_NAMES]
    places = []
    while agent.moving and world.time < 40.0:
        world.step(1 / 60)
        places.append(agent.pose.transforms[order])
    return Recorded(name, np.array(places), 1 / 60, *level)


def places_of(qpos: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places (n, 20, 7) of the bodies in poses (n, 46)."""
    own = skeleton("full")
    return whole_figures(own, posed(own, qpos[:, 7:], qpos[:, :7]))


def _over(name: str, affordance: str, height: float) -> Recorded:
    """A person that clears an obstacle, from the first start from which it arrives; until it is on foot."""
    for distance in np.arange(13.0, 20.0, 0.7):
        course = make_course([(affordance, height, 0.3)], [float(distance)])
        run = run_course(course, keep_frames=True)
        if run.ended == "arrived":
            frames = np.array(run.frames)
            edge = course.obstacles[0].position[0]
            near = (frames[:, 0] > edge - 4.0) & (frames[:, 0] < edge + 5.0)
            return Recorded(name, places_of(frames[near]), 0.01, course.vertices, course.faces)
    raise RuntimeError(f"nobody gets over the {affordance}")


def _postures(name: str, postures: Sequence[str], grip: bool = False) -> Recorded:
    """Through the posture graph, waiting in each posture."""
    graph = load_postures(_POSTURES)
    playback, now, poses = at_rest(graph, postures[0], (0.0, 0.0, 0.0)), 0.0, []
    for posture in postures:
        playback = asked_for(graph, playback, posture, now)
        end = now + float(graph.least[playback.posture, graph.postures.index(posture)]) + 3.5
        while now < end:
            poses.append(pose_at(graph, playback, now))
            now += 1 / 60
    return Recorded(name, places_of(np.array(poses)), 1 / 60, *_flat(), grip)


_THROUGH = ("stand", "kneel", "all-fours", "prone", "stand", "crouch", "sit", "stand")
_ARMED = tuple(
    f"{posture}/rifle {state}" for posture in ("stand", "kneel") for state in ("deployed", "in use")
)


MOTIONS: dict[str, Callable[[int], Recorded]] = {
    "walk": lambda seed: _in_world("walk", _flat(), 8.0, 1.3, seed),
    "fast walk": lambda seed: _in_world("fast walk", _flat(), 10.0, 1.9, seed),
    "run": lambda seed: _in_world("run", _flat(), 24.0, 3.5, seed),
    "stairs": lambda seed: _in_world("stairs", _stairs(), 11.0, 1.0, seed),
    "slopes": lambda seed: _in_world("slopes", _slope(), 14.0, 1.3, seed),
    "jump": lambda seed: _over("jump", "jump", 0.5),
    "vault": lambda seed: _over("vault", "vault", 0.8),
    "roll": lambda seed: _over("roll", "drop", 1.4),
    "postures": lambda seed: _postures("postures", _THROUGH),
    "rifle": lambda seed: _postures("rifle", _ARMED, grip=True),
}


def recorded(name: str, seed: int) -> Recorded:
    """One of `MOTIONS`."""
    return MOTIONS[name](seed)


@dataclass(frozen=True)
class Fit:
    """Figures [m]: gaps (n,) of standing feet over the ground, slides (s,) of the stances in which the
    person's foot stays, and of ``all_slides``, hands (h,)."""

    gaps: NDArray[np.float64]
    slides: NDArray[np.float64]
    hands: NDArray[np.float64]
    all_slides: NDArray[np.float64]


def _heights(ground: Ground, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(...,) how far points (..., 3) are over the ground."""
    flat = points.reshape(-1, 3)
    below, _ = ground.surface_below(flat + np.array([0.0, 0.0, _SEEN]))
    return (flat[:, 2] - below).reshape(points.shape[:-1])


def _soles_of_person(places: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """(n, k, 3) points on the lower sides of the capsules of each foot."""
    person = person_arrays()
    down = np.linspace(0.0, 1.9, 12)
    around = np.linspace(0.0, 2.0 * np.pi, 13)[:-1]
    a, d = (each.reshape(-1) for each in np.meshgrid(around, down))
    balls = np.column_stack([np.sin(d) * np.cos(a), np.sin(d) * np.sin(a), -np.cos(d)])
    found = []
    for side in range(2):
        points = []
        for limb, ends in ((2, person.feet[side]), (3, person.toes[side])):
            body = places[:, person.limbs[limb, side]]
            points += [_turned(body, end[:3] + end[3] * ball) for end in ends for ball in balls]
        found.append(np.stack(points, axis=1))
    return found


def _upright(turns: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) cosine of the angle between the z axis of what is turned by (n, 4) and the vertical."""
    return 1.0 - 2.0 * (turns[:, 1] ** 2 + turns[:, 2] ** 2)


def _turned(body: NDArray[np.float64], point: NDArray[np.float64]) -> NDArray[np.float64]:
    w, v = body[:, 3:4], body[:, 4:]
    twice = 2.0 * np.cross(v, point)
    return body[:, :3] + point + w * twice + np.cross(v, twice)


def _soles(rig: Rig, poses: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """(n, k, 3) points of the mesh of each foot, lowest 60 at rest."""
    skeleton = rig.skeleton
    most = skeleton.mesh.bones[np.arange(len(skeleton.mesh.bones)), skeleton.mesh.shares.argmax(axis=1)]
    names = np.array(skeleton.names)
    found = []
    for side in ("right", "left"):
        bones = [rig.parts[part] for part in (f"{side}_foot", f"{side}_toes") if part in rig.parts]
        own = np.flatnonzero(np.isin(names[most], bones))
        own = own[np.argsort(skeleton.mesh.points[own, 2], kind="stable")[:160]]
        found.append(np.stack([posed_points(skeleton, pose, own) for pose in poses]))
    return found


def _slides(
    points: NDArray[np.float64], heights: NDArray[np.float64], stands: NDArray[np.bool_]
) -> list[float]:
    """How far what touches moves along the ground during each stance."""
    slides, drift, frames = [], np.zeros(2), 0
    for k in range(1, len(points)):
        if stands[k] and stands[k - 1]:
            low = np.maximum(heights[k], heights[k - 1])
            touching = low <= np.nanmin(low) + 0.002
            drift = drift + (points[k, touching] - points[k - 1, touching])[:, :2].mean(axis=0)
            frames += 1
        elif frames:
            slides.append(float(np.linalg.norm(drift)))
            drift, frames = np.zeros(2), 0
    return [*slides, float(np.linalg.norm(drift))] if frames else slides


def _turned_by(turns: NDArray[np.float64], stands: NDArray[np.bool_]) -> list[float]:
    """How far [rad] a foot with the rotations (n, 4) turns about the vertical during each stance."""
    yaw = np.arctan2(
        2.0 * (turns[:, 1] * turns[:, 2] + turns[:, 0] * turns[:, 3]),
        1.0 - 2.0 * (turns[:, 2] ** 2 + turns[:, 3] ** 2),
    )
    edges = np.flatnonzero(np.diff(np.concatenate([[False], stands, [False]]).astype(int)))
    return [
        float(np.ptp(np.unwrap(yaw[a:b]))) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > 1
    ]


def measure(motion: Recorded, rig: Rig | None) -> Fit:
    """The figures of a character, or of the person itself, in a motion."""
    ground = motion.ground
    person = _soles_of_person(motion.places)
    hands = contacts_with(ground, motion.places).hands
    gaps, slides, every = [], [], []
    held = np.empty(0)
    soles = person
    if rig is not None:
        times = motion.step * np.arange(len(motion.places))
        poses = rig.pose_motion(motion.places, times, BODY_NAMES, ground, float(motion.grip))
        soles = _soles(rig, poses)
        off = _hands_off(rig, poses, motion.places)
        held = np.linalg.norm(off, axis=2)[hands > _TOUCHES]
        if motion.grip:
            held = np.linalg.norm(off[:, 0] - off[:, 1], axis=1)
    for side in range(2):
        own = _heights(ground, person[side])
        shank = motion.places[:, person_arrays().limbs[1, side], 3:]
        stands = (np.nanmin(own, axis=1) < _STANDS) & (_upright(shank) > _STEEP)
        heights = own if rig is None else _heights(ground, soles[side])
        gaps.append(np.nanmin(heights, axis=1)[stands])
        itself = np.array(_slides(person[side], own, stands))
        turned = np.array(_turned_by(motion.places[:, person_arrays().limbs[2, side], 3:], stands))
        quiet = (itself < _STAYS) & (turned < _STRAIGHT)
        own_slides = np.array(_slides(soles[side], heights, stands))
        slides.append(own_slides[quiet])
        every.append(own_slides)
    return Fit(np.concatenate(gaps), np.concatenate(slides), held, np.concatenate(every))


def _hands_off(rig: Rig, poses: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2, 3) from the hands' points to the person's."""
    person = person_arrays()
    found = []
    for side, name in enumerate(("right", "left")):
        wanted = _turned(places[:, person.limbs[6, side]], person.hand)
        bone = rig.names.index(rig.parts[f"{name}_hand"])
        point = rig.hand_points[side]
        found.append(_turned(poses[:, bone], point) - wanted)
    return np.stack(found, axis=1)


def _worst(values: NDArray[np.float64]) -> str:
    size = 1000.0 * np.abs(values[np.isfinite(values)])
    return f"{size.max():6.1f} {np.percentile(size, 95):6.1f}" if len(size) else "     -      -"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--characters", nargs="*", type=Path, default=[])
    parser.add_argument("--motions", nargs="*", choices=list(MOTIONS), default=list(MOTIONS))
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        files = options.characters
        if not files:
            files = [Path(folder) / f"{who.name}.glb" for who in CHARACTERS]
            for who, file in zip(CHARACTERS, files, strict=True):
                write_character(who, file)
        rigs: dict[str, Rig | None] = {"(person)": None}
        rigs |= {file.stem: Rig.load(file) for file in files}
    print(
        f"{'motion':10} {'character':10} "
        + " ".join(f"{name:>13}" for name in ("over", "under", "slide", "all slides", "hand"))
        + "  [mm]"
    )
    motion = None
    for name in options.motions:
        motion = recorded(name, options.seed)
        for who, rig in rigs.items():
            fit = measure(motion, rig)
            over, under = np.maximum(fit.gaps, 0.0), np.minimum(fit.gaps, 0.0)
            row = " ".join(_worst(each) for each in (over, under, fit.slides, fit.all_slides, fit.hands))
            print(
                f"{name:10} {who:10} {row}   {len(fit.slides)} of {len(fit.all_slides)} stances", flush=True
            )
    assert motion is not None
    ground = motion.ground
    for who, rig in rigs.items():
        if rig is not None:
            begun = time.perf_counter()
            for places in motion.places[:200]:
                rig.pose_from(places, ground=ground)
            one = (time.perf_counter() - begun) / len(motion.places[:200])
            begun = time.perf_counter()
            rig.pose_from(motion.places, ground=ground)
            batch = (time.perf_counter() - begun) / len(motion.places)
            bones = len(rig.names)
            print(f"{who}: {1e6 * one:.0f} us for a pose of {bones} bones, {1e6 * batch:.1f} us in a batch")


if __name__ == "__main__":
    main()
