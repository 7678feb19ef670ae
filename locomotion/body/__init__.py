"""The figure of a person: its parts, its limbs, its physical state."""
