"""Learning to jump, vault and drop."""
