"""Where the feet of recorded people stand, and how they go from there to where they are put down next.

A foot that bears stays where it was put down. For one that swings, a place is looked for ahead, where the
figure will have come to at its velocity: on the walkable surface, at the height and slope of the real ground,
with the whole sole on one stair. It may change until the foot is most of the way there. One that stands with
its feet elsewhere than under it takes steps on the spot.

All of it goes by ticks, and not by how often somebody looks, so that a figure's feet are the same at any
frame rate. In full detail steps go on in every tick; in less detail, which is drawn less often, when it is
the body's turn, for all the time since the last: a third of these figures in each tick. Figures whose posture
has no such gait have no feet laid: they kneel, lie or crawl.
"""

import math

import numpy as np

from locomotion.body.traits import PACE, PHASE, SIZE, WIDTH
from locomotion.crowd import layout as body
from locomotion.ground.collider.layout import NX, NZ
from locomotion.ground.ground import height_below
from locomotion.postures.step_order import AT_REST
from locomotion.recorded.footfalls import AHEAD, BEARS, HALF_SOLE, LEFT, TURNED, read_footing
from locomotion.recorded.sampling import stride_at
from locomotion.recorded.skeletons import FULL, LOW
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.between_ticks import go_on, turn
from navmesh.surface.clearance_field import floor_at, walk
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "AIM", "LAST", "NEXT", "advance_figures", "cadence_of", "footing_of", "gait_played", "lay_feet",
    "since_strike", "speed_read", "stride_of"
]  # fmt: skip

_SLUGGISH = 0.12  # [s] time constant of the speed at which they are drawn
_SETTLES = 0.2  # [m/s] whose steps one takes on the spot
_BRISK = 0.9  # cycles a second of that
_ASTRAY, _ASKEW = 0.1, 0.35  # [m], [rad] by which a foot may stand elsewhere than in the posture at rest
_DECIDED = 0.6  # share of a swing after which a foot goes where it was going to
_ADJUSTS = 0.03  # [s] time constant with which it does
_FORESEEN = 1.5  # [s] at most
_BEND = 0.6  # [rad] by which a figure turns until then at most
_ROOM = 0.08  # [m] kept from where walking ends
_EVEN = 0.3  # [m] between the surface and the ground under it
_RISER = 0.08  # [m] of height within half a sole: the edge of a stair
_STEEPEST = 0.7  # [rad] of slope that a sole follows
_LEG = 0.8  # [m] from where legs are spread
_WIDER, _HIGH = 0.05, 0.2
# [m] to the side by which low figures step that much or more up or down: hips that do not turn would turn
# the foot of a bent leg that stands far inside
_PLACE, _BEFORE, _TRAITS, _STEPS = (
    part.start for part in (at.PLACE, at.BEFORE, at.TRAITS, at.STEPS)
)  # kernels know numbers
LAST, NEXT, AIM = 0, 1, 2
"""Of a foot in `layout.STEPS`: where it stands or stood last, where it is on its way to, and where that is to
be in the end."""


@kernel
def since_strike(phase, side):
    """Share of the cycle, 0 to 1, since the foot of a ``side`` struck: the right one (0) does at the phase 0,
    the left one (1) at 0.5."""
    since = phase - 0.5 * side
    return since - math.floor(since)


@kernel
def speed_read(row):
    """The speed at which a figure's gait is read, at rest 0: as of `individual.pace_of`."""
    if row[at.GAIT] < 0.0:
        return 0.0
    return abs(row[at.SPEED]) * row[_TRAITS + PACE] / math.sqrt(row[_TRAITS + SIZE])


@kernel
def footing_of(figures, gait, speed, out):
    """As `footfalls.read_footing`."""
    tables = figures.gait_first, figures.cycles, figures.speeds, figures.rests, figures.footing
    read_footing(tables, gait, speed, out)


@kernel
def stride_of(figures, gait, speed):
    """[m] of a figure of the usual size that goes at a ``speed`` [m/s], as that is read."""
    return stride_at(figures.gait_first, figures.cycles, figures.speeds, figures.seconds, gait, speed)


@kernel
def gait_played(figures, row):
    """The number, in the motions, of the gait that is sampled of a figure."""
    gait = int(row[at.GAIT])
    return figures.recorded[gait] if gait >= 0 else figures.standing[int(row[at.NODE])]


@kernel
def cadence_of(figures, row, walker):
    """Cycles a second of a figure."""
    if row[at.GAIT] < 0.0 or row[at.STILL] > 0.0:
        return 0.0
    pace, stride = abs(row[at.SPEED]), stride_of(figures, gait_played(figures, row), speed_read(row))
    cadence = row[at.HASTE] * pace / (stride * row[_TRAITS + SIZE])
    rests = math.hypot(walker[body.VX], walker[body.VY]) < AT_REST
    return max(cadence, _BRISK) if rests and row[at.LAID] > 0.0 else cadence


@kernel
def _phase_at_rest(figures, row, footing):
    """The phase with which one on its feet sets out: both bear, and one is soon taken up. Which one, and how
    soon, differs from figure to figure. ``footing`` (2, 5) is overwritten."""
    footing_of(figures, gait_played(figures, row), 0.0, footing)
    own = 2.0 * row[_TRAITS + PHASE]
    side, less = math.floor(own), 0.5 * (own % 1.0)
    both = max(footing[0, BEARS] - 0.5, 0.0)
    return (0.5 * side + (1.0 - less) * both) % 1.0


@kernel
def _height(lookup, x, y, floor):
    """Height of the ground near a floor of the surface, and the row of its triangle or -1."""
    rows, cell_start, cell_triangles, grid, shape, origin = lookup
    z, which = height_below(
        rows, cell_start, cell_triangles, grid, shape, x - origin[0], y - origin[1], floor + _EVEN - origin[2]
    )
    z += origin[2]
    return (z, which) if which >= 0 and z > floor - _EVEN else (floor, -1)


@kernel
def _foothold(place, walker, x, y, heading, out):
    """Put a sole down near (x, y) [m, world], facing ``heading``: ``out`` (6,) as of `footfalls.Steps`."""
    net, origin, lookup = place
    cell = int(walker[body.CELL])
    floor = walker[body.Z] + origin[2]
    if cell >= 0:
        ax, ay, bx, by = walker[body.X], walker[body.Y], x - origin[0], y - origin[1]
        found = walk(net, cell, ax, ay, bx, by, _ROOM, False)
        if not found[0]:
            bx, by = ax + found[3] * (bx - ax), ay + found[3] * (by - ay)
        cell = found[1]
        x, y = bx + origin[0], by + origin[1]
        floor = floor_at(net, cell, bx, by) + origin[2]
    c, s = math.cos(heading), math.sin(heading)
    z, which = _height(lookup, x, y, floor)
    ball = _height(lookup, x + HALF_SOLE * c, y + HALF_SOLE * s, floor)[0]
    heel = _height(lookup, x - HALF_SOLE * c, y - HALF_SOLE * s, floor)[0]
    shift = 0.0
    if ball > z + _RISER:
        shift = -HALF_SOLE
    elif heel > z + _RISER:
        shift = HALF_SOLE
    if shift != 0.0:
        x, y = x + shift * c, y + shift * s
        z, which = _height(lookup, x, y, floor)
    out[0], out[1], out[2], out[3], out[4], out[5] = x, y, z, heading, 0.0, 0.0
    if which >= 0:
        normal = lookup[0][which, NX : NZ + 1]
        ahead = -(c * normal[0] + s * normal[1]) / normal[2]
        left = -(c * normal[1] - s * normal[0]) / normal[2]
        out[4] = min(max(math.atan(ahead), -_STEEPEST), _STEEPEST)
        out[5] = min(max(math.atan(left), -_STEEPEST), _STEEPEST)


@kernel
def _under(row, side, footing, ahead, left, turned):
    """Where a foot with this ``footing`` (5,) stands under a figure that has gone on by ``ahead`` and
    ``left`` [m] and has ``turned`` [rad]: x, y [m] and heading [rad]."""
    x, y, yaw, size = row[_PLACE], row[_PLACE + 1], row[_PLACE + 3] + turned, row[_TRAITS + SIZE]
    outward = (2 * side - 1) * _LEG * row[_TRAITS + WIDTH]
    c, s = math.cos(yaw), math.sin(yaw)
    fore, beside = size * footing[AHEAD], size * (footing[LEFT] + outward)
    return x + ahead + c * fore - s * beside, y + left + s * fore + c * beside, yaw + footing[TURNED]


@kernel
def _gone_on(figures, row, walker, gait, cycles, seconds, elapsed):
    """How far a figure goes on in the next ``cycles``, which take about so many ``seconds``: x, y [m], and
    how far it turns [rad]. It gets faster, up to the speed that it wants, or slower, as it does now."""
    turning = turn(row[_PLACE + 3] - row[_BEFORE + 3]) / elapsed
    turned = min(max(turning * seconds, -_BEND), _BEND)
    pace, now = math.hypot(walker[body.VX], walker[body.VY]), abs(row[at.SPEED])
    if pace < AT_REST:
        return 0.0, 0.0, turned
    gains = (pace - now) / _SLUGGISH
    gains = min(max(gains, -walker[body.ACCELERATION]), walker[body.ACCELERATION])
    then = now + 0.5 * gains * seconds
    then = min(then, max(walker[body.WISH], now)) if gains > 0.0 else max(then, 0.3 * now)
    size = row[_TRAITS + SIZE]
    stride = size * stride_of(figures, gait, then * row[_TRAITS + PACE] / math.sqrt(size))
    far = (cycles * stride / row[at.HASTE] + gains * _SLUGGISH * seconds) / pace
    c, s = math.cos(0.5 * turned), math.sin(0.5 * turned)
    x, y = walker[body.VX] * far, walker[body.VY] * far
    return c * x - s * y, s * x + c * y, turned


@allocating_kernel
def lay_feet(figures, net, origin, lookup, row, walker):
    """Put the feet where those of a figure are that goes, and has gone, straight on as it does."""
    footing, place = np.empty((2, 5)), (net, origin, lookup)
    if row[at.GAIT] < 0.0:
        row[at.PHASE] = _phase_at_rest(figures, row, footing)
    footing_of(figures, gait_played(figures, row), speed_read(row), footing)
    steps = row[_STEPS : _STEPS + 36].reshape(2, 3, 6)
    cadence = cadence_of(figures, row, walker)
    row[at.PHASE] = (row[at.PHASE] + row[at.LATE] * cadence) % 1.0
    row[at.LATE] = 0.0
    for side in range(2):
        since = since_strike(row[at.PHASE], side)
        for step in range(2):
            share = step + 0.5 * footing[side, BEARS] - since
            seconds = share / cadence if cadence > 0.0 else 0.0
            dx, dy = walker[body.VX] * seconds, walker[body.VY] * seconds
            x, y, heading = _under(row, side, footing[side], dx, dy, 0.0)
            _foothold(place, walker, x, y, heading, steps[side, step])
        for k in range(6):
            steps[side, AIM, k] = steps[side, NEXT, k]
    row[at.LAID] = 1.0


@kernel
def _settles(figures, row, steps, footing):
    """Whether a foot of one at rest is in the air or stands elsewhere than in the posture at rest, whose
    ``footing`` (2, 5) is written."""
    footing_of(figures, figures.standing[int(row[at.NODE])], 0.0, footing)
    for side in range(2):
        since = since_strike(row[at.PHASE], side)
        x, y, heading = _under(row, side, footing[side], 0.0, 0.0, 0.0)
        last = steps[side, LAST]
        if math.hypot(last[0] - x, last[1] - y) > _ASTRAY:
            return True
        if abs(turn(last[3] - heading)) > _ASKEW:
            return True
        if row[at.GAIT] >= 0.0 and since > footing[side, BEARS]:
            return True
    return False


@kernel
def _step(level, row, walker, steps, footing, standing, then, tick):
    """Let both feet go on, after the phase was as ``then`` and has grown at a cadence: ``then`` (2,).
    ``footing`` is of the gait, ``standing`` of what feet are put down for."""
    place, figures, gait, looks = level
    phase, cadence = then
    dt, elapsed = tick[0], tick[1]
    for side in range(2):
        before, since = since_strike(phase, side), since_strike(row[at.PHASE], side)
        bears = footing[side, BEARS]
        if since < before - 0.5:
            for k in range(6):
                steps[side, LAST, k] = steps[side, AIM, k]
        last = steps[side, LAST]
        if since < bears or cadence <= 0.0:
            continue
        undecided = looks and (since - bears) / (1.0 - bears) < _DECIDED
        if undecided or before < bears:
            left = 1.0 + 0.5 * bears - since
            seconds = min(left / cadence, _FORESEEN)
            dx, dy, turned = _gone_on(figures, row, walker, gait, left, seconds, elapsed)
            x, y, heading = _under(row, side, standing[side], dx, dy, turned)
            heading = last[3] + turn(heading - last[3])
            _foothold(place, walker, x, y, heading, steps[side, AIM])
            rise = abs(steps[side, AIM, 2] - last[2])
            if rise > _RISER and int(row[at.LEVEL]) == LOW:
                out = (2 * side - 1) * _WIDER * min(rise / _HIGH, 1.0)
                x, y = x - out * math.sin(heading), y + out * math.cos(heading)
                _foothold(place, walker, x, y, heading, steps[side, AIM])
        share = 1.0 if before < bears else 1.0 - math.exp(-dt / _ADJUSTS)
        for k in range(6):
            steps[side, NEXT, k] += share * (steps[side, AIM, k] - steps[side, NEXT, k])


@allocating_kernel
def advance_figures(figures, net, origin, lookup, rows, walkers, tick, phases):
    """Advance all figures by a tick: where they are drawn, their speeds, phases and feet.

    figures: as of `figure_tables`. net, origin (3,): of the surface; lookup: of the ground. tick: its length
    [s], and how many of them a body's tick takes. phases (n,): what they were is written there.
    """
    room = np.empty((2, 2, 5))
    for n in range(rows.shape[0]):
        row, walker = rows[n], walkers[n]
        phases[n] = row[at.PHASE]
        go_on(row, walker, origin, tick)
        closely = int(row[at.LEVEL]) == FULL or row[at.BUSY] > 0.0 or row[at.CROSSES] > at.NOTHING
        looks = row[at.SINCE] == tick[1] - 1  # its body has come to where it was to
        if closely or looks:
            _advance(figures, (net, origin, lookup), row, walker, looks, tick, room)


@kernel
def _advance(figures, place, row, walker, looks, tick, room):
    """Let a figure's steps go on for as long as they are late; ``looks``: whether it looks for places for its
    feet. ``tick``: as of `advance_figures`. ``room`` (2, 2, 5) is overwritten."""
    dt, elapsed = row[at.LATE], (row[at.SINCE] + 1.0) * tick[0]
    row[at.LATE] = 0.0
    footing, standing = room[0], room[1]
    steps = row[_STEPS : _STEPS + 36].reshape(2, 3, 6)
    vx, vy = walker[body.VX], walker[body.VY]
    pace = math.hypot(vx, vy)
    ahead = vx * math.cos(walker[body.YAW]) + vy * math.sin(walker[body.YAW])
    moved = -pace if ahead < -0.5 * pace else pace
    laid = row[at.LAID] > 0.0
    if laid and pace < AT_REST and row[at.BUSY] == 0.0:
        row[at.STILL] = 0.0 if _settles(figures, row, steps, standing) else 1.0
        moved = _SETTLES if row[at.STILL] == 0.0 else 0.0
    else:
        row[at.STILL] = 0.0
    row[at.SPEED] += (moved - row[at.SPEED]) * (1.0 - math.exp(-dt / _SLUGGISH))
    cadence, phase = cadence_of(figures, row, walker), row[at.PHASE]
    row[at.PHASE] = (phase + dt * cadence) % 1.0
    if row[at.GAIT] < 0.0:
        row[at.PHASE] = _phase_at_rest(figures, row, standing) if laid else row[_TRAITS + PHASE]
    if not laid or row[at.GAIT] < 0.0:
        return
    gait = gait_played(figures, row)
    footing_of(figures, gait, speed_read(row), footing)
    under = standing if pace < AT_REST else footing
    _step((place, figures, gait, looks), row, walker, steps, footing, under, (phase, cadence), (dt, elapsed))
