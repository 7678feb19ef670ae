"""Training of the networks that correct planned gaits."""
