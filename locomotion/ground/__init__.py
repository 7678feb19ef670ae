"""The level as ground under simulated bodies."""
