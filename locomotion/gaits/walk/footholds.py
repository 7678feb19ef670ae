"""Where a walking person steps: capture-point footholds on the ground's triangles (numba kernels).

The centre of mass is taken for an inverted pendulum of constant height h over the stance foot's centre of
pressure p. Its divergent part, the capture point ξ = x + ẋ/ω with ω = sqrt(g/h), leaves p as
ξ(t) = p + (ξ - p) exp(ωt). A walk of speed v, period T and width w repeats itself when at each touchdown the
capture point is b = v T / (exp(ωT) - 1) ahead of the new foot and w / (1 + exp(ωT)) inside of it; the
foothold that brings it there is the predicted ξ less b (J. Englsberger et al., "Three-dimensional bipedal
walking control based on divergent component of motion", 2015; T. Koolen et al., "Capturability-based
analysis and control of legged locomotion", 2012).
"""

import math

import numpy as np

from locomotion.body.anatomy import ANKLE, SHANK, THIGH
from locomotion.gaits.walk.layout import (
    CLOCK,
    FOOTHOLD,
    FOOTHOLD_NORMAL,
    FOOTHOLD_YAW,
    GAINS,
    HUMP,
    LIFT,
    MISSED,
    SIDEWAYS,
    STAIRS_AHEAD,
    STEEPNESS,
    SWING_TIME,
    WALK_HEADING,
    WALK_SPEED,
    WALK_STANCE,
    WALK_TRIM,
    WALK_TURN_RATE,
    steep_share,
)
from locomotion.ground.collider.layout import NX, NY, NZ
from locomotion.ground.ground import height_below
from surefoot.kernels import allocating_kernel, kernel

__all__ = [
    "SOLE", "bearing", "foot_frame", "ground_at", "lowest_gap", "moved", "plan_foothold", "rise_over_steps",
    "risen", "stand_on", "steps_ahead", "sway", "tread_shift", "turn_out",
]  # fmt: skip

SOLE = 0.045
"""[m] from below the ankle forward to the middle of the sole."""

_I = {name: i for i, name in enumerate(GAINS)}
_SWING, _TRANSFER, _WIDTH, _REST = _I["swing_time"], _I["transfer_time"], _I["width"], _I["pressure_rest"]
_NARROWEST, _LONGEST, _PITCH = _I["narrowest"], _I["longest"], _I["foot_pitch"]
_ROUGH, _STEEP, _ROLL = _I["roughness"], _I["steepness"], _I["foot_roll"]
_TURN, _SPARE, _CLEARANCE, _LATE = _I["foot_turn"], _I["ankle_spare"], _I["clearance"], _I["lateness"]
_SPOT, _NORMAL, _LIFT = FOOTHOLD.start, FOOTHOLD_NORMAL.start, LIFT.start
_SEARCH = 0.7  # [m] above and below the stance foot in which ground is looked for
_TOE, _HEEL, _HALF = 0.12, -0.08, 0.035  # [m] corners of the sole around its middle
_BALL = 0.11  # [m] from the sole's middle forward to the ball, and back to the heel: what bears a foot
_BORNE = 0.02  # [m] above the lowest corner at which a corner of a foot bears nothing
_DORSIFLEXION, _HEEL_UP = 0.52, 0.8  # [rad] that an ankle bends; that a foot is turned at most
_UPHILL = 2.2  # [rad] off the way downhill from which a foot is rather turned uphill
_NOTED = 0.1  # share by which the steepness follows that of a foothold, each time it is planned
_SHORTEST_SWING = 0.24  # [s]
_HIGHEST_HUMP = 0.3  # [m]
_ASIDE = 6.0  # cost of a foothold per [m] beside the wished one
_PLACES = np.array(
    sorted((_ASIDE * (abs(x) + abs(y)), x, y) for x in 0.06 * np.arange(-3, 4) for y in (-0.05, 0.0, 0.05))
)[:, [1, 2, 0]]  # where a foot may be put around the wished place [m], and what that costs: nearest first
_FAR, _FAR_ON_STAIRS, _FLIGHT = 0.2, 0.1, 0.2
# [m] before and behind that place at most, and on a flight of stairs: from this slope of steps ahead on
_SPACING, _SHIFTS = 0.02, 11  # [m] between places on a flight that are looked at; how many, before and behind
_PROFILE_AHEAD, _PROFILE_BACK = 7, 5  # of them under a foot
_AHEAD, _HIGHEST_STEP, _LEVEL = 8, 0.23, 0.99
# how many tenths of a metre it looks ahead for steps; [m] of such a step at most; upward part of its normal
_DECIDED, _SAME = 0.4, 0.05  # share of a swing from which it goes to one tread; [m] of the height of that
_MARGIN = 0.04  # [m] above what toes and heel pass
_LONGEST_SWING = 1.5  # times the usual one, on stairs
_BURIED = 0.2  # [m] that a corner of the sole may be below the ground
_CROSSES = 0.08
# [m] that legs would have to cross, from which a step is made sooner, to have the next one, but on a flight
_STRIDE_BACK, _STRIDE, _STRADDLE = -0.45, 0.8, 0.5  # [m] what the legs reach
_TILT_DOWN = 0.8  # slope downhill to which a foot turns


@kernel
def ground_at(ground, px, py, pz):
    """(z, nx, ny, nz) of the first upward face at or below (px, py, pz); z is NaN if there is none.

    ground: rows, cell_start, cell_triangles, grid, shape of a `Ground`'s arrays, and its origin.
    """
    rows, cell_start, cell_triangles, grid, shape, origin = ground
    z, t = height_below(
        rows, cell_start, cell_triangles, grid, shape, px - origin[0], py - origin[1], pz - origin[2]
    )
    if t < 0:
        return math.nan, 0.0, 0.0, 1.0
    return z + origin[2], rows[t, NX], rows[t, NY], rows[t, NZ]


@allocating_kernel
def foot_frame(yaw, normal, out):
    """Rotation ``out`` (3, 3) of a foot with its sole across ``normal`` (3,) and its toes towards ``yaw``."""
    cx, cy = math.cos(yaw), math.sin(yaw)
    d = cx * normal[0] + cy * normal[1]
    x0, x1, x2 = cx - d * normal[0], cy - d * normal[1], -d * normal[2]
    n = math.sqrt(x0 * x0 + x1 * x1 + x2 * x2)
    out[0, 0], out[1, 0], out[2, 0] = x0 / n, x1 / n, x2 / n
    out[0, 1] = normal[1] * out[2, 0] - normal[2] * out[1, 0]
    out[1, 1] = normal[2] * out[0, 0] - normal[0] * out[2, 0]
    out[2, 1] = normal[0] * out[1, 0] - normal[1] * out[0, 0]
    out[:, 2] = normal


@allocating_kernel
def _gaps(ground, sole, foot, gap):
    """How far [m] the corners of a foot are above the ground: ``gap`` (4,)."""
    for corner in range(4):
        u = _BALL if corner < 2 else -_BALL
        v = _HALF if corner % 2 else -_HALF
        x = sole[0] + u * foot[0] + v * foot[1]
        y = sole[1] + u * foot[3] + v * foot[4]
        z = sole[2] + u * foot[6] + v * foot[7]
        floor = ground_at(ground, x, y, z + _BURIED)[0]
        gap[corner] = z - floor if floor == floor else math.inf


@allocating_kernel
def lowest_gap(ground, sole, foot):
    """How far [m] the lowest corner of a foot is above the ground. Arguments as of `bearing`."""
    gap = np.empty(4)
    _gaps(ground, sole, foot, gap)
    return gap.min()


@allocating_kernel
def bearing(ground, sole, foot, out):
    """Where a foot stands on the ground: ``out`` (4,) = how far its bearing point is ahead of the sole's
    middle and to the left of it [m], and how much of the sole's length and of its width bears, in [0, 1].

    sole (3,) [m]: middle of the sole; foot (9,): the foot's rotation, by rows. Heel, ball, left and right
    bear by how near they are to the ground, next to the nearest.
    """
    gap = np.empty(4)
    _gaps(ground, sole, foot, gap)
    low = gap.min()
    if low == math.inf:
        out[0] = out[1] = 0.0
        out[2] = out[3] = 1.0
        return
    total = ahead = left = 0.0
    for corner in range(4):
        weight = max(1.0 - (gap[corner] - low) / _BORNE, 0.0)
        total += weight
        ahead += weight if corner < 2 else -weight
        left += weight if corner % 2 else -weight
    ahead, left = ahead / total, left / total
    out[0], out[1] = _BALL * ahead, _HALF * left
    out[2], out[3] = math.sqrt(max(1.0 - ahead * ahead, 0.0)), math.sqrt(max(1.0 - left * left, 0.0))


@kernel
def sway(gains, omega, speed):
    """(ahead, inside) [m]: where the capture point is from the new stance foot at touchdown in a steady
    walk."""
    period = gains[_SWING] + gains[_LATE] + gains[_TRANSFER]
    growth = math.exp(omega * period)
    return speed * period / (growth - 1.0), gains[_WIDTH] / (1.0 + growth)


@allocating_kernel
def plan_foothold(gains, ground, walk, capture_x, capture_y, omega, sole, hip, stairs):
    """Write `FOOTHOLD`, its normal and yaw, and `SWING_TIME` into ``walk``, for the present capture point.

    sole (3,): bearing point of the stance foot [m]; hip (3,): where the swing leg's hip will be [m]; stairs:
    how much the way is one over steps, 0 to 1. A step that would be too long, or cross the other leg, is made
    sooner; one that the legs cannot make is cut. Then the flattest place near it is taken.
    """
    g = gains
    yaw = walk[WALK_HEADING] + 0.5 * walk[WALK_TURN_RATE] * (g[_SWING] + g[_TRANSFER])
    ch, sh = math.cos(yaw), math.sin(yaw)
    ahead, inside = sway(g, omega, walk[WALK_SPEED] + walk[WALK_TRIM])
    aside = sway(g, omega, walk[SIDEWAYS])[0]
    side = -walk[WALK_STANCE]  # of the foot that lands
    rest_x, rest_y = g[_REST] * ch, g[_REST] * sh
    to_x, to_y = capture_x - sole[0] - rest_x, capture_y - sole[1] - rest_y
    left = walk[SWING_TIME] - walk[CLOCK]
    late = g[_LATE] + 0.5 * g[_TRANSFER]
    walk[STAIRS_AHEAD] = steps_ahead(ground, sole, ch, sh)
    flight = walk[STAIRS_AHEAD] >= _FLIGHT
    along = across = 0.0
    shortest = min(_SHORTEST_SWING, g[_SWING])
    while True:
        growth = math.exp(omega * (left + late))
        along = (ch * to_x + sh * to_y) * growth - ahead
        across = ((-sh * to_x + ch * to_y) * growth - aside) * side + inside
        too_far = along > g[_LONGEST] or along < -0.3 or across > 0.42
        too_far = too_far or (across < g[_NARROWEST] - _CROSSES and not flight)
        if not (too_far and left > 0.04 and walk[CLOCK] + left > shortest):
            break
        left -= 0.02
    along = min(max(along, _STRIDE_BACK), _STRIDE)
    if stairs > 0.0:
        # a tread is where it is: the step is made sooner or later instead
        off = tread_shift(g, ground, walk, sole, ch, sh, along, across * side)
        made = ch * to_x + sh * to_y
        if off != 0.0 and made > 0.01 and along + off + ahead > 0.01:
            wanted = math.log((along + off + ahead) / made) / omega - late
            wanted = min(max(wanted, 0.04, shortest - walk[CLOCK]), _LONGEST_SWING * g[_SWING] - walk[CLOCK])
            left = max(wanted, 0.04)
            growth = math.exp(omega * (left + late))
            across = ((-sh * to_x + ch * to_y) * growth - aside) * side + inside
        along += off
    walk[SWING_TIME] = walk[CLOCK] + left
    along -= (1.0 - stairs) * walk[MISSED]  # on a tread there is no room for that
    across = min(max(across, g[_NARROWEST]), _STRADDLE) * side
    x, y = sole[0] + ch * along - sh * across, sole[1] + sh * along + ch * across
    far = _FAR_ON_STAIRS if flight else _FAR
    _settle(g, ground, walk, x, y, yaw, sole[2], hip, far)
    # it is the bearing point that should be there
    foot, bears = np.empty((3, 3)), np.empty(4)
    foot_frame(walk[FOOTHOLD_YAW], walk[_NORMAL : _NORMAL + 3], foot)
    bearing(ground, walk[_SPOT : _SPOT + 3], foot.ravel(), bears)
    ox = foot[0, 0] * bears[0] + foot[0, 1] * bears[1]
    oy = foot[1, 0] * bears[0] + foot[1, 1] * bears[1]
    if bears[0] != 0.0 or bears[1] != 0.0:
        _settle(g, ground, walk, x - ox, y - oy, yaw, sole[2], hip, far)
    walk[HUMP] = 0.0
    if stairs > 0.0:
        walk[HUMP] = stairs * rise_over_steps(g, ground, walk, ch, sh)
        return
    for i in range(1, 4):
        share = 0.25 * i
        px = walk[_LIFT] + share * (walk[_SPOT] - walk[_LIFT])
        py = walk[_LIFT + 1] + share * (walk[_SPOT + 1] - walk[_LIFT + 1])
        line = walk[_LIFT + 2] + share * (walk[_SPOT + 2] - walk[_LIFT + 2])
        z = ground_at(ground, px, py, sole[2] + _SEARCH)[0]
        if z == z:
            walk[HUMP] = min(max(walk[HUMP], z - line), _HIGHEST_HUMP)


@kernel
def steps_ahead(ground, sole, ch, sh):
    """Slope [rise over run] of steps before the ground under the stance foot at ``sole`` (3,): level, not as
    high."""
    level = last = ground_at(ground, sole[0], sole[1], sole[2] + _BURIED)[0]
    most = 0.0
    for i in range(1, _AHEAD + 1):
        x, y = sole[0] + 0.1 * i * ch, sole[1] + 0.1 * i * sh
        z, _, _, up = ground_at(ground, x, y, level + _SEARCH)
        if not abs(z - last) < _HIGHEST_STEP or up < _LEVEL:
            break
        last = z
        most = max(most, abs(z - level))
    return most / (0.1 * _AHEAD)


@allocating_kernel
def tread_shift(g, ground, walk, sole, ch, sh, along, across):
    """How much further along [m] than (along, across) from the stance foot at ``sole`` (3,) a foot stands
    best on one tread, on the way down rather on that of the other foot. (ch, sh): direction of the way."""
    decided = walk[CLOCK] > _DECIDED * walk[SWING_TIME]
    count = _PROFILE_BACK + _PROFILE_AHEAD
    heights = np.empty(2 * _SHIFTS + 1 + count)
    for i in range(heights.shape[0]):
        u = along + (i - _SHIFTS - _PROFILE_BACK) * _SPACING
        x, y = sole[0] + ch * u - sh * across, sole[1] + sh * u + ch * across
        heights[i] = ground_at(ground, x, y, sole[2] + _SEARCH)[0]
    least, best = math.inf, 0.0
    for shift in range(-_SHIFTS, _SHIFTS + 1):
        middle = shift + _SHIFTS + _PROFILE_BACK
        z = heights[middle]
        if not abs(z - sole[2]) < _HIGHEST_STEP or (decided and abs(z - walk[_SPOT + 2]) > _SAME):
            continue
        off = shift * _SPACING
        up = down = 0.0
        for i in range(middle - _PROFILE_BACK, middle + _PROFILE_AHEAD + 1):
            h = heights[i] - z if heights[i] == heights[i] else -_SEARCH
            up, down = max(up, h), down + max(-h, 0.0)
        cost = _ASIDE * (abs(off) + max(sole[2] - z, 0.0)) + g[_ROUGH] * (up + down / (count + 1))
        if cost < least:
            least, best = cost, off
    return best


@kernel
def rise_over_steps(g, ground, walk, ch, sh):
    """How much higher [m] than its clearance a foot has to swing so that neither its toes nor its heel touch
    what is between where it left the ground and its foothold."""
    hump = 0.0
    rise = walk[_SPOT + 2] - walk[_LIFT + 2]
    for i in range(3, 9):  # earlier and later it hardly moves along
        share = 0.1 * i
        move = moved(share)
        x = walk[_LIFT] + move * (walk[_SPOT] - walk[_LIFT])
        y = walk[_LIFT + 1] + move * (walk[_SPOT + 1] - walk[_LIFT + 1])
        z = walk[_LIFT + 2] + risen(share, rise)
        for u in (_TOE, 0.0, _HEEL):
            floor = ground_at(ground, x + u * ch, y + u * sh, max(walk[_SPOT + 2], walk[_LIFT + 2]) + 0.1)[0]
            if floor == floor:
                hump = max(hump, (floor - z) / math.sin(math.pi * share) + _MARGIN - g[_CLEARANCE])
    return min(hump, _HIGHEST_HUMP)


@kernel
def moved(share):
    """How much of its way along a swing foot has made at a ``share`` of its swing."""
    u = min(share / 0.92, 1.0)
    return u * u * u * (10.0 + u * (-15.0 + 6.0 * u))


@kernel
def risen(share, rise):
    """How much [m] of the ``rise`` to its foothold it has made: early up to a higher one, late down to a
    lower one."""
    if rise > 0.0:
        return rise * math.sin(0.5 * math.pi * min(2.0 * share, 1.0))
    return rise * (1.0 - math.cos(0.5 * math.pi * min(max(2.0 * share - 1.0, 0.0), 1.0)))


@kernel
def _settle(g, ground, walk, x, y, yaw, level, hip, far):
    """The flattest place within ``far`` [m] before or behind (x, y), and a few centimetres beside it, and how
    a foot of a body that goes towards ``yaw`` stands on it."""
    walk[FOOTHOLD_YAW] = yaw
    ch, sh = math.cos(yaw), math.sin(yaw)
    walk[_SPOT], walk[_SPOT + 1], walk[_SPOT + 2] = x, y, level
    walk[_NORMAL], walk[_NORMAL + 1], walk[_NORMAL + 2] = 0.0, 0.0, 1.0  # unless there is ground
    least = math.inf
    for place in range(_PLACES.shape[0]):
        ox, oy, cost = _PLACES[place]
        if cost >= least:
            break
        if abs(ox) > far:
            continue
        qx, qy = x + ch * ox - sh * oy, y + sh * ox + ch * oy
        z, n0, n1, n2 = ground_at(ground, qx, qy, level + _SEARCH)
        if not z > level - _SEARCH:
            continue
        cost += g[_STEEP] * (1.0 - n2) + abs(z - level)
        if cost >= least:
            continue
        rough = 0.0
        for corner in range(4):
            u = _TOE if corner < 2 else _HEEL
            v = _HALF if corner % 2 else -_HALF
            cx, cy = qx + ch * u - sh * v, qy + sh * u + ch * v
            height = ground_at(ground, cx, cy, level + _SEARCH)[0]
            flat = z - (n0 * (cx - qx) + n1 * (cy - qy)) / n2
            rough = max(rough, abs(height - flat)) if height == height else 1.0
        cost += g[_ROUGH] * rough
        if cost < least:
            least = cost
            walk[_SPOT], walk[_SPOT + 1], walk[_SPOT + 2] = qx, qy, z
            walk[_NORMAL], walk[_NORMAL + 1], walk[_NORMAL + 2] = n0, n1, n2
    if least < math.inf:
        n0, n1, n2 = walk[_NORMAL], walk[_NORMAL + 1], walk[_NORMAL + 2]
        walk[STEEPNESS] += _NOTED * (math.sqrt(max(1.0 - n2 * n2, 0.0)) / n2 - walk[STEEPNESS])
        steep = steep_share(walk[STEEPNESS])
        walk[FOOTHOLD_YAW] = yaw + turn_out(n0, n1, n2, yaw, g[_ROLL], g[_TURN])
        ch, sh = math.cos(walk[FOOTHOLD_YAW]), math.sin(walk[FOOTHOLD_YAW])
        spot = walk[_SPOT : _SPOT + 3]
        pitch = within_ankle(spot, ch, sh, hip, g[_SPARE])
        # on level ground the heel may come up later
        pitch = g[_PITCH] + steep * (min(g[_PITCH], pitch) - g[_PITCH])
        stand_on(ground, spot, walk[_NORMAL : _NORMAL + 3], ch, sh, pitch, g[_ROLL])


@kernel
def turn_out(n0, n1, n2, yaw, roll, most):
    """Angle [rad] by which a foot towards ``yaw`` is turned on ground of the normal (n0, n1, n2), so that it
    stands no steeper to the side than ``roll``: downhill, or uphill if that is much nearer; ``most`` at
    most."""
    steep = math.sqrt(n0 * n0 + n1 * n1) / n2
    if steep <= roll:
        return 0.0
    downhill = math.atan2(n1, n0)
    off = (downhill - yaw + math.pi) % (2.0 * math.pi) - math.pi
    if abs(off) > _UPHILL:
        off = (off + math.pi + math.pi) % (2.0 * math.pi) - math.pi
    needed = max(abs(off) - math.asin(roll / steep), 0.0)
    return math.copysign(min(needed, most), off)


@kernel
def within_ankle(spot, ch, sh, hip, spare):
    """Slope uphill to which a foot at ``spot`` (3,) can turn under a leg from ``hip`` (3,): what the ankle
    bends less the lean of the shank, less ``spare`` [rad]. (ch, sh): direction of the toes."""
    x, y = hip[0] - spot[0] + SOLE * ch, hip[1] - spot[1] + SOLE * sh
    z = hip[2] - spot[2] - ANKLE
    reach = min(max(math.sqrt(x * x + y * y + z * z), 0.35), 0.998 * (THIGH + SHANK))
    between = (SHANK * SHANK + reach * reach - THIGH * THIGH) / (2.0 * SHANK * reach)
    lean = math.atan2(x * ch + y * sh, z) + math.acos(min(max(between, -1.0), 1.0))
    return math.tan(min(max(_DORSIFLEXION - spare - lean, -_HEEL_UP), _HEEL_UP))


@kernel
def stand_on(ground, spot, normal, ch, sh, pitch, roll):
    """Turn a foot at ``spot`` (3,) as far towards the ground's ``normal`` (3,) as feet turn, uphill up to the
    slope ``pitch`` (toes down if that is below 0) and sideways up to ``roll``, and raise it until no corner
    of its sole is below the ground; both change in place. (ch, sh): direction of the toes."""
    n0, n1, n2 = normal
    uphill = min(max(-(n0 * ch + n1 * sh) / n2, -_TILT_DOWN), pitch)
    leftward = min(max((n0 * sh - n1 * ch) / n2, -roll), roll)
    rise = 0.0
    for corner in range(4):
        u = _TOE if corner < 2 else _HEEL
        v = _HALF if corner % 2 else -_HALF
        z = ground_at(ground, spot[0] + ch * u - sh * v, spot[1] + sh * u + ch * v, spot[2] + _BURIED)[0]
        if z == z:
            rise = max(rise, z - spot[2] - uphill * u - leftward * v)
    spot[2] += rise
    m0, m1 = -(uphill * ch - leftward * sh), -(uphill * sh + leftward * ch)
    m = math.sqrt(1.0 + m0 * m0 + m1 * m1)
    normal[0], normal[1], normal[2] = m0 / m, m1 / m, 1.0 / m
