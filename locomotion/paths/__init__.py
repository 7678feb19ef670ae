"""From a smooth path to a body's place, speed and gait along it."""
