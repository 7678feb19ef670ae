"""How people of other simulators are posed: from how fast they are drawn to move, and the posture they told.

Who is upright walks and runs by recorded cycles, at the phase that the way gone gives. Kneeling, crouching,
sitting, lying and dying are played by the posture graph. Who crawls goes on all fours. One goes over into the
other within a third of a second.
"""

from functools import cache
from typing import Any

import numpy as np

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.data import POSTURES
from locomotion.errors import LocomotionError
from locomotion.postures.playback import Playback, asked_for, at_rest, pose_at, settled
from locomotion.postures.posture_file import load_postures
from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.motion_set import MotionSet, load_motions
from locomotion.recorded.posing import posed, whole_figures
from locomotion.recorded.sampling import mixed, placed_roots, sample_gait, stride_of
from locomotion.recorded.skeletons import FULL, Skeleton, skeleton
from locomotion.saved_arrays import check_array
from runtime.bodies.figure import Figure
from runtime.dis.smoothing import advanced
from runtime.errors import RuntimeInputError

__all__ = [
    "CRAWL_STRIDE",
    "STANDS",
    "advance_poses",
    "asked",
    "check",
    "figures_at",
    "posture_name",
    "posture_number",
    "wanted_postures",
]

STANDS = "stand"
_DEAD, _ALL_FOURS, _PRONE = "dead", "all-fours", "prone"
_GOES_OVER, _SPEEDS_UP = 9.0, 14.0
"""[1/s] rates of the critically damped springs by which one motion goes over into another, and by which legs
follow the speed: corrections must not make a joint jump either."""
_FAINT = 1e-4  # share of a motion below which it is left out
_MOVES, _STOPS = 0.25, 0.12  # [m/s] from which legs move, and below which they stop
_WALKS_TO = 2.25  # [m/s] up to which somebody walks who told neither
CRAWL_STRIDE = 0.7
"""[m] in one round of hands and knees."""
_CRAWL = {
    "right_hip_flexion": 18.0, "left_hip_flexion": -18.0, "right_shoulder_flexion": -16.0,
    "left_shoulder_flexion": 16.0, "waist_yaw": 4.0, "right_knee_flexion": 8.0, "left_knee_flexion": -8.0,
}  # fmt: skip
"""[°] by which crawling swings the joints of one on all fours; knees and hands diagonally, as people
crawl."""


@cache
def _graph() -> PostureGraph:
    return load_postures(POSTURES / "person.yaml")


@cache
def _library() -> tuple[MotionSet, Skeleton, int, int, np.ndarray]:
    """Motions, the skeleton, the gaits of walk and run, and the swing of a crawl (c,) [rad]."""
    motions, full = load_motions(), skeleton("full")
    swing = np.array([np.radians(_CRAWL.get(name, 0.0)) for name in full.channels])
    return motions, full, motions.gait("walk"), motions.gait("run"), swing


@cache
def _drawn_order() -> list[int]:
    """Of the bodies that are drawn, the number of each in `BODY_NAMES`."""
    return [BODY_NAMES.index(name) for name in Figure.from_model(figure()).bodies]


def resting() -> Playback:
    """Somebody that stands."""
    return at_rest(_graph(), STANDS, (0.0, 0.0, 0.0))


def posture_number(posture: str) -> int:
    """Of a posture of the graph; raises `RuntimeInputError` for one that is not there."""
    postures = _graph().postures
    if posture not in postures:
        raise RuntimeInputError(f"posture {posture!r}: valid: {', '.join(postures)}")
    return postures.index(posture)


def posture_name(number: float) -> str:
    """The opposite of `posture_number`."""
    return _graph().postures[int(number)]


def wanted_postures(rows: np.ndarray) -> np.ndarray:
    """(n,) numbers of the postures for people: the one that they told, on all fours while they crawl, upright
    while they go."""
    stand, dead, fours, prone = map(posture_number, (STANDS, _DEAD, _ALL_FOURS, _PRONE))
    moves, crawls, told = rows["moves"] > 0.0, rows["crawling"] > 0.0, rows["posture"]
    moving = np.where(crawls | (told == prone), fours, stand)
    alive = np.where(moves, moving, np.where(crawls, fours, told))
    return np.where(rows["fatal"] > 0.0, dead, alive)


def asked(playback: Playback, number: float, now: float) -> Playback:
    """``playback`` on its way to a posture; who cannot get there, such as a dead one, is there at once."""
    graph = _graph()
    posture = graph.postures[int(number)]
    try:
        return settled(graph, asked_for(graph, playback, posture, now), now)
    except LocomotionError:
        return at_rest(graph, posture, (0.0, 0.0, 0.0))


def advance_poses(rows: np.ndarray, seconds: float) -> None:
    """Advance ``pace``, ``phase`` and the shares of all motions of ``rows`` (n,), people as in
    `runtime.bodies.remote_figures.REMOTE`; ``asked``, ``rests`` and ``at`` tell of their postures."""
    motions, _, walk, run, _ = _library()
    heading, moving = rows["heading"], rows["moving"]
    along = moving[:, 0] * np.cos(heading) + moving[:, 1] * np.sin(heading)
    across = np.hypot(moving[:, 0], moving[:, 1])
    along = np.where(along < -0.5 * across, -across, across)
    _approach(rows, "pace", along, _SPEEDS_UP, seconds)
    pace, runs = np.abs(rows["pace"]), rows["runs"].clip(0.0, 1.0)
    stride = (1.0 - runs) * stride_of(motions, np.full(len(rows), walk), pace)
    stride += runs * stride_of(motions, np.full(len(rows), run), pace)
    stand, fours = posture_number(STANDS), posture_number(_ALL_FOURS)
    on_fours = rows["asked"] == fours
    stride = np.where(on_fours, CRAWL_STRIDE, stride)
    stride = np.where(rows["stride"] > 0.0, rows["stride"], stride)
    rows["phase"] = (rows["phase"] + rows["pace"] * seconds / stride) % 1.0
    moves, rests = pace > _STOPS, rows["rests"] > 0.0
    up = rests & (rows["at"] == stand)
    by_graph = (rows["asked"] != stand) | ~(up | moves)
    crawls = on_fours & moves & rests & (rows["at"] == fours)
    for share, target in (("by_graph", by_graph), ("crawls", crawls), ("runs", rows["told_run"])):
        _approach(rows, share, target.astype(np.float64), _GOES_OVER, seconds)


def _approach(rows: np.ndarray, name: str, target: np.ndarray, rate: float, seconds: float) -> None:
    """Let a column go towards its ``target`` (n,) like a critically damped spring."""
    speed = f"{name}_speed"
    off, rows[speed] = advanced(rows[name] - target, rows[speed], np.full(len(rows), rate), seconds)
    rows[name] = target + off


def moves_now(rows: np.ndarray, moved: np.ndarray) -> np.ndarray:
    """(n,) bool: whose legs move; ``moved``: whose did before."""
    return np.abs(rows["pace"]) > np.where(moved, _STOPS, _MOVES)


def runs_now(rows: np.ndarray, told: np.ndarray) -> np.ndarray:
    """(n,) bool: who runs. ``told`` (n,): 1 runs, -1 walks, 0 neither."""
    return np.where(told == 0.0, np.abs(rows["pace"]) > _WALKS_TO, told > 0.0)


def figures_at(rows: np.ndarray, playbacks: list[Playback]) -> np.ndarray:
    """(n, 20, 7): where the bodies of people are, position [m] and quaternion (w, x, y, z), in the order of
    their figure."""
    motions, full, walk, run, swing = _library()
    count, pace = len(rows), np.abs(rows["pace"])
    phase = rows["phase"]
    sample: Any = sample_gait(motions, FULL, np.full(count, walk), pace, phase)
    runs, played = rows["runs"].clip(0.0, 1.0), rows["by_graph"].clip(0.0, 1.0)
    if (runs > _FAINT).any():
        sample = mixed(sample, sample_gait(motions, FULL, np.full(count, run), pace, phase), runs)
    by_graph = np.flatnonzero(played > _FAINT)
    if len(by_graph):
        poses = np.array([pose_at(_graph(), playbacks[k], rows["time"][k]) for k in by_graph])
        lying = poses[:, 7 + full.joints]
        lying += (rows["crawls"][by_graph].clip(0.0, 1.0) * np.sin(2.0 * np.pi * phase[by_graph]))[
            :, None
        ] * swing
        channels, roots = sample[0].copy(), sample[1].copy()
        channels[by_graph], roots[by_graph] = lying, poses[:, :7]
        sample = mixed(sample, (channels, roots), played)
    places = np.column_stack([rows["place"], rows["heading"]])
    return whole_figures(full, posed(full, sample[0], placed_roots(sample[1], places)))[:, _drawn_order()]


def check(posture: float, asked_for: float, playback: Playback | None) -> None:
    """Raises `RuntimeInputError` for what no figure can do."""
    graph = _graph()
    postures, arcs = range(len(graph.postures)), range(-1, len(graph.seconds))
    if not (posture in postures and asked_for in postures):
        raise RuntimeInputError("a remote figure is in a posture that is not there")
    if playback is None:
        return
    if not (playback.posture in postures and playback.target in postures and playback.arc in arcs):
        raise RuntimeInputError("a remote figure is in a posture that is not there")
    check_array("the place of a remote figure", playback.place, 3)
    if playback.last is not None:
        check_array("the last pose of a remote figure", playback.last, len(graph.poses[0]))
