"""Columns of the flat arrays of quadrupeds, as kernels index them.

All arrays are float64. ``params`` (bodies, PARAMS) has one row per kind of body, ``gaits`` (bodies, gaits,
GAIT) its gaits, ``state`` (n, STATE) one row per animal, ``feet`` (n, 4, FOOT) its feet in the order of
`LEGS`, ``pool`` (rows, ROW) the trails and scripted motions of all of them, one after the other.
"""

__all__ = ["LEGS"]

LEGS = ("front_left", "front_right", "rear_left", "rear_right")
"""Order of the legs everywhere."""

# --- params: one row per kind of body
BONES = 0
"""Number of spine bones."""
BONE = 1
"""[m] length of each."""
FLEX = 2
"""Share of the turn that the spine takes; the rest turns the whole body."""
MAX_BEND = 3
"""[rad] largest angle between two spine bones."""
WIDTH_FRONT, WIDTH_REAR = 4, 5
"""[m] between the left and the right feet."""
HEIGHT_FRONT, HEIGHT_REAR = 6, 7
"""[m] of shoulder and hip over the ground when standing."""
UPPER_FRONT, LOWER_FRONT, FOOT_FRONT, LEAN_FRONT = 8, 9, 10, 11
"""[m], [m], [m], [rad]: leg bones; lean of the foot bone backwards from the vertical."""
UPPER_REAR, LOWER_REAR, FOOT_REAR, LEAN_REAR = 12, 13, 14, 15
NECK, NECK_RISE, HEAD, HEAD_DROP, HEAD_TURN = 16, 17, 18, 19, 20
"""[m], [rad] upwards, [m], [rad] downwards, [rad] largest turn of neck and head together."""
TAIL, TAIL_RISE = 21, 22
"""[m] length of each of three tail bones, [rad] of the first over the horizontal."""
LOOK_AHEAD = 23
"""[s]"""
ACCELERATION, BRAKING, SIDEWAYS = 24, 25, 26
"""[m/s²]"""
STEP = 27
"""[m] highest step that a foot takes."""
CURL_FRONT, CURL_REAR = 28, 29
"""[rad] by which the foot bone folds backwards in the swing."""
AUTOMATIC = 30
"""How many of the gaits are chosen by speed; those on request follow."""
STEP_FREQUENCY = 31
"""[Hz] of the steps of a scripted motion."""
SACRAL = 32
"""Share of the back's flexion at the joint between pelvis and spine."""
LOOK, SWAY, WAG = 33, 34, 35
"""[rad] when it stands: of looking about, of the hips' roll, of the tail."""
BREATHS = 36
"""[Hz] at rest."""
PARAMS = 37

# --- gaits: one row per gait
UP_TO = 0
"""[m/s] fastest speed of the gait."""
FREQUENCY, FREQUENCY_SLOPE = 1, 2
"""[Hz] at rest and [Hz per m/s]."""
DUTY_FRONT, DUTY_FRONT_SLOPE, DUTY_REAR, DUTY_REAR_SLOPE = 3, 4, 5, 6
"""Share of the stride that a foot stands: at rest and per m/s."""
TOUCHDOWN = 7
"""Four columns: share of the stride at which each foot touches down."""
LIFT = 11
"""[m] height of the swing."""
BOB, ROCK = 12, 13
"""[m] of the trunk's rise and fall, and of the shoulders against the hips."""
FLEXION, FLEXION_SLOPE = 14, 15
"""[rad] range of the back's flexion over a stride: at rest and per m/s."""
UNDULATION, HIP_ROLL, SHOULDER_ROLL, NOD = 16, 17, 18, 19
"""[rad] range over a stride of the back's bend to the sides, of both rolls and of the neck."""
LOWER = 20
"""[rad] by which the neck is carried lower than by one that stands."""
GAIT = 21

# --- state: one row per animal
MODE = 0
"""`STANDING`, `ON_TRAIL` or `SCRIPTED`."""
STANDING, ON_TRAIL, SCRIPTED = 0.0, 1.0, 2.0
ARC, SPEED, PUSH = 1, 2, 3
"""[m] of the root along the trail, [m/s] ≥ 0, [m/s²]."""
WAY = 4
"""1 forwards along the trail, -1 backwards."""
ARC_END = 5
"""[m] where the root comes to a stop."""
FRONT_ARC = 6
"""[m] of the front feet's midpoint along the trail."""
WISH = 7
"""[m/s]"""
STOPPING, STOP_BEGIN, STOP_SPEED, STOP_PUSH, STOP_TIME, STOP_DISTANCE = 8, 9, 10, 11, 12, 13
"""Whether the stop motion plays; seconds into it; speed and acceleration at its start; its length [s]
and [m]."""
CLOCK = 14
"""Share of the stride."""
GAIT_NOW, GAIT_WISH = 15, 16
"""Index of the gait; of the one asked for, -1 to choose by speed."""
FREQUENCY_NOW, DUTY_FRONT_NOW, DUTY_REAR_NOW, LIFT_NOW, BOB_NOW, ROCK_NOW = 17, 18, 19, 20, 21, 22
TOUCHDOWN_NOW = 23
"""Four columns."""
X, Y, YAW, BEND = 27, 28, 29, 30
"""Root on the ground [m], its direction [rad], angle between spine bones [rad]; four columns in a row."""
RATE = 31
"""Four columns: their rates per second."""
OFFSET = 35
"""Four columns: remaining difference to the motion before, which keeps the pose continuous."""
OFFSET_RATE = 39
"""Four columns."""
FRONT_X, FRONT_Y, CHEST = 43, 44, 45
"""Midpoint of the front feet [m], direction of the chest [rad]."""
Z_REAR, Z_REAR_RATE, Z_FRONT, Z_FRONT_RATE = 46, 47, 48, 49
"""[m] heights of hip and shoulder, and the rates of CARRIED_REAR and CARRIED_FRONT."""
GAZE, GAZE_RATE = 50, 51
"""[rad] turn of neck and head against the chest."""
LOOK_X, LOOK_Y = 52, 53
"""[m] what the head is turned to; NaN: straight ahead."""
SCRIPT_TIME, SCRIPT_LENGTH = 54, 55
"""[s]"""
ROW_START, ROW_COUNT, ROW_STEP = 56, 57, 58
"""Its rows in the pool, and their spacing: [m] on a trail, share of the whole in a script."""
KIND = 59
"""Row of params."""
REST = 60
"""1 when at rest: the motion is over and all feet are in place."""
FIRST_TICK = 61
"""1 until rates are known."""
NO_GROUND = 62
"""1 when a foot found no ground where it was to step."""
HEIGHT = 63
"""[m] of the ground that is looked for around the root: where the surface is."""
PITCH = 64
"""[rad] of the trunk as it is carried, without what the stride adds."""
FIXED_LOOK = 65
"""1: LOOK_X, LOOK_Y are given, 0: worked out from the trail."""
CRUMBS, CRUMB_LAST = 66, 67
"""How many crumbs lie on the trail behind; index of the last one in the ring."""
PACE = 68
"""Share of its speed at which it moves while giving way."""
FREQUENCY_WISH = 69
"""[Hz] target of FREQUENCY_NOW."""
GROUND_REAR, GROUND_FRONT = 70, 71
"""[m] heights of the ground under hips and shoulders, as the feet feel it."""
FLEXION_NOW, UNDULATION_NOW, HIP_ROLL_NOW, SHOULDER_ROLL_NOW, NOD_NOW, LOWER_NOW = 72, 73, 74, 75, 76, 77
"""[rad] the gait's ranges, eased."""
BACK = 78
"""[rad] flexion of the back between pelvis and chest: above 0 rounded, below 0 hollow."""
SIDE_BEND = 79
"""[rad] bend to the left between pelvis and chest, on top of what the path asks for."""
ROLL_REAR, ROLL_FRONT = 80, 81
"""[rad] of hips and shoulders: above 0 the left side is higher."""
NECK_DIP = 82
"""[rad] by which the neck is lower than when standing still."""
LIFT_REAR, LIFT_FRONT = 83, 84
"""[m] of hips and shoulders with the stride and the breath."""
SWAY_REAR, SWAY_FRONT = 85, 86
"""[m] of hips and shoulders to the left."""
CHORD, TILT = 87, 88
"""Length of the flexed spine's chord, relative to the straight one's; [rad] of its first bone over it."""
IDLE, AGE, BREATH = 89, 90, 91
"""How much it moves as one that stands does, 0 to 1; [s] of its life; share of the breath."""
HABITS = 92
"""Four columns, 0 to 1: what makes it an individual."""
PELVIS_YAW = 96
"""[rad] direction of the pelvis at the last tick."""
TAIL_YAW, TAIL_UP = 97, 103
"""[rad] of the three tail bones against the pelvis' direction, and over the horizontal; then their rates."""
CARRIED_REAR, CARRIED_FRONT = 109, 110
"""[m] heights of hip and shoulder without what the stride and the breath add."""
DIP, DIP_RATE = 111, 112
"""[rad] by which the head looks down."""
STANDS_FRONT, STANDS_REAR = 113, 114
"""DUTY_FRONT_NOW and DUTY_REAR_NOW, eased: the trunk must not jump when the gait changes."""
SLOPE = 115
"""Rise of the ground for each metre from hips to shoulders, as the feet have felt it lately."""
STATE = 116

# --- feet
FX, FY, FZ = 0, 1, 2
"""[m] the toe now."""
FROM = 3
"""Three columns: where it left the ground."""
TO = 6
"""Three columns: where it stands, or will."""
IN_SWING, SWING_FROM = 9, 10
"""1 in the swing; share of the stride at which it began."""
BASE = 11
"""[m] height of the swing's way without its lift: the ground as the trunk feels it."""
ARCH = 12
"""[m] by which the middle of the swing's way is raised over ground that bulges between its ends."""
AIM = 13
"""Three columns: where it should come down now; SOFT_AIM follows."""
STANCE = 16
"""Share of the stride that it stands: as it was when the place was chosen where it stands, or will."""
TEMPO = 17
"""Rate at which it goes through its stride in this swing, relative to the clock."""
HUMP = 18
"""0 where a swing begins and ends, 1 in its middle."""
SOFT_AIM = 19
"""Three columns: AIM, eased; TO follows it."""
FOOT = 22

# --- joints, for users of angles: (n, JOINTS)
JOINTS_PER_LEG = 4
"""abduction, upper, lower and foot bone [rad]."""
JOINTS = 4 * JOINTS_PER_LEG + 5
"""Legs, then bend, gaze, pitch, back, neck."""

# --- rows of the pool
PX, PY, PZ, PCOS, PSIN, PHEADING, PCURVATURE, PSPEED = 0, 1, 2, 3, 4, 5, 6, 7
"""Of a trail: point [m], direction's cosine, sine, angle [rad, unwrapped], curvature [1/m], speed [m/s]."""
SX, SY, SZ, SYAW, SBEND = 0, 1, 2, 3, 4
"""Of a script: root [m], direction [rad], bend [rad]."""
ROW = 8
