"""Materials that cost more: routes that are cheap by what a metre costs."""
