"""From a smooth path to where on it a body is, how fast it goes there and in which gait."""
