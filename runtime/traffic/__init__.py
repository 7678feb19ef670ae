"""How bodies give way to each other, and deadlocks."""
