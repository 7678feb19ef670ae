"""Layout of what is observed of a person's body after each tick, (OBSERVED_SIZE,) float64.

`locomotion.gaits.run.controller.observe` writes it into the state of the running controller
(`locomotion.gaits.run.layout`, `OBSERVED`). The walk reads only this part of that state.
"""

__all__ = [
    "COM", "COM_VELOCITY", "COM_X", "COM_Y", "COM_Z", "CONTACT", "FEET", "LEFT_CONTACT", "LEFT_FOOT",
    "OBSERVED_SIZE", "RIGHT_CONTACT", "RIGHT_FOOT", "VELOCITY_X", "VELOCITY_Y", "VELOCITY_Z",
]  # fmt: skip

COM, COM_VELOCITY, FEET, CONTACT = slice(0, 3), slice(3, 6), slice(6, 12), slice(12, 14)
"""Centre of mass [m], its velocity [m/s], right and left foot [m] (ankles), normal force under each foot
[N]."""
COM_X, COM_Y, COM_Z, VELOCITY_X, VELOCITY_Y, VELOCITY_Z = range(6)
RIGHT_FOOT, LEFT_FOOT, RIGHT_CONTACT, LEFT_CONTACT = 6, 9, 12, 13
"""First of the three numbers of each foot; force under each."""
OBSERVED_SIZE = 14
