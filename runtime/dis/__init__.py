"""Figures that talk to other simulators by DIS: Entity State PDUs of IEEE 1278.1 over UDP."""
