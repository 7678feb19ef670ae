"""Recorded motion at a time: joint angles and the root of many figures at once.

Nothing is remembered from one call to the next, and no frames are counted: the same time gives the same pose
to the bit, at any frame rate. All figures of a call are of one level::

    motions = load_motions()
    channels, roots = sample_clips(motions, LOW, clips, seconds)         # each (n,)
    channels, roots = sample_gait(motions, LOW, gaits, speeds, phases)   # each (n,)
    roots = placed_roots(roots, places)                                  # into the world
    places = posed(skeleton("low"), channels, roots)

Between frames values follow Catmull-Rom splines, so that the motion has no corners at any rate.

A gait is a row of cycles at growing speeds. At a speed between two of them, both are read at the same phase
and blended. Phase grows by 1 with each cycle, from the right heel's strike: over a distance ds by ``ds /
stride``, see `stride_of`. Slower than the slowest cycle, strides shrink with the square root of the speed, as
those of people do, and the pose goes over into the one at rest.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.recorded.motion_set import LevelFrames, MotionSet
from surefoot.kernels import kernel

__all__ = [
    "cycles_around", "mixed", "placed_roots", "read_clips", "read_cycle", "read_gait", "sample_clips",
    "sample_clips_slowly", "sample_gait", "sample_gait_slowly", "stride_at", "stride_of",
]  # fmt: skip

Sample = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Channels (n, c) float64 [rad] and roots (n, 7) float64 of n figures."""


def sample_clips(motions: MotionSet, level: int, clips: ArrayLike, seconds: ArrayLike) -> Sample:
    """Figures that have played ``clips`` (n,) for ``seconds`` (n,): their channels (n, c), and their roots
    (n, 7) from where the clip began. Cycles go on and on; other clips stay at their last frame, and, before
    0, at their first."""
    frames = motions.levels[level]
    numbers, times = np.asarray(clips, np.int64), np.asarray(seconds, np.float64)
    channels, roots = np.empty((len(times), frames.channels.shape[1])), np.empty((len(times), 7))
    read_clips(
        _tables(frames), motions.cyclic, motions.seconds, motions.travel, numbers, times, channels, roots
    )
    return channels, roots


def sample_gait(
    motions: MotionSet, level: int, gaits: ArrayLike, speeds: ArrayLike, phases: ArrayLike
) -> Sample:
    """Figures that go in ``gaits`` (n,) at ``speeds`` (n,) [m/s, or rad/s of a turn] and are at ``phases``
    (n,) of the cycle: their channels (n, c), and their roots (n, 7) as seen from the point of the ground on
    which they go along evenly, facing ahead."""
    frames = motions.levels[level]
    numbers = np.ascontiguousarray(gaits, np.int64)
    fast, shares = (np.ascontiguousarray(each, np.float64) for each in (speeds, phases))
    channels, roots = np.empty((len(fast), frames.channels.shape[1])), np.empty((len(fast), 7))
    gait_tables = (motions.gait_first, motions.cycles, motions.speeds, motions.rests)
    read_gait(_tables(frames), *gait_tables, numbers, fast, shares, (channels, roots))
    return channels, roots


def stride_of(motions: MotionSet, gaits: ArrayLike, speeds: ArrayLike) -> NDArray[np.float64]:
    """Travel in one cycle (n,) float64 [m, or rad of a turn], more than 0, of figures that go in ``gaits``
    (n,) at ``speeds`` (n,). Phase grows by ``speed / stride`` a second."""
    numbers, fast = np.asarray(gaits, np.int64), np.asarray(speeds, np.float64)
    out = np.empty(len(fast))
    _strides(motions.gait_first, motions.cycles, motions.speeds, motions.seconds, numbers, fast, out)
    return out


def placed_roots(roots: NDArray[np.float64], places: ArrayLike) -> NDArray[np.float64]:
    """``roots`` (n, 7) carried to ``places`` (n, 4): x, y, z of the ground [m] and heading [rad]."""
    at = np.asarray(places, np.float64)
    c, s = np.cos(at[:, 3]), np.sin(at[:, 3])
    half_c, half_s = np.cos(0.5 * at[:, 3]), np.sin(0.5 * at[:, 3])
    x, y = roots[:, 0], roots[:, 1]
    w, i, j, k = roots[:, 3], roots[:, 4], roots[:, 5], roots[:, 6]
    columns = (
        at[:, 0] + c * x - s * y, at[:, 1] + s * x + c * y, at[:, 2] + roots[:, 2],
        half_c * w - half_s * k, half_c * i - half_s * j, half_c * j + half_s * i, half_c * k + half_s * w,
    )  # fmt: skip
    return np.stack(columns, axis=1)


def mixed(before: Sample, after: Sample, shares: ArrayLike) -> Sample:
    """Between two samples of the same figures; ``shares`` (n,) of the second, 0 to 1. For going over from one
    motion to another."""
    share = np.asarray(shares, np.float64)[:, None]
    channels = (1.0 - share) * before[0] + share * after[0]
    sign = np.where((before[1][:, 3:] * after[1][:, 3:]).sum(axis=1, keepdims=True) < 0.0, -1.0, 1.0)
    roots = (1.0 - share) * before[1]
    roots[:, :3] += share * after[1][:, :3]
    roots[:, 3:] += share * sign * after[1][:, 3:]
    roots[:, 3:] /= np.linalg.norm(roots[:, 3:], axis=1, keepdims=True)
    return channels, roots


# --- the same, slowly


def sample_clips_slowly(motions: MotionSet, level: int, clips: ArrayLike, seconds: ArrayLike) -> Sample:
    """The same as `sample_clips`, figure by figure."""
    numbers, times = np.asarray(clips), np.asarray(seconds, np.float64)
    shares = times / motions.seconds[numbers]
    shares = np.where(motions.cyclic[numbers], shares, shares.clip(0.0, 1.0))
    rows = [
        _read_slowly(motions, level, int(clip), share) for clip, share in zip(numbers, shares, strict=True)
    ]
    channels, roots = _sample(np.array(rows))
    gone = np.where(motions.cyclic[numbers, None], motions.travel[numbers] * shares[:, None], 0.0)
    return channels, placed_roots(roots, np.insert(gone, 2, 0.0, axis=1))


def sample_gait_slowly(
    motions: MotionSet, level: int, gaits: ArrayLike, speeds: ArrayLike, phases: ArrayLike
) -> Sample:
    """The same as `sample_gait`, figure by figure."""
    rows = []
    for gait, speed, phase in zip(np.asarray(gaits), np.asarray(speeds), np.asarray(phases), strict=True):
        cycles = motions.cycles[motions.gait_first[gait] : motions.gait_first[gait + 1]]
        known = motions.speeds[cycles]
        if speed >= known[0]:
            row = [_read_slowly(motions, level, int(clip), phase) for clip in cycles]
            rows.append([np.interp(speed, known, column) for column in np.transpose(row)])
            continue
        row, rest = _read_slowly(motions, level, int(cycles[0]), phase), int(motions.rests[gait])
        share = np.sqrt(max(speed, 0.0) / known[0]) if rest >= 0 else 1.0
        rows.append(
            share * row + (1.0 - share) * (_read_slowly(motions, level, rest, 0.0) if rest >= 0 else 0.0)
        )
    return _sample(np.array(rows))


def _read_slowly(motions: MotionSet, level: int, clip: int, share: float) -> NDArray[np.float64]:
    """Channels and root (c + 7,) of a clip at a share of it; the rotation is not of unit length."""
    frames = motions.levels[level]
    first, count = int(frames.first[clip]), int(frames.count[clip])
    rows = np.hstack([frames.channels, frames.roots])[first : first + count]
    if motions.cyclic[clip]:
        at = (share - np.floor(share)) * count
        low = min(int(at), count - 1)
        four = rows[np.arange(low - 1, low + 3) % count]
    elif count == 1:
        at, low, four = 0.0, 0, np.repeat(rows, 4, axis=0)
    else:
        at = share * (count - 1)
        low = min(int(at), count - 2)
        four = np.vstack([2 * rows[0] - rows[1], rows, 2 * rows[-1] - rows[-2]])[low : low + 4]
    t = at - low
    powers = [-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2]
    return 0.5 * np.array(powers) @ four


def _sample(rows: NDArray[np.float64]) -> Sample:
    channels, roots = rows[:, :-7], rows[:, -7:].copy()
    roots[:, 3:] /= np.linalg.norm(roots[:, 3:], axis=1, keepdims=True)
    return channels, roots


# --- kernels


def _tables(frames: LevelFrames) -> tuple[np.ndarray, ...]:
    return frames.first, frames.count, frames.channels, frames.roots


@kernel
def _taps(count, cyclic, share):
    """The four frames around a share of a clip, and how far it is from the second to the third."""
    if cyclic:
        at = (share - math.floor(share)) * count
        low = min(int(at), count - 1)
        before = low - 1 if low > 0 else count - 1
        after = low + 1 if low + 1 < count else 0
        last = after + 1 if after + 1 < count else 0
    else:
        at = min(max(share, 0.0), 1.0) * (count - 1)
        low = min(int(at), max(count - 2, 0))
        before, after, last = low - 1, min(low + 1, count - 1), low + 2
    return before, low, after, last, at - low


@kernel
def _add(rows, first, count, taps, weight, out):
    """Add ``weight`` times the spline through rows of a clip to ``out``."""
    before, low, after, last, t = taps
    a = 0.5 * weight * t * (-1.0 + t * (2.0 - t))
    b = 0.5 * weight * (2.0 + t * t * (3.0 * t - 5.0))
    c = 0.5 * weight * t * (1.0 + t * (4.0 - 3.0 * t))
    d = 0.5 * weight * t * t * (t - 1.0)
    if before < 0:  # a frame before the first, in line with the first two
        b, c = b + 2.0 * a, c - a
        a, before = 0.0, low
    if last >= count:
        c, b = c + 2.0 * d, b - d
        d, last = 0.0, after
    i, j, k, m = first + before, first + low, first + after, first + last
    for n in range(out.shape[0]):
        out[n] += a * rows[i, n] + b * rows[j, n] + c * rows[k, n] + d * rows[m, n]


@kernel
def _unit(root):
    """Make the rotation of a root (7,) a unit quaternion."""
    scale = 1.0 / math.sqrt(root[3] * root[3] + root[4] * root[4] + root[5] * root[5] + root[6] * root[6])
    for k in range(3, 7):
        root[k] *= scale


@kernel
def read_clips(tables, cyclic, seconds, travel, clips, times, channels, roots):
    """Kernel of `sample_clips`."""
    first, count, frames, places = tables
    channels[:] = 0.0
    roots[:] = 0.0
    for n in range(clips.shape[0]):
        clip = clips[n]
        share = times[n] / seconds[clip]
        taps = _taps(count[clip], cyclic[clip], share)
        _add(frames, first[clip], count[clip], taps, 1.0, channels[n])
        root = roots[n]
        _add(places, first[clip], count[clip], taps, 1.0, root)
        _unit(root)
        if cyclic[clip]:
            turn = share * travel[clip, 2]
            c, s = math.cos(turn), math.sin(turn)
            half_c, half_s = math.cos(0.5 * turn), math.sin(0.5 * turn)
            x, y = root[0], root[1]
            root[0], root[1] = (
                share * travel[clip, 0] + c * x - s * y,
                share * travel[clip, 1] + s * x + c * y,
            )
            w, i, j, k = root[3], root[4], root[5], root[6]
            root[3], root[4] = half_c * w - half_s * k, half_c * i - half_s * j
            root[5], root[6] = half_c * j + half_s * i, half_c * k + half_s * w


@kernel
def cycles_around(gait_first, cycles, speeds, gait, speed):
    """The cycles of a gait at or below a speed, and above it, and the share of the second; the first is -1
    below the slowest: there the share is that of its stride."""
    low, end = gait_first[gait], gait_first[gait + 1]
    slowest = speeds[cycles[low]]
    if speed < slowest:
        return -1, cycles[low], math.sqrt(max(speed, 0.0) / slowest)
    while low < end - 2 and speed >= speeds[cycles[low + 1]]:
        low += 1
    if low == end - 1:
        return cycles[low], cycles[low], 0.0
    width = speeds[cycles[low + 1]] - speeds[cycles[low]]
    return cycles[low], cycles[low + 1], min((speed - speeds[cycles[low]]) / width, 1.0)


@kernel
def read_gait(tables, gait_first, cycles, known, rests, gaits, speeds, phases, out):
    """Kernel of `sample_gait`."""
    channels, roots = out
    of_gaits = gait_first, cycles, known, rests
    for n in range(gaits.shape[0]):
        read_cycle(tables, of_gaits, gaits[n], speeds[n], phases[n], channels[n], roots[n])


@kernel
def read_cycle(tables, of_gaits, gait, speed, phase, channels, root):
    """Kernel of `sample_gait`, for one figure."""
    first, count, frames, places = tables
    gait_first, cycles, known, rests = of_gaits
    channels[:] = 0.0
    root[:] = 0.0
    slower, faster, share = cycles_around(gait_first, cycles, known, gait, speed)
    moves = slower >= 0
    if not moves:
        slower = rests[gait]
        if slower < 0:
            share = 1.0
    if share < 1.0:
        taps = _taps(count[slower], moves, phase)
        _add(frames, first[slower], count[slower], taps, 1.0 - share, channels)
        _add(places, first[slower], count[slower], taps, 1.0 - share, root)
    if share > 0.0:
        taps = _taps(count[faster], True, phase)
        _add(frames, first[faster], count[faster], taps, share, channels)
        _add(places, first[faster], count[faster], taps, share, root)
    _unit(root)


@kernel
def stride_at(gait_first, cycles, speeds, seconds, gait, speed):
    """Kernel of `stride_of`, for one figure."""
    slower, faster, share = cycles_around(gait_first, cycles, speeds, gait, speed)
    stride = speeds[faster] * seconds[faster]
    if slower < 0:
        return stride * max(share, 1e-3)
    return (1.0 - share) * speeds[slower] * seconds[slower] + share * stride


@kernel
def _strides(gait_first, cycles, speeds, seconds, gaits, fast, out):
    """Kernel of `stride_of`."""
    for n in range(gaits.shape[0]):
        out[n] = stride_at(gait_first, cycles, speeds, seconds, gaits[n], fast[n])
