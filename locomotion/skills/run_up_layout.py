"""What is remembered of a run-up, (RUN_UP_SIZE,) float64: the places of the numbers."""

__all__ = [
    "BALKED", "BEND", "FARTHER", "FASTER", "NEXT", "PLANNED", "REHEARSED", "RETURNS", "RUN_UP_SIZE",
    "STEPS_SEEN",
]  # fmt: skip

NEXT, STEPS_SEEN, PLANNED = 0, 1, 2
"""Number of the next obstacle; steps made when the run-up was last planned; speed [m/s] planned for this
step, or 0."""
FARTHER, FASTER, REHEARSED = 3, 4, 5
"""Chosen in rehearsal: [m] that the mark is farther from the obstacle, [m/s] that the entry is faster; 1 once
a choice has gone well."""
RETURNS, BALKED, BEND = 6, 7, 8
"""How often it has gone back for another run-up; 1 after a run-up broken off; [m] by which the path to the
obstacle is longer than the distance at right angles to its edge."""
RUN_UP_SIZE = 9
