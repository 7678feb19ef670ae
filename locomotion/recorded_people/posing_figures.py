"""Poses of many recorded people in one kernel: their gait, style, feet, what they hold, what fades.

A pose is a function of a figure's row and of its body's: nothing is remembered from one call to the next, and
the same rows give the same pose to the bit, for one figure or for many. Figures that play their postures or
clear an obstacle are not posed here (`locomotion.recorded_people.people`).
"""

import math

import numpy as np

from locomotion.body.traits import SIZE
from locomotion.crowd import layout as body
from locomotion.postures.step_order import AT_REST, gait_for
from locomotion.recorded.foot_planting import ROOM, plant
from locomotion.recorded.individual import style
from locomotion.recorded.posing import pose_body
from locomotion.recorded.sampling import read_cycle
from locomotion.recorded.skeletons import FULL, LOW, MEDIUM
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.drawing import draw
from locomotion.recorded_people.fading import STEP, add_fade, fade_of, tell_apart
from locomotion.recorded_people.stepping import (
    AIM,
    cadence_of,
    footing_of,
    gait_played,
    since_strike,
    speed_read,
    stride_of,
)
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["choose_gaits", "draw_figures", "pose_figures"]

_BEFORE_STRIKE = 1.0 - 1e-6
_SOON = 0.3  # [s]
_PLACE, _OFFSETS, _RATES, _STEPS, _TRAITS = (
    part.start for part in (at.PLACE, at.OFFSETS, at.RATES, at.STEPS, at.TRAITS)
)  # kernels know numbers
_JOINTS, _BODIES = 39, 20


@kernel(inline="always")
def _bones(figures, level):
    """As of `posing.pose_body`."""
    return (
        figures.parents[level],
        figures.offsets[level],
        figures.channel_first[level],
        figures.axes[level],
        figures.signs[level],
    )


@kernel
def _sample(figures, level, gait, speed, phase, out):
    """As `sampling.sample_gait`; ``out``: channels (c,) and root (7,)."""
    frames, places = figures.full, figures.full_roots
    if level == MEDIUM:
        frames, places = figures.medium, figures.medium_roots
    elif level == LOW:
        frames, places = figures.low, figures.low_roots
    tables = figures.first[level], figures.count[level], frames, places
    of_gaits = figures.gait_first, figures.cycles, figures.speeds, figures.rests
    read_cycle(tables, of_gaits, gait, speed, phase, out[0], out[1])


@kernel
def _settle_down(place, root):
    """Carry a ``root`` (7,) to a ``place`` (4,), but for its height."""
    c, s = math.cos(place[3]), math.sin(place[3])
    half_c, half_s = math.cos(0.5 * place[3]), math.sin(0.5 * place[3])
    x, y, w, i, j, k = root[0], root[1], root[3], root[4], root[5], root[6]
    root[0], root[1] = place[0] + c * x - s * y, place[1] + s * x + c * y
    root[3], root[4] = half_c * w - half_s * k, half_c * i - half_s * j
    root[5], root[6] = half_c * j + half_s * i, half_c * k + half_s * w


@kernel
def _as_gait_has_it(figures, row, walker, ahead, out, room):
    """The channels (c,) and root (7,) ``out`` of a figure ``ahead`` [s] of now, without what is special to
    it. ``room``: memory for feet (2, 7), footing (2, 5), since (2,), place (4,), footfalls (2, 2, 6), bodies
    and `plant`. One of another size is posed as one of the usual size would be where all is smaller by that.
    """
    feet, footing, since, place, steps, bodies, planting = room
    size = row[_TRAITS + SIZE]
    channels, root = out
    level, moves = int(row[at.LEVEL]), row[at.GAIT] >= 0.0
    gait, speed = gait_played(figures, row), speed_read(row)
    beyond = ahead + row[at.LATE]
    gone = beyond * cadence_of(figures, row, walker) if beyond != 0.0 else 0.0
    for k in range(4):
        place[k] = row[_PLACE + k]
    if ahead != 0.0:
        place[0] += ahead * walker[body.VX]
        place[1] += ahead * walker[body.VY]
    for k in range(3):
        place[k] /= size
    _sample(figures, level, gait, speed, row[at.PHASE] + gone, out)
    style(figures.styles[level], row[_TRAITS:], channels)
    if row[at.LAID] == 0.0:
        _settle_down(place, root)
        root[2] += place[2]
        _enlarge(root, size)
        return
    for k in range(7):
        bodies[0, k] = root[k]
    bones = _bones(figures, level)
    for k in range(figures.leg_count[level]):
        pose_body(bones, figures.legs[level, k], channels, bodies)
    for side in range(2):
        for k in range(7):
            feet[side, k] = bodies[figures.feet[level, side], k]
        # a foot stays in the part of its cycle that it is in: where it stands is known for that
        struck = since_strike(row[at.PHASE], side) + gone
        since[side] = min(max(struck, 0.0), _BEFORE_STRIKE) if moves else 0.0
    footing_of(figures, gait, speed, footing)
    stride = figures.directions[gait] * stride_of(figures, gait, speed)
    _settle_down(place, root)
    cycle = figures.columns[level], footing, stride, since
    _small_steps(row[_STEPS : _STEPS + 36].reshape(2, 3, 6), size, steps)
    plant(cycle, feet, place, steps, out, planting)
    _enlarge(root, size)


@kernel
def _small_steps(steps, size, out):
    """Of ``steps`` as of `layout.STEPS` those that a foot is between, ``out`` (2, 2, 6), as many times as
    small as a figure of a ``size`` is large."""
    for side in range(2):
        for step in range(AIM):
            for k in range(6):
                out[side, step, k] = steps[side, step, k] / size if k < 3 else steps[side, step, k]


@kernel(forceinline=True)
def _enlarge(root, size):
    """Put a root where that of a figure of a ``size`` is."""
    for k in range(3):
        root[k] *= size


@kernel
def _fades(row, dt, ahead):
    """How long ago the fade of a figure has begun [s]; below 0 when it has ended."""
    elapsed = max(row[at.AGE] * dt + ahead - row[at.FADE_BEGUN], 0.0)
    return elapsed if elapsed < row[at.FADE_SECONDS] else -1.0


@kernel
def _pose(figures, row, walker, moment, pose, room):
    """The ``pose`` (46,) of a figure: as its gait has it, its hands, and a change of late. ``moment``: ahead
    of now [s], and length of a tick [s]. Gives whether it is more than the gait has."""
    ahead, dt = moment
    level = int(row[at.LEVEL])
    channels, root = room[0], room[1]
    own = channels[: figures.channels[level]]
    _as_gait_has_it(figures, row, walker, ahead, (own, root), room[2:])
    for k in range(7):
        pose[k] = root[k]
    pose[7:] = 0.0
    for k in range(own.shape[0]):
        pose[7 + figures.joints[level, k]] = own[k]
    node = int(row[at.NODE])
    holds = figures.bases[node] != node
    if holds:
        for k in range(_JOINTS):
            if not math.isnan(figures.held[node, k]):
                pose[7 + k] = figures.held[node, k]
    elapsed = _fades(row, dt, ahead)
    if elapsed >= 0.0:
        add_fade(pose, row[_OFFSETS:], row[_RATES:], row[at.FADE_SECONDS], elapsed)
    return holds or elapsed >= 0.0


@allocating_kernel
def _memory():
    """What `_pose` works in: channels, root, and as of `_as_gait_has_it`."""
    return (
        np.empty(_JOINTS), np.empty(7), np.empty((2, 7)), np.empty((2, 5)), np.empty(2), np.empty(4),
        np.empty((2, 2, 6)), np.empty((_BODIES, 7)), np.empty(ROOM),
    )  # fmt: skip


@kernel
def _is_apart(row):
    return row[at.BUSY] > 0.0 or row[at.CROSSES] == at.CLEARS


@allocating_kernel
def pose_figures(figures, indices, rows, walkers, moment, out, apart):
    """Poses ``out`` (n, 46) of the figures ``indices`` (n,); ``figures`` as of `figure_tables`, ``rows`` as
    of `layout`, ``walkers`` as of `locomotion.crowd.layout`. ``moment``: ahead of now [s], and the length of
    a tick [s]. ``apart`` (n,) bool is written: who may play its postures or clear an obstacle."""
    room = _memory()
    for n in range(indices.shape[0]):
        apart[n] = _is_apart(rows[indices[n]])
        _pose(figures, rows[indices[n]], walkers[indices[n]], moment, out[n], room)


@allocating_kernel
def draw_figures(figures, indices, rows, walkers, moment, out, apart):
    """Places ``out`` (n, 20, 7) of the bodies of figures, the rest as of `pose_figures`."""
    room, pose, bodies = _memory(), np.empty(7 + _JOINTS), np.empty((_BODIES, 7))
    for n in range(indices.shape[0]):
        row = rows[indices[n]]
        apart[n] = _is_apart(row)
        level, channels, root = int(row[at.LEVEL]), room[0], room[1]
        if _pose(figures, row, walkers[indices[n]], moment, pose, room):
            level, channels, root = FULL, pose[7:], pose[:7]
        carriers = figures.carrier[level], figures.carried[level]
        draw(_bones(figures, level), figures.bodies[level], carriers, channels, root, bodies, out[n])
        size = row[_TRAITS + SIZE]
        for place in range(out.shape[1]):
            for k in range(3):
                out[n, place, k] = root[k] + size * (out[n, place, k] - root[k])


@kernel
def _speed_soon(row, walker):
    """[m/s] of a figure that gets faster, in the middle of its next step: a runner's first steps are those of
    a run, and so are those of a run-up. Of others now."""
    speed, wish = row[at.SPEED], walker[body.WISH]
    if row[at.CROSSES] == at.RUNS_UP:
        wish = math.inf
    if speed <= AT_REST or wish <= speed:
        return speed
    return min(speed + _SOON * walker[body.ACCELERATION], wish)


@allocating_kernel
def choose_gaits(figures, rows, walkers, phases, dt):
    """At the end of a step, and at rest, each figure may change its gait; the difference fades out.
    ``phases`` (n,): before the tick."""
    room = _memory()
    poses, apart = np.empty((2, 7 + _JOINTS)), np.empty((3, 6 + _JOINTS))
    for n in range(rows.shape[0]):
        row, walker = rows[n], walkers[n]
        if row[at.LATE] > 0.0:
            continue
        now, chosen = int(row[at.GAIT]), -1
        if row[at.CROSSES] != at.CLEARS:  # who plays a posture has no speed
            chosen = gait_for(figures.gaits, now, figures.bases[int(row[at.NODE])], _speed_soon(row, walker))
        steps = int(2.0 * row[at.PHASE]) != int(2.0 * phases[n])
        if chosen == now or not (steps or now < 0 or chosen < 0):
            continue
        _pose(figures, row, walker, (-STEP, dt), poses[0], room)
        _pose(figures, row, walker, (0.0, dt), poses[1], room)
        tell_apart(poses[1], poses[0], apart[1])
        row[at.GAIT], row[at.FADE_SECONDS] = chosen, 0.0
        _pose(figures, row, walker, (0.0, dt), poses[0], room)
        tell_apart(poses[1], poses[0], apart[0])
        _pose(figures, row, walker, (STEP, dt), poses[1], room)
        tell_apart(poses[1], poses[0], apart[2])
        for k in range(6 + _JOINTS):
            row[_OFFSETS + k] = apart[0, k]
            row[_RATES + k] = (apart[1, k] - apart[2, k]) / STEP
        row[at.FADE_SECONDS], row[at.FADE_BEGUN] = fade_of(apart[0]), row[at.AGE] * dt
