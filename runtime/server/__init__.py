"""A WebSocket server that runs worlds for engines in other languages."""
