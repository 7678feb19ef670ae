"""The figure of a person: its parts, its limbs, its state under physics."""
