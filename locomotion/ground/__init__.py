"""The level as ground for simulated bodies."""
