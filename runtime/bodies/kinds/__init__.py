"""What is known of each kind of body without a world: names, sizes, walk rules, figures, bots."""
