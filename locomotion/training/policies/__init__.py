"""Learning of networks that control the person: figure, reference motion, environment, policy gradient."""
