"""What a quadruped looks like: capsules and ellipsoids on the bones that its body file describes."""

import math

import numpy as np

from locomotion.quadruped import LEGS, Body
from locomotion.quadruped.pose import body_names, body_parents
from runtime.bodies.figure import Figure, Shapes

__all__ = ["animal_figure"]

_ALONG = (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0)
"""Turns a capsule's axis from z to x, which is along the bone."""
_DARK = 0.72  # of the colour on paws, ears and nose


def animal_figure(body: Body) -> Figure:
    """Bodies and shapes of a quadruped."""
    bones = body.spine.bones
    names = body_names(bones)
    shapes: list[tuple[int, tuple[float, ...], tuple[float, ...], bool, float]] = []

    def capsule(name: str, length: float, radius: float, shade: float = 1.0) -> None:
        half = max(0.5 * length, 1e-3)
        shapes.append(
            (names.index(name), (0.5 * length, 0.0, 0.0, *_ALONG), (radius, half, 0.0), False, shade)
        )

    def ball(
        name: str, at: tuple[float, float, float], size: tuple[float, float, float], shade: float
    ) -> None:
        shapes.append((names.index(name), (*at, 1.0, 0.0, 0.0, 0.0), size, True, shade))

    loin, chest = body.trunk.loin, body.trunk.chest
    ball("pelvis", (0.0, 0.0, 0.0), (1.15 * loin, 0.95 * loin, 1.05 * loin), 1.0)
    for k in range(bones):
        share = (k + 0.5) / bones
        radius = loin + (chest - loin) * share
        deep = -0.25 * radius * share
        size = (0.5 * body.spine.bone_length + 0.55 * radius, 0.85 * radius, radius)
        ball(f"spine_{k + 1}", (0.5 * body.spine.bone_length, 0.0, deep), size, 1.0)
    ball(
        f"spine_{bones}",
        (body.spine.bone_length, 0.0, -0.1 * chest),
        (0.8 * chest, 0.8 * chest, 0.95 * chest),
        1.0,
    )
    head = body.head
    capsule("neck", body.neck.length, 0.85 * head.radius)
    ball("head", (0.3 * head.length, 0.0, 0.0), (0.42 * head.length, 0.9 * head.radius, head.radius), 1.0)
    capsule_at = (0.72 * head.length, 0.0, -0.25 * head.radius, *_ALONG)
    shapes.append(
        (names.index("head"), capsule_at, (0.45 * head.radius, 0.22 * head.length, 0.0), False, 1.0)
    )
    ball(
        "head",
        (0.96 * head.length, 0.0, -0.1 * head.radius),
        (0.2 * head.radius, 0.2 * head.radius, 0.2 * head.radius),
        0.2,
    )
    for side in (-1.0, 1.0):
        ear = (0.08 * head.length, side * 0.7 * head.radius, 0.95 * head.radius)
        ball("head", ear, (0.25 * head.radius, 0.2 * head.radius, 0.6 * head.radius), _DARK)
    for k in range(3):
        capsule(f"tail_{k + 1}", body.tail.length / 3.0, (0.32 - 0.07 * k) * loin, _DARK if k == 2 else 1.0)
    for leg in LEGS:
        legs = body.front_legs if leg.startswith("front") else body.rear_legs
        thick = 0.10 * legs.upper + 0.13 * loin
        capsule(f"{leg}_upper", legs.upper, (1.3 if leg.startswith("front") else 1.7) * thick)
        capsule(f"{leg}_lower", legs.lower, 0.85 * thick)
        capsule(f"{leg}_foot", legs.foot, 0.65 * thick)
        ball(f"{leg}_foot", (legs.foot, 0.0, 0.0), (0.75 * thick, 0.75 * thick, 0.75 * thick), _DARK)
    colour = np.array(body.colour)
    return Figure(
        bodies=names,
        parents=np.array(body_parents(bones), dtype=np.int32),
        owner=np.array([each[0] for each in shapes], dtype=np.int32),
        shapes=Shapes(
            place=np.array([each[1] for each in shapes]),
            size=np.array([each[2] for each in shapes]),
            round=np.array([each[3] for each in shapes]),
            colour=np.array([each[4] * colour for each in shapes]),
        ),
    )
