"""Columns of the flat arrays that hold a crowd: what the kernels index, and nothing else.

``rows`` (n, ROW) float64 is one row per body; ``routes`` (points, POINT) float64 holds the corners of all
routes, one route after the other, and ``crossings`` (gates, CROSSING) float64 the gates on them. Coordinates
are relative to the surface's origin, as in `navmesh.structs`.
"""

__all__: list[str] = []

X, Y, Z = 0, 1, 2
"""[m] the point of the floor under the body."""
CELL = 3
"""Cell of the surface that holds it; -1 for a body that others move, or whose floor has gone."""
VX, VY = 4, 5
"""[m/s]"""
YAW = 6
"""[rad] where it faces."""
RADIUS = 7
"""[m]"""
WISH = 8
"""[m/s] speed that it was told to go at."""
ACCELERATION = 9
"""[m/s²] most change of velocity."""
WEIGHT = 10
"""Of two that meet, each takes the other's share of both weights of the change."""
MODE = 11
"""One of `STANDING`, `WALKING`, `LED`."""
ROUTE_START, ROUTE_COUNT, NEXT = 12, 13, 14
"""Where its route lies in ``routes``, and the corner that it heads for, counted from the route's first."""
BEST, WAITED = 15, 16
"""[m] least length that was left so far, [s] since that last fell by `steering.HEADWAY`."""
BLIND = 17
"""[s] since it last saw the corner that it heads for."""
GOAL_X, GOAL_Y, GOAL_Z = 18, 19, 20
"""[m] where it was sent."""
FACING = 21
"""[rad] to turn to at the goal; nan: as it arrives."""
NOTE = 22
"""What its owner has to look at: one of `QUIET`, `ARRIVED`, `STUCK`, `OFF_ROUTE`."""
ALONE = 23
"""[s] of WAITED in which nobody was in touch with it."""
AGE = 24
"""Ticks since it was made."""
GO_X, GO_Y = 25, 26
"""[m/s] velocity that it wished for in the last tick."""
LEFT_NOW = 27
"""[m] of the route that were left in the last tick."""
GATE_START, GATE_COUNT, GATE_NEXT = 28, 29, 30
"""Where the gates on its route lie in ``crossings``, and the next of them."""
PASSAGE = 31
"""How it stands with the next gate: one of `FAR`, `WAITING`, `PASSING`, `RETREATING`."""
GATE_WAIT = 32
"""[s] that it has waited since somebody was let in at its side of the gate."""
RIGHT_UNTIL = 33
"""[m] of the route that are left where its right of way ends."""
ROW = 34

STANDING, WALKING, LED = 0.0, 1.0, 2.0
"""What a body does. LED: others say where it is, or its floor has gone; it is only avoided."""
QUIET, ARRIVED, STUCK, OFF_ROUTE = 0.0, 1.0, 2.0, 3.0
FAR, WAITING, PASSING, RETREATING = 0.0, 1.0, 2.0, 3.0

POINT_X, POINT_Y, POINT_Z, LEFT = 0, 1, 2, 3
"""[m] a corner of a route, and the length of the route from there on."""
VIA = 4
"""1 for a corner that has to be visited, 0 for one that may be cut."""
POINT = 5

GATE, SIGN, LEFT_IN, LEFT_OUT = 0, 1, 2, 3
"""A gate on a route: its number, -1 or 1 by the direction, and what is left of the route [m] where it begins
and where it ends."""
IN_X, IN_Y, INTO_X, INTO_Y = 4, 5, 6, 7
"""[m] where the route enters it, and the unit vector along the passage there."""
CROSSING = 8
"""Columns of a gate on a route."""
