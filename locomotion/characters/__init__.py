"""The user's own characters: rigged glTF figures that show the motion of our persons."""
