"""A square of people at all levels of detail."""

from examples.square import Square, draw


def test_the_nearest_are_simulated_and_the_others_are_drawn(tmp_path):
    scene = Square(people=6, dogs=1, seed=1)
    for _ in range(25):
        scene.step()
    assert 0 < scene.counts["physics"] < 6
    assert any(agent.moving for agent in scene.people)
    draw(scene, tmp_path / "square.png", (48, 30))
    assert (tmp_path / "square.png").stat().st_size > 1_000
