"""The memory of a person on hands and feet: indices into its array, and the numbers of its stance."""

import numpy as np

__all__ = [
    "AIR", "ALL_DOWN", "ANCHORS", "AWAY", "AXES", "BEGUN_FROM", "BIAS", "BORNE", "BRACING", "CENTRE", "CLOCK",
    "DOWN", "FACING", "GATHERING", "GATHERS", "HOLDS", "HOMES", "LIE_AHEAD", "LIE_HERE", "LIFT", "LIMP",
    "LOADS", "MODE", "MODE_CLOCK", "PAIR", "PHASE", "PIVOT", "PIVOTING", "REACHING", "RISEN", "RISING",
    "ROLLING", "ROLL_SIDE", "SCRAMBLE_SIZE",
    "SEEN_BASE", "SEEN_COM", "SEEN_FORCES", "SEEN_LIMBS", "SEEN_TRUNK", "SEEN_TURN", "SEEN_VELOCITY",
    "SPOT", "STANCE", "SWINGING", "TICKS", "TRIES", "TUCKING", "TURNING", "new_scramble",
]  # fmt: skip

PHASE, CLOCK, PAIR, FACING, TURNING, TICKS, RISEN, SEEN_TRUNK = range(8)
"""`ALL_DOWN` or `SWINGING`; time in it [s]; pair that swings, or swung last (0: right hand and left foot);
direction that the body faces [rad], its rate [rad/s]; ticks made; share of its height to which the trunk is
raised; force [N] on trunk and head."""
ALL_DOWN, SWINGING = 0.0, 1.0
CENTRE = slice(8, 10)
"""Where the centre of mass is to be [m]."""
LIFT, SPOT = slice(10, 22), slice(22, 34)
"""(4, 3) where each limb left the ground and where it is to land [m]. Limbs: right hand, left hand, right
foot, left foot; a limb's place is the middle of the sphere with which it touches."""
LOADS, DOWN = slice(34, 38), slice(38, 42)
"""(4,) share of its load that each limb takes; 1 for limbs that bear, 0 for those in the air."""
SEEN_LIMBS, SEEN_FORCES = slice(42, 54), slice(54, 58)
SEEN_COM, SEEN_VELOCITY, SEEN_BASE, SEEN_TURN = slice(58, 61), slice(61, 64), slice(64, 67), slice(67, 76)
"""After the last physics step: limbs (4, 3) [m] and their contact forces [N]; centre of mass [m], its
velocity [m/s]; place [m] and rotation of the pelvis."""
BIAS, ANCHORS, AXES = slice(76, 115), slice(115, 232), slice(232, 349)
"""The same for the 39 joints: torque of gravity [Nm], anchors [m] and axes, (39, 3) in the world."""
STANCE = slice(349, 364)
"""The stance's own numbers, in the order of `HOMES`."""
HOLDS, AIR = slice(364, 376), slice(376, 380)
"""(4, 3) where each limb touched the ground last [m]; (4,) time [s] since then."""
MODE, MODE_CLOCK, ROLL_SIDE, TRIES = range(380, 384)
"""What the body does (one of the next line's, `AWAY` where hands and feet do not move it), for how long [s];
side over which it rolls (0: right); times that rolling has failed."""
AWAY, BRACING, LIMP, ROLLING, REACHING, PIVOTING, TUCKING, BORNE, RISING = (float(k) for k in range(-1, 8))
BEGUN_FROM = slice(384, 423)
"""Joint angles [rad] with which what it does began."""
LIE_HERE, LIE_AHEAD = slice(423, 425), slice(425, 427)
"""Gradients of the ground (2,): around the body, and where it comes to."""
GATHERING = 427
"""[s] for which the feet have been stepping under the body for it to rise, in this round."""
GATHERS = 5.0
"""[s] for which they try, until it scrambles on a bit."""
PIVOT = 428
"""How far it swings round in this round of turning on its front: share of the most, below 0 to the right."""
SCRAMBLE_SIZE = 429

HOMES = {
    "hand_ahead": 0.34,  # [m] from the centre of mass to the hands
    "hand_out": 0.24,
    "foot_behind": 0.30,
    "foot_slope": 0.15,  # [m] that feet are less far behind per unit of slope
    "foot_out": 0.17,
    "height": 0.50,  # [m] of the hips above the feet
    "height_slope": 0.20,  # [m] more per unit of slope
    "arm": 0.45,  # [m] from shoulders to hands
    "swing": 0.23,  # [s] that a limb is in the air
    "pause": 0.08,  # [s] between two swings
    "clearance": 0.08,  # [m] that a limb is lifted
    "brake": 0.1,  # [s] of too much speed by which the trunk is held back
    "tipping": 0.2,  # [s] of too much speed by which limbs are put farther
    "roll": 0.5,  # share of the ground's slope sideways to which the trunk rolls
    "curve": 0.0,  # [rad] that waist and chest bend forward, each
}
"""The stance: where limbs are at home around the centre of mass, and how they get there."""


def new_scramble(facing: float = 0.0) -> np.ndarray:
    """A person about to bear itself on hands and feet, (SCRAMBLE_SIZE,) float64."""
    memory = np.zeros(SCRAMBLE_SIZE)
    memory[FACING] = facing
    memory[DOWN] = memory[LOADS] = 1.0
    memory[RISEN], memory[MODE] = 1.0, BORNE
    memory[STANCE] = list(HOMES.values())
    return memory
