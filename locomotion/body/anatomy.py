"""Measures of the person: lengths, masses, joints.

Segment masses, centres of mass and radii of gyration are those of P. de Leva (1996), "Adjustments to
Zatsiorsky-Seluyanov's segment inertia parameters", J. Biomech. 29(9), for men, scaled to 1.70 m; joint
heights follow the proportions of D. Winter, "Biomechanics and Motor Control of Human Movement". Joint
ranges are those of common clinical tables, torque limits those of strong adults. Sides are given for the
left; the right mirrors it.
"""

from dataclasses import dataclass

__all__ = [
    "ANKLE", "FOREARM", "HEIGHT", "MASS", "SHANK", "SIDE_JOINTS", "SIDE_SEGMENTS", "STANDING_HEIGHT", "THIGH",
    "TOE_JOINT", "TRUNK_JOINTS", "TRUNK_SEGMENTS", "UPPER_ARM", "Joint", "Segment",
]  # fmt: skip

HEIGHT = 1.70
"""Stature [m]."""
MASS = 65.0
"""Mass of the whole body [kg]."""
STANDING_HEIGHT = 0.90
"""Height of the root (mid-hip point) above the sole with straight legs [m]."""

THIGH, SHANK, ANKLE = 0.412, 0.424, 0.064
TOE_JOINT = (0.125, 0.0, -ANKLE + 0.024)
"""[m] from the ankle."""
UPPER_ARM, FOREARM = 0.275, 0.2626


@dataclass(frozen=True)
class Joint:
    """One hinge: axis for the middle or the left side, range [deg], gain [Nm/rad], torque limit [Nm]."""

    name: str
    axis: tuple[float, float, float]
    low: float
    high: float
    stiffness: float
    torque: float


@dataclass(frozen=True)
class Segment:
    """One rigid segment: share of the body's mass, centre of mass [m], radii of gyration [m] about x, y,
    z."""

    name: str
    mass: float
    com: tuple[float, float, float]
    gyration: tuple[float, float, float]


_PITCH, _FLEX = (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)
_ROLL, _YAW = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)

TRUNK_JOINTS = {
    "waist": (
        Joint("waist_pitch", _PITCH, -25, 50, 600, 300),
        Joint("waist_roll", _ROLL, -25, 25, 600, 250),
        Joint("waist_yaw", _YAW, -30, 30, 500, 150),
    ),
    "chest": (
        Joint("chest_pitch", _PITCH, -20, 40, 500, 250),
        Joint("chest_roll", _ROLL, -20, 20, 500, 200),
        Joint("chest_yaw", _YAW, -35, 35, 400, 120),
    ),
    "head": (
        Joint("neck_pitch", _PITCH, -50, 50, 60, 40),
        Joint("neck_roll", _ROLL, -40, 40, 60, 40),
        Joint("neck_yaw", _YAW, -70, 70, 40, 25),
    ),
}
# Abduction of the left limb turns about +x (the limb's lower end moves to +y); inward rotation about -z.
SIDE_JOINTS = {
    "thigh": (
        Joint("hip_flexion", _FLEX, -30, 125, 600, 350),
        Joint("hip_abduction", _ROLL, -30, 45, 500, 250),
        Joint("hip_rotation", (0.0, 0.0, -1.0), -40, 45, 300, 120),
    ),
    "shank": (Joint("knee_flexion", _PITCH, -2, 150, 500, 350),),
    "foot": (
        Joint("ankle_flexion", _FLEX, -50, 30, 400, 300),
        Joint("ankle_inversion", (-1.0, 0.0, 0.0), -25, 25, 150, 80),
    ),
    "toes": (Joint("toe_extension", _FLEX, -30, 60, 30, 50),),
    "clavicle": (Joint("clavicle_elevation", _ROLL, -10, 35, 200, 120),),
    "upper_arm": (
        Joint("shoulder_flexion", _FLEX, -60, 180, 150, 120),
        Joint("shoulder_abduction", _ROLL, -30, 150, 150, 120),
        Joint("shoulder_rotation", (0.0, 0.0, -1.0), -90, 90, 80, 70),
    ),
    "forearm": (
        Joint("elbow_flexion", _FLEX, 0, 150, 100, 80),
        Joint("forearm_twist", (0.0, 0.0, -1.0), -85, 85, 15, 20),
    ),
    "hand": (
        Joint("wrist_flexion", _ROLL, -70, 70, 15, 20),
        Joint("wrist_deviation", _FLEX, -25, 35, 15, 20),
    ),
}

TRUNK_SEGMENTS = {
    "pelvis": Segment("pelvis", 0.1117, (0.0, 0.0, 0.055), (0.0875, 0.0784, 0.0835)),
    "waist": Segment("waist", 0.1633, (0.005, 0.0, 0.138), (0.1012, 0.0804, 0.0983)),
    "chest": Segment("chest", 0.1496, (0.0, 0.0, 0.149), (0.1194, 0.0757, 0.1099)),
    "head": Segment("head", 0.0694, (0.012, 0.0, 0.132), (0.0717, 0.0744, 0.0618)),
}
SIDE_SEGMENTS = {
    "thigh": Segment("thigh", 0.1416, (0.0, 0.0, -0.4095 * THIGH), (0.1355, 0.1355, 0.0614)),
    "shank": Segment("shank", 0.0433, (0.0, 0.0, -0.4459 * SHANK), (0.1081, 0.1056, 0.0437)),
    "foot": Segment("foot", 0.0117, (0.035, 0.0, -0.034), (0.0300, 0.0560, 0.0580)),
    "toes": Segment("toes", 0.0020, (0.030, 0.0, -0.004), (0.0270, 0.0200, 0.0300)),
    "clavicle": Segment("clavicle", 0.0050, (0.0, 0.08, 0.0), (0.0300, 0.0400, 0.0400)),
    "upper_arm": Segment("upper_arm", 0.0271, (0.0, 0.0, -0.5772 * UPPER_ARM), (0.0784, 0.0740, 0.0434)),
    "forearm": Segment("forearm", 0.0162, (0.0, 0.0, -0.4574 * FOREARM), (0.0725, 0.0696, 0.0318)),
    "hand": Segment("hand", 0.0061, (0.0, 0.0, -0.0665), (0.0529, 0.0432, 0.0338)),
}
