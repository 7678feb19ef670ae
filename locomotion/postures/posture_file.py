"""Read posture graphs from YAML files."""

import os
from pathlib import Path

import numpy as np

from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.clips.motion import load_motion
from locomotion.postures.arcs import arc_between, arc_of_motion, pose_of
from locomotion.postures.held_objects import Capsule, HeldNode, derived_arcs, held_nodes
from locomotion.postures.places import inverse
from locomotion.postures.posture_check import check_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.schema import ArcEntry, Joints, KeyEntry, PostureEntry, PostureFile
from locomotion.postures.step_order import Gait
from surefoot.files.yamlfile import FileError, Key, nearest, read_yaml

__all__ = ["check_posture_file", "load_postures"]

_SIDES = "right_", "left_"


def load_postures(path: str | os.PathLike[str]) -> PostureGraph:
    """The posture graph of a YAML file (docs/guides/postures.md). Raises `FileError` with line and column
    for anything wrong in it, `LocomotionError` for a motion that cannot be read."""
    return _Reader(Path(path)).graph()


def check_posture_file(path: str | os.PathLike[str]) -> tuple[PostureGraph, list[FileError]]:
    """The graph of a file, and everything that is wrong with its postures and motions
    (`locomotion.postures.posture_check`), each with its line and column. Raises as `load_postures`."""
    reader = _Reader(Path(path))
    graph = reader.graph()
    return graph, [
        reader.located.error(*reader.address(fault.arc, fault.posture, fault.problem), at_key=fault.arc < 0)
        for fault in check_postures(graph)
    ]


class _Reader:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.file, self.located = read_yaml(path, PostureFile, "posture file")
        postures = self.file.postures
        self.angles = {name: self._angles(p, ["postures", name]) for name, p in postures.items()}
        poses = [pose_of(self.angles[name], p.pitch, p.roll) for name, p in postures.items()]
        self.names, self.held = tuple(postures), held_nodes(self.file)
        for node in self.held:
            at: list[Key] = ["objects", node.object, "states", node.state]
            self._posture(node.posture, [*at, "in", node.posture], at_key=True)
            angles = self._angles(node, at)
            self.angles[node.name] = self.angles[node.posture] | angles
            lies = postures[node.posture]
            poses.append(pose_of(self.angles[node.name], lies.pitch, lies.roll))
        self.names += tuple(node.name for node in self.held)
        self.poses, self.derived = np.array(poses), list(derived_arcs(self.file))

    def address(self, arc: int, posture: int, problem: str) -> tuple[list[Key], str]:
        """Where the file tells of an arc, or if that is -1 of a posture; and the problem there, which for
        one that is derived says which it is."""
        if 0 <= arc < len(self.file.arcs):
            return ["arcs", arc], problem
        if arc >= 0:
            made = self.derived[arc - len(self.file.arcs)]
            problem = f"from {made.start!r} to {made.end!r}: {problem}"
            return ["objects", made.object, "states", made.state], problem
        if posture < len(self.file.postures):
            return ["postures", self.names[posture]], problem
        node = self.held[posture - len(self.file.postures)]
        return ["objects", node.object, "states", node.state], f"{node.name!r}: {problem}"

    def graph(self) -> PostureGraph:
        file, own, fatal = self.file, len(self.file.arcs), -1
        if file.fatal is not None:
            fatal = self._posture(file.fatal, ["fatal"])
        starts = [self._posture(a.from_, ["arcs", k, "from"]) for k, a in enumerate(file.arcs)]
        ends = [self._posture(a.to, ["arcs", k, "to"]) for k, a in enumerate(file.arcs)]
        for k in range(own):
            if starts[k] == ends[k]:
                raise self.located.error(["arcs", k, "to"], "an arc leads to another posture")
        start = np.array(starts + [self.names.index(arc.start) for arc in self.derived], np.int32)
        end = np.array(ends + [self.names.index(arc.end) for arc in self.derived], np.int32)
        backwards = [arc.backwards for arc in (*file.arcs, *self.derived)]
        forward = [k for k, back in enumerate(backwards) if not back]
        made = {k: self._frames(file.arcs[k], k, start[k], end[k]) for k in forward if k < own}
        made |= {k: self._derived_frames(k - own, made, start[k], end[k]) for k in forward if k >= own}
        first = dict(zip(forward, np.cumsum([0, *(len(made[k][0]) for k in forward)]), strict=False))
        source = [
            k
            if k in made
            else self._source(k, start[:own], end[:own])
            if k < own
            else _opposite(k, start, end, forward, own)
            for k in range(len(start))
        ]
        moves = [made[k][1] if k == s else inverse(made[s][1]) for k, s in enumerate(source)]
        return PostureGraph(
            name=file.name or self.path.stem,
            postures=self.names,
            fatal=fatal,
            fatal_seconds=file.fatal_seconds,
            poses=self.poses,
            start=start,
            end=end,
            seconds=np.array([made[s][2] for s in source]),
            moves=np.array(moves).reshape(-1, 3),
            backwards=np.array(backwards, np.bool_),
            frames=np.concatenate([np.zeros((0, self.poses.shape[1])), *(made[k][0] for k in forward)]),
            first=np.array([first[s] for s in source], np.int32),
            count=np.array([len(made[s][0]) for s in source], np.int32),
            objects={name: tuple(thing.states) for name, thing in file.objects.items()},
            shapes={
                name: tuple(Capsule(part.from_, part.to, part.radius, part.colour) for part in thing.shapes)
                for name, thing in file.objects.items()
            },
            gaits=tuple(
                Gait(
                    name, self._posture(gait.posture, ["gaits", name, "posture"]), gait.steps, gait.slowest,
                    gait.fastest, gait.backwards,
                )
                for name, gait in file.gaits.items()
            ),
        )  # fmt: skip

    def _derived_frames(
        self, number: int, made: dict[int, tuple[np.ndarray, np.ndarray, float]], start: int, end: int
    ) -> tuple[np.ndarray, np.ndarray, float]:
        arc = self.derived[number]
        if arc.like < 0:
            poses = self.poses[[start, end]]
            return *arc_between(poses, [0.0, 1.0], arc.seconds, "pelvis"), arc.seconds
        frames, move, seconds = made[arc.like]
        state = self.file.objects[arc.object].states[arc.state]
        own = state.in_[self.file.arcs[arc.like].from_]
        frames = frames.copy()
        for entry in (state, own):
            for name, angle in self._angles(entry, ["objects", arc.object, "states", arc.state]).items():
                frames[:, 7 + JOINT_NAMES.index(name)] = np.radians(angle)
        return frames, move, seconds

    def _frames(self, arc: ArcEntry, k: int, start: int, end: int) -> tuple[np.ndarray, np.ndarray, float]:
        if arc.motion is not None:
            motion = load_motion(self.path.parent / arc.motion)
            last = motion.duration if arc.end is None else arc.end
            if not arc.begin < last <= motion.duration + 1e-9:
                raise self.located.error(
                    ["arcs", k, "motion"],
                    f"{arc.motion}: from {arc.begin:g} to {last:g} s of {motion.duration:.2f} s",
                )
            frames, move = arc_of_motion(motion, arc.begin, last)
            return frames, move, (len(frames) - 1) / motion.rate
        assert arc.seconds is not None
        if arc.standing_on not in BODY_NAMES:
            hint = nearest(arc.standing_on, BODY_NAMES)
            problem = f"no part is called {arc.standing_on!r}; {hint}valid: {', '.join(BODY_NAMES)}"
            raise self.located.error(["arcs", k, "standing_on"], problem)
        keys = [self._key(key, ["arcs", k, "keys", i]) for i, key in enumerate(arc.keys)]
        shares = [0.0, *(key.at for key in arc.keys), 1.0]
        for i in range(1, len(shares) - 1):
            if shares[i] <= shares[i - 1]:
                raise self.located.error(["arcs", k, "keys", i - 1, "at"], "shares must grow from key to key")
        poses = np.array([self.poses[start], *keys, self.poses[end]])
        return *arc_between(poses, shares, arc.seconds, arc.standing_on), arc.seconds

    def _key(self, key: KeyEntry, at: list[Key]) -> np.ndarray:
        angles = self._angles(key, at)
        if key.like is not None:
            angles = self.angles[self.names[self._posture(key.like, [*at, "like"])]] | angles
        return pose_of(angles, key.pitch, key.roll)

    def _source(self, k: int, start: np.ndarray, end: np.ndarray) -> int:
        """The arc whose frames arc ``k`` has: itself, or its opposite."""
        if not self.file.arcs[k].backwards:
            return k
        found = [
            i
            for i, arc in enumerate(self.file.arcs)
            if not arc.backwards and start[i] == end[k] and end[i] == start[k]
        ]
        if len(found) != 1:
            ways = f"{len(found)} arcs" if found else "no arc"
            raise self.located.error(
                ["arcs", k, "backwards"],
                f"there is {ways} from {self.file.arcs[k].to!r} to {self.file.arcs[k].from_!r}; expected one",
            )
        return found[0]

    def _posture(self, name: str, at: list[Key], at_key: bool = False) -> int:
        if name not in self.names:
            hint = nearest(name, self.names)
            problem = f"no posture is called {name!r}; {hint}valid: {', '.join(self.names)}"
            raise self.located.error(at, problem, at_key=at_key)
        return self.names.index(name)

    def _angles(self, entry: PostureEntry | Joints | HeldNode, at: list[Key]) -> dict[str, float]:
        angles = {}
        for key, values in (("both", entry.both), ("joints", entry.joints)):
            for name, angle in values.items():
                for joint in [side + name for side in _SIDES] if key == "both" else [name]:
                    if joint not in JOINT_NAMES:
                        hint = nearest(joint, JOINT_NAMES)
                        problem = f"no joint is called {joint!r}; {hint}valid: {', '.join(JOINT_NAMES)}"
                        raise self.located.error([*at, key, name], problem, at_key=True)
                    angles[joint] = angle
        return angles


def _opposite(k: int, start: np.ndarray, end: np.ndarray, forward: list[int], own: int) -> int:
    """The derived arc that leads the other way."""
    return next(i for i in forward if i >= own and start[i] == end[k] and end[i] == start[k])
