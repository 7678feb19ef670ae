"""From a start and a goal to a route: A*, string pulling, the corridor around it."""
