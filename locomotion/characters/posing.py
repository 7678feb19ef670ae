"""Where the bones of a character are, from where the person's bodies are (numba kernels).

Bones that show a part turn in the world as it does. The pelvis stays above the same point of the ground, its
height above the lowest point of the body scaled with the legs; then legs, and arms that hold on, are bent or
stretched to where their feet and hands have to be.
"""

import math

import numpy as np

from locomotion.characters.driven_bones import BESIDE, DRIVEN, SOURCES
from locomotion.characters.feet import lift_heel, place_foot, planted, reach_of_lifted_heel, rest_foot
from locomotion.characters.footing import hold_foot, hold_turn
from locomotion.characters.limb_ik import reach
from locomotion.characters.quaternions import between, multiply, rotate
from surefoot.kernels import allocating_kernel

__all__ = ["pose_characters"]

_SOURCES = len(SOURCES)
_BODIES = _SOURCES - 2
_PELVIS = SOURCES.index("pelvis")
_THIGH, _SHANK, _FOOT, _TOES, _ARM, _FOREARM, _HAND = range(7)  # rows of `PersonArrays.limbs`
_LONGEST = 0.993  # share of a limb's length that counts as in reach
_LOWERED = 0.4  # [leg lengths] most that the pelvis is lowered for feet that are out of reach
_LEANT = 0.5  # [arm lengths] most that the pelvis moves for hands that are out of reach
_TOGETHER, _APART = 0.5, 0.7
"""[m] between wrists that can hold one thing, and that cannot."""
_HALVINGS = 12  # that find how far a heel is lifted: to 0.0002 rad
_HINGE = np.array([0.0, 1.0, 0.0])


@allocating_kernel
def pose_characters(rig, person, places, contacts, footing, out):
    """Pose a character once for each of n persons, or n times for one.

    rig: `RigArrays`; person: `PersonArrays`. places: (n, 20, 7) of the person's bodies. contacts:
    `Contacts`. footing: `FootingArrays`. out: (n, b, 7) is filled with position [m] and quaternion wxyz of
    the bones in the world.
    """
    turns = np.empty((_SOURCES, 4))
    hips, shift = np.empty(3), np.empty(3)
    for i in range(len(places)):
        for b in range(_BODIES):
            turns[b] = places[i, b, 3:]
        for side in range(2):
            _untwist(turns, person.limbs[_ARM, side], person.limbs[_FOREARM, side], _BODIES + side)
        _place_pelvis(rig, person, places[i], hips)
        _follow(rig, turns, hips, out[i])
        _lean(rig, person, places[i], turns, contacts.hands[i], hips, out[i])
        feet = places[i], contacts, footing, i
        _place_legs(rig, person, feet, turns, hips, out[i])
        grip = contacts.grips[i]
        if grip > 0.0:
            grip *= _shift(rig, person, places[i], turns, hips, out[i], shift)
        for side in range(2):
            if contacts.hands[i, side] > 0.0 or grip > 0.0:
                level = contacts.hands[i, side]
                _place_hand(rig, person, places[i], turns, hips, out[i], side, level, grip, shift)
        _follow(rig, turns, hips, out[i])


@allocating_kernel
def _untwist(turns, arm, forearm, to):
    """The rotation of a forearm without its twist about itself: the hinge of the elbow alone."""
    back, relative = np.empty(4), np.empty(4)
    back[0] = turns[arm, 0]
    for k in range(1, 4):
        back[k] = -turns[arm, k]
    multiply(back, turns[forearm], relative)
    half = math.atan2(relative[3], relative[0])  # hinge about y, then twist about z
    back[0], back[1], back[2], back[3] = math.cos(half), 0.0, 0.0, -math.sin(half)
    multiply(turns[forearm], back, turns[to])


@allocating_kernel
def _place_pelvis(rig, person, places, hips):
    """``hips`` (3,): where the pelvis' bone is, before feet are looked at."""
    at = np.empty(3)
    low = np.inf
    for e in range(len(person.ends)):
        body = places[person.owners[e]]
        rotate(body[3:], person.ends[e], at)
        low = min(low, body[2] + at[2] - person.ends[e, 3])
    rotate(places[_PELVIS, 3:], rig.middle, at)
    for k in range(3):
        hips[k] = places[_PELVIS, k] - at[k]
    hips[2] += (rig.scale - 1.0) * (places[_PELVIS, 2] - low)


@allocating_kernel
def _follow(rig, turns, hips, out):
    """All bones ``out`` (b, 7) after the parts' rotations ``turns`` (s, 4), the pelvis' bone at ``hips``."""
    at = np.empty(3)
    for b in range(len(rig.parents)):
        if rig.kinds[b] == BESIDE:
            for k in range(3):
                out[b, k] = hips[k] + rig.rest[b, k]
            out[b, 3:] = rig.rest[b, 3:]
            continue
        parent = rig.parents[b]
        if rig.kinds[b] == DRIVEN:
            between(turns[rig.sources[b, 0]], turns[rig.sources[b, 1]], rig.shares[b], out[b, 3:])
            multiply(out[b, 3:], rig.aligned[b], out[b, 3:])
        else:
            multiply(out[parent, 3:], rig.rest[b, 3:], out[b, 3:])
        if b == rig.pelvis:
            out[b, :3] = hips
            continue
        rotate(out[parent, 3:], rig.rest[b], at)
        for k in range(3):
            out[b, k] = out[parent, k] + at[k]


@allocating_kernel
def _place_legs(rig, person, feet, turns, hips, out):
    """Lower ``hips`` until both feet are in reach, and turn the legs' parts so that they are where the
    person's are. ``out`` is from before; ``feet``: places of the person, contacts, footing, its number."""
    places, contacts, footing, i = feet
    ankles, lifts, weights = np.empty((2, 3)), np.empty(2), np.empty(2)
    lifted, ankle = np.empty(4), np.empty(3)
    lower = 0.0
    shift = hips - out[rig.pelvis, :3]
    for side in range(2):
        thigh, shank = person.limbs[_THIGH, side], person.limbs[_SHANK, side]
        foot = turns[person.limbs[_FOOT, side]]
        if footing.steps[i] >= 0.0:
            toes = turns[person.limbs[_TOES, side]]
            hold_turn(person, places, contacts, footing, i, side, foot, toes)
        leg = rig.lengths[0, side] + rig.lengths[1, side]
        hip = out[rig.limbs[0, side], :3] + shift
        weights[side] = planted(turns[shank])
        _hanging(hip, turns[thigh], rig.lengths[0, side], turns[shank], rig.lengths[1, side], ankle)
        place_foot(rig, person, places, contacts, i, side, foot, ankles[side])
        if weights[side] < 1.0:
            rest_foot(rig, person, places, contacts, i, side, ankle)
        loaded = weights[side] * contacts.loads[i, side]
        lifts[side] = loaded * reach_of_lifted_heel(rig, side, hip, ankles[side], foot, leg)
        for k in range(3):
            ankles[side, k] = ankle[k] + weights[side] * (ankles[side, k] - ankle[k])
            ankles[side, k] += footing.offsets[side, k]
        needed = _too_high(hip, ankles[side], leg)
        if needed > 0.0 and lifts[side] > 0.0:
            lift_heel(foot, lifts[side], lifted)
            _lifted_ankle(rig, side, foot, lifted, ankles[side], ankle)
            needed = min(needed, _too_high(hip, ankle, leg))
        lower = max(lower, loaded * needed)
    hips[2] -= lower
    hinge = np.empty(3)
    for side in range(2):
        thigh, shank = person.limbs[_THIGH, side], person.limbs[_SHANK, side]
        hip = out[rig.limbs[0, side], :3] + shift
        hip[2] -= lower
        if lifts[side] > 0.0:
            foot = turns[person.limbs[_FOOT, side]]
            plain, end = foot.copy(), ankles[side].copy()
            leg, low, high = rig.lengths[0, side] + rig.lengths[1, side], 0.0, lifts[side]
            for _ in range(_HALVINGS if _too_high(hip, end, leg) > 0.0 else 0):
                lift_heel(plain, 0.5 * (low + high), foot)
                if weights[side] < 1.0:
                    _lifted_ankle(rig, side, plain, foot, end, ankles[side])
                else:
                    place_foot(rig, person, places, contacts, i, side, foot, ankles[side])
                    ankles[side] += footing.offsets[side]
                if _too_high(hip, ankles[side], leg) > 0.0:
                    low = 0.5 * (low + high)
                else:
                    high = 0.5 * (low + high)
        if footing.steps[i] >= 0.0:
            foot, toes = turns[person.limbs[_FOOT, side]], turns[person.limbs[_TOES, side]]
            hold_foot(rig, contacts, footing, i, side, foot, toes, ankles[side])
        rotate(turns[shank], _HINGE, hinge)
        reach(
            hip, ankles[side], rig.lengths[0, side], rig.lengths[1, side], hinge, 1.0, turns[thigh],
            turns[shank],
        )  # fmt: skip


@allocating_kernel
def _hanging(start, upper_turn, upper, lower_turn, lower, end):
    """``end`` (3,) of a limb from ``start`` whose links hang down but for their rotations."""
    link, at = np.zeros(3), np.empty(3)
    link[2] = -upper
    rotate(upper_turn, link, at)
    for k in range(3):
        end[k] = start[k] + at[k]
    link[2] = -lower
    rotate(lower_turn, link, at)
    for k in range(3):
        end[k] += at[k]


@allocating_kernel
def _too_high(hip, ankle, leg):
    """By how much a hip is too high for its ankle [m], at most `_LOWERED` leg lengths."""
    away = (hip[0] - ankle[0]) ** 2 + (hip[1] - ankle[1]) ** 2
    height = math.sqrt(max((_LONGEST * leg) ** 2 - away, 0.0))
    return min(max(hip[2] - ankle[2] - height, 0.0), _LOWERED * leg)


@allocating_kernel
def _lifted_ankle(rig, side, foot, lifted, ankle, out):
    """Where an ankle goes if its foot turns about the joint of the toes to ``lifted`` (4,)."""
    before, after = np.empty(3), np.empty(3)
    rotate(foot, rig.joints[side], before)
    rotate(lifted, rig.joints[side], after)
    for k in range(3):
        out[k] = ankle[k] + before[k] - after[k]


@allocating_kernel
def _lean(rig, person, places, turns, hands, hips, out):
    """Move ``hips`` until the hands that have to be somewhere are in reach."""
    wrist, away, shift = np.empty(3), np.empty(3), np.zeros(3)
    total = 0.0
    for side in range(2):
        if hands[side] <= 0.0:
            continue
        _wrist(rig, person, places, turns, side, wrist)
        length = 0.0
        for k in range(3):
            away[k] = wrist[k] - out[rig.limbs[1, side], k]
            length += away[k] * away[k]
        length = math.sqrt(length)
        arm = _LONGEST * (rig.lengths[2, side] + rig.lengths[3, side])
        if length > arm:
            beyond = min(length - arm, _LEANT * arm) * hands[side] / length
            for k in range(3):
                shift[k] += hands[side] * beyond * away[k]
        total += hands[side]
    for k in range(3):
        hips[k] += shift[k] / max(total, 1.0)


@allocating_kernel
def _wrist(rig, person, places, turns, side, wrist):
    """Where a ``wrist`` (3,) has to be for the hand to be where the person's is."""
    hand, own = person.limbs[_HAND, side], np.empty(3)
    rotate(turns[hand], person.hand, wrist)
    rotate(turns[hand], rig.hands[side], own)
    for k in range(3):
        wrist[k] += places[hand, k] - own[k]


@allocating_kernel
def _shift(rig, person, places, turns, hips, out, shift):
    """How far the character's hands are from the person's, as their joints have it: ``shift`` (3,), the mean
    of both. Gives 1 for hands so near each other that they can hold one thing, 0 for hands far apart."""
    wrist, wanted = np.empty(3), np.empty((2, 3))
    shift[:] = 0.0
    for side in range(2):
        _hanging_wrist(rig, person, turns, hips, out, side, wrist)
        _wrist(rig, person, places, turns, side, wanted[side])
        for k in range(3):
            shift[k] += 0.5 * (wrist[k] - wanted[side, k])
    right, left = places[person.limbs[_HAND, 0]], places[person.limbs[_HAND, 1]]
    apart = math.sqrt((right[0] - left[0]) ** 2 + (right[1] - left[1]) ** 2 + (right[2] - left[2]) ** 2)
    return min(max((_APART - apart) / (_APART - _TOGETHER), 0.0), 1.0)


@allocating_kernel
def _hanging_wrist(rig, person, turns, hips, out, side, wrist):
    """Where the joints of an arm put its ``wrist`` (3,); gives where its shoulder is."""
    shoulder = out[rig.limbs[1, side], :3] + (hips - out[rig.pelvis, :3])
    _hanging(
        shoulder, turns[person.limbs[_ARM, side]], rig.lengths[2, side], turns[_BODIES + side],
        rig.lengths[3, side], wrist,
    )  # fmt: skip
    return shoulder


@allocating_kernel
def _place_hand(rig, person, places, turns, hips, out, side, level, grip, shift):
    """Turn an arm's parts so that its hand is, by the weight ``grip``, by ``shift`` (3,) from where the
    person's is, and by the weight ``level`` there itself."""
    arm, forearm = person.limbs[_ARM, side], person.limbs[_FOREARM, side]
    untwisted = _BODIES + side
    wrist, wanted = np.empty(3), np.empty(3)
    shoulder = _hanging_wrist(rig, person, turns, hips, out, side, wrist)
    _wrist(rig, person, places, turns, side, wanted)
    for k in range(3):
        wrist[k] += grip * (wanted[k] + shift[k] - wrist[k])
        wrist[k] += level * (wanted[k] - wrist[k])
    twist, hinge = np.empty(4), np.empty(3)
    for k in range(4):
        twist[k] = turns[untwisted, k] if k == 0 else -turns[untwisted, k]
    multiply(twist, turns[forearm], twist)
    rotate(turns[untwisted], _HINGE, hinge)
    reach(
        shoulder, wrist, rig.lengths[2, side], rig.lengths[3, side], hinge, -1.0, turns[arm],
        turns[untwisted],
    )  # fmt: skip
    multiply(turns[untwisted], twist, turns[forearm])
