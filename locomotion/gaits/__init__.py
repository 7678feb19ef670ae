"""Walking, running, and going over from one to the other."""
