"""A gait that a network controls: its reference motion, its observation and its kernel."""
