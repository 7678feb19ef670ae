"""Columns of the flat arrays of a crowd, as kernels index them.

``rows`` (n, ROW) float64 has one row per body; ``routes`` (points, POINT) float64 holds the corners of all
routes, one route after the other, and ``crossings`` (gates, CROSSING) float64 the gates on them. Coordinates
are relative to the surface's origin, as in `navmesh.graph.kernel_arrays`.
"""

__all__: list[str] = []

X, Y, Z = 0, 1, 2
"""[m] the floor point under the body."""
CELL = 3
"""Cell of the surface that holds it; -1 for a body that is moved externally, or whose floor is gone."""
VX, VY = 4, 5
"""[m/s]"""
YAW = 6
"""[rad] direction it faces."""
RADIUS = 7
"""[m]"""
WISH = 8
"""[m/s] wanted speed."""
ACCELERATION = 9
"""[m/s²] greatest change of velocity."""
WEIGHT = 10
"""When two meet, each makes a share of the change given by the other's weight."""
MODE = 11
"""One of `STANDING`, `WALKING`, `LED`, `ROOTED`."""
ROUTE_START, ROUTE_COUNT, NEXT = 12, 13, 14
"""Position of its route in ``routes``, and the corner that it heads for, counted from the route's first."""
BEST, WAITED = 15, 16
"""[m] least length left so far, [s] since that last decreased by `steering.HEADWAY`."""
BLIND = 17
"""[s] since it last saw the corner that it heads for."""
GOAL_X, GOAL_Y, GOAL_Z = 18, 19, 20
"""[m] goal."""
FACING = 21
"""[rad] final direction at the goal; nan: as it arrives."""
NOTE = 22
"""Message to its owner: one of `QUIET`, `ARRIVED`, `STUCK`, `OFF_ROUTE`."""
ALONE = 23
"""[s] of WAITED without contact."""
AGE = 24
"""Ticks since it was created."""
GO_X, GO_Y = 25, 26
"""[m/s] velocity wished for in the last tick."""
LEFT_NOW = 27
"""[m] left of the route in the last tick."""
GATE_START, GATE_COUNT, GATE_NEXT = 28, 29, 30
"""Position of its route's gates in ``crossings``, and the next of them."""
PASSAGE = 31
"""Its relation to the next gate: one of `FAR`, `WAITING`, `PASSING`, `RETREATING`."""
GATE_WAIT = 32
"""[s] waited since somebody was last admitted at its side of the gate."""
RIGHT_UNTIL = 33
"""[m] left of the route where its right of way ends."""
ROW = 34

STANDING, WALKING, LED, ROOTED = 0.0, 1.0, 2.0, 3.0
"""Modes of a body. LED: it is moved externally, or its floor is gone; others only avoid it. ROOTED: it kneels
or lies where it is, and makes way for nobody."""
UNMOVED = 1e9
"""Weight of a body that others cannot move."""
QUIET, ARRIVED, STUCK, OFF_ROUTE = 0.0, 1.0, 2.0, 3.0
FAR, WAITING, PASSING, RETREATING = 0.0, 1.0, 2.0, 3.0

POINT_X, POINT_Y, POINT_Z, LEFT = 0, 1, 2, 3
"""[m] a corner of a route, and the length of the route from there."""
VIA = 4
"""1 for a corner that must be visited, 0 for one that may be cut."""
POINT = 5

GATE, SIGN, LEFT_IN, LEFT_OUT = 0, 1, 2, 3
"""A gate on a route: its number, its direction (-1 or 1), and the rest of the route [m] where it begins and
where it ends."""
IN_X, IN_Y, INTO_X, INTO_Y = 4, 5, 6, 7
"""[m] where the route enters it, and the unit vector along the passage there."""
CROSSING = 8
"""Columns of a gate on a route."""
