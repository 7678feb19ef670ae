"""What kernels know of the motions, skeletons and postures of recorded people, in one bundle."""

from functools import cache
from typing import Any

import numpy as np
from numba import float64, int64
from numpy.typing import NDArray

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import Gait, gait_table
from locomotion.recorded.foot_planting import leg_columns, strides_ahead
from locomotion.recorded.footfalls import FEET, footing
from locomotion.recorded.individual import styles_of
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.skeletons import LEVELS, Skeleton, skeleton
from surefoot.kernels.bundles import Bundle, BundleType

__all__ = ["FIGURES", "bodies_drawn", "figure_tables"]

FIGURES = BundleType(
    gait_first=int64[::1],
    cycles=int64[::1],
    speeds=float64[::1],
    seconds=float64[::1],
    rests=int64[::1],
    footing=float64[:, :, ::1],
    directions=float64[::1],
    first=int64[:, ::1],
    count=int64[:, ::1],
    full=float64[:, ::1],
    full_roots=float64[:, ::1],
    medium=float64[:, ::1],
    medium_roots=float64[:, ::1],
    low=float64[:, ::1],
    low_roots=float64[:, ::1],
    bodies=int64[::1],
    channels=int64[::1],
    parents=int64[:, ::1],
    offsets=float64[:, :, ::1],
    channel_first=int64[:, ::1],
    axes=int64[:, ::1],
    signs=float64[:, ::1],
    joints=int64[:, ::1],
    styles=int64[:, ::1],
    leg_count=int64[::1],
    legs=int64[:, ::1],
    feet=int64[:, ::1],
    columns=int64[:, :, ::1],
    carrier=int64[:, ::1],
    carried=float64[:, :, ::1],
    gaits=float64[:, ::1],
    recorded=int64[::1],
    bases=int64[::1],
    standing=int64[::1],
    held=float64[:, ::1],
)
"""Of `MotionSet`: gait_first, cycles, speeds, seconds, rests; `footfalls.footing`; ``directions`` (gaits,)
as of `foot_planting.strides_ahead`. Of each of its `LEVELS`: first, count (3, clips); channels and roots.

Of each level's `Skeleton`, filled up with zeros: how many ``bodies`` and ``channels``; parents, offsets,
channel_first (its `first`), axes, signs, joints; ``styles`` as of `individual.styles_of`; the bodies of the
legs in order, how many, and which of them are the feet; ``columns`` as of `foot_planting.leg_columns`;
carrier and carried, in the order of the person's model.

Of the posture graph: ``gaits`` as of `step_order.gait_table`, ``recorded`` the number in the motions of each;
of each posture the one with free hands (``bases``), the gait that comes to rest in it (``standing``), and the
joints of what is ``held`` in it (p, 39) [rad], nan where they are free.
"""


def figure_tables(motions: MotionSet, graph: PostureGraph, gaits: tuple[Gait, ...]) -> Any:
    """`FIGURES` of people with the postures of ``graph``, of whose gaits there is motion for ``gaits``."""
    recorded = np.array([motions.gait(gait.name) for gait in gaits], np.int64)
    names = graph.postures
    bases = np.array([names.index(name.partition("/")[0]) for name in names], np.int64)
    rests = [next((k for k, gait in enumerate(gaits) if gait.posture == base), 0) for base in bases]
    held = np.where(np.abs(graph.poses - graph.poses[bases])[:, 7:] > 1e-9, graph.poses[:, 7:], np.nan)
    frames = {}
    for name, level in zip(LEVELS, motions.levels, strict=True):
        frames[name] = np.ascontiguousarray(level.channels)
        frames[f"{name}_roots"] = np.ascontiguousarray(level.roots)
    return Bundle(
        FIGURES,
        gait_first=motions.gait_first, cycles=motions.cycles, speeds=motions.speeds, seconds=motions.seconds,
        rests=motions.rests, footing=footing(motions), directions=strides_ahead(motions),
        first=np.array([level.first for level in motions.levels]),
        count=np.array([level.count for level in motions.levels]),
        gaits=gait_table(gaits), recorded=recorded, bases=bases, standing=recorded[rests], held=held,
        **frames, **_skeletons(),
    )  # fmt: skip


@cache
def _skeletons() -> dict[str, NDArray]:
    """What depends on the skeletons alone."""
    own = [skeleton(name) for name in LEVELS]
    legs = [_legs(bones) for bones in own]
    carriers = [bodies_drawn(bones) for bones in own]
    return {
        "bodies": np.array([len(bones.bodies) for bones in own], np.int64),
        "channels": np.array([len(bones.channels) for bones in own], np.int64),
        "parents": _filled([bones.parents for bones in own]),
        "offsets": _filled([bones.offsets for bones in own]),
        "channel_first": _filled([bones.first for bones in own]),
        "axes": _filled([bones.axes for bones in own]),
        "signs": _filled([bones.signs for bones in own]),
        "joints": _filled([bones.joints for bones in own]),
        "styles": _filled([styles_of(bones) for bones in own]),
        "leg_count": np.array([len(each) for each in legs], np.int64),
        "legs": _filled(legs),
        "feet": np.array([[bones.bodies.index(name) for name in FEET] for bones in own], np.int64),
        "columns": np.array([leg_columns(bones) for bones in own]),
        "carrier": np.array([carrier for carrier, _ in carriers]),
        "carried": np.array([carried for _, carried in carriers]),
    }


def _filled(rows: list[NDArray]) -> NDArray:
    """``rows`` one under the other, with zeros behind those that are shorter."""
    longest = max(map(len, rows))
    return np.array([np.pad(row, [(0, longest - len(row)), *[(0, 0)] * (row.ndim - 1)]) for row in rows])


def _legs(bones: Skeleton) -> NDArray[np.int64]:
    """Numbers of the bodies between the pelvis and the feet, and of the feet, in order."""
    found = set()
    for name in FEET:
        body = bones.bodies.index(name)
        while body > 0:
            found.add(body)
            body = int(bones.parents[body])
    return np.array(sorted(found), np.int64)


def bodies_drawn(bones: Skeleton) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The carrier (20,) of each body of the person's model, in its order, and where it is carried (20, 3)."""
    order = np.argsort([figure().body(name).id for name in BODY_NAMES])
    return bones.carrier[order], bones.carried[order]
