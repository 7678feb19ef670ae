"""Training of jump, vault and drop-roll."""
