"""Recorded motion of the person, at three levels of detail, and its stateless playback.

`skeletons`: who is moved. `motion_set`: the shared motion. `sampling`: from a time, or a speed and a phase,
to joint angles. `posing`: from joint angles to where all bodies are. `footfalls`, `foot_planting`: feet on
the ground. `individual`: how figures differ. `changes`: what is sent. Offline: `recorder`, `slaving`.
"""
