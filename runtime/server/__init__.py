"""A local WebSocket server for engines that are not written in Python."""
