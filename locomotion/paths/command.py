"""What a controller is asked for, (4,) float64: the places of the numbers."""

__all__ = ["ALONG_ASKED", "COMMAND_SIZE", "HEADING_ASKED", "SIDEWAYS_ASKED", "SLOPE_THERE", "SPEED_ASKED"]

HEADING_ASKED, SPEED_ASKED, SIDEWAYS_ASKED, SLOPE_THERE = range(4)
"""Heading [rad, world, any turn], speed [m/s], sideways speed to the left [m/s]; slope of the ground along
the heading [rise over run]."""
ALONG_ASKED = SIDEWAYS_ASKED
"""Of a person on hands and feet, in place of the sideways speed: slope [rise over run] up to which it faces
where it goes and not uphill."""
COMMAND_SIZE = 4
