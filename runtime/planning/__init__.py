"""From an order to a path: the level as its bodies know it, their walk rules, their plans."""
