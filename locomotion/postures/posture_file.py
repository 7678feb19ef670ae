"""Read posture graphs from YAML files."""

import os
from pathlib import Path

import numpy as np

from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.clips.motion import load_motion
from locomotion.postures.arcs import arc_between, arc_of_motion, pose_of
from locomotion.postures.places import inverse
from locomotion.postures.posture_check import check_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.schema import ArcEntry, KeyEntry, PostureEntry, PostureFile
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
        reader.located.error(
            ["arcs", fault.arc] if fault.arc >= 0 else ["postures", graph.postures[fault.posture]],
            fault.problem,
            at_key=fault.arc < 0,
        )
        for fault in check_postures(graph)
    ]


class _Reader:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.file, self.located = read_yaml(path, PostureFile, "posture file")
        self.names = tuple(self.file.postures)
        self.angles = {name: self._angles(p, ["postures", name]) for name, p in self.file.postures.items()}
        self.poses = np.array(
            [pose_of(self.angles[name], p.pitch, p.roll) for name, p in self.file.postures.items()]
        )

    def graph(self) -> PostureGraph:
        file, fatal = self.file, -1
        if file.fatal is not None:
            fatal = self._posture(file.fatal, ["fatal"])
        start = np.array(
            [self._posture(a.from_, ["arcs", k, "from"]) for k, a in enumerate(file.arcs)], np.int32
        )
        end = np.array([self._posture(a.to, ["arcs", k, "to"]) for k, a in enumerate(file.arcs)], np.int32)
        for k in range(len(file.arcs)):
            if start[k] == end[k]:
                raise self.located.error(["arcs", k, "to"], "an arc leads to another posture")
        forward = [k for k, arc in enumerate(file.arcs) if not arc.backwards]
        made = {k: self._frames(file.arcs[k], k, start[k], end[k]) for k in forward}
        first = dict(zip(forward, np.cumsum([0, *(len(made[k][0]) for k in forward)]), strict=False))
        source = [self._source(k, start, end) for k in range(len(file.arcs))]
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
            backwards=np.array([k != s for k, s in enumerate(source)], np.bool_),
            frames=np.concatenate([np.zeros((0, self.poses.shape[1])), *(made[k][0] for k in forward)]),
            first=np.array([first[s] for s in source], np.int32),
            count=np.array([len(made[s][0]) for s in source], np.int32),
        )

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

    def _posture(self, name: str, at: list[Key]) -> int:
        if name not in self.names:
            hint = nearest(name, self.names)
            problem = f"no posture is called {name!r}; {hint}valid: {', '.join(self.names)}"
            raise self.located.error(at, problem)
        return self.names.index(name)

    def _angles(self, entry: PostureEntry, at: list[Key]) -> dict[str, float]:
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
