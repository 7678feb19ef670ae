"""The bodies that agents have: people, animals, walkers."""
