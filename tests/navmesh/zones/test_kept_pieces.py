"""Pieces that are recalled are those that would be made anew."""

import numpy as np

from navmesh.zones import dividing
from navmesh.zones.kept_pieces import room_for_states
from navmesh.zones.zones import zones_of
from tests.navmesh.zones.alike import assert_alike
from tests.navmesh.zones.test_switching import in_an_apartment, in_the_open


def forget(graph) -> None:
    switches = zones_of(graph).switches
    switches.state_count[:] = -1
    switches.kept[:] = -1


def test_what_is_recalled_is_what_would_be_made_anew():
    for level in (in_the_open, in_an_apartment):
        base, outlines = level()
        graph, anew = base.with_zones(outlines), base.with_zones(outlines)
        rng = np.random.default_rng(3)
        for _ in range(60):
            zone, blocks = rng.choice(list(outlines)), rng.random() < 0.5
            forget(anew)
            for each in (graph, anew):
                (each.block if blocks else each.open)(zone)
            assert_alike(graph, anew)


def test_each_zone_by_itself_is_known_from_the_start():
    base, outlines = in_the_open()
    graph = base.with_zones(outlines)
    switches = zones_of(graph).switches
    kept, edges = switches.state_sign.copy(), switches.kept.copy()
    for zone in outlines:
        graph.block(zone)
        graph.open(zone)
    np.testing.assert_array_equal(switches.state_sign, kept)
    assert (switches.kept == edges).mean() > 0.999  # few edges have to give way to another


def test_pieces_for_which_there_is_no_room_are_made_anew(monkeypatch):
    def little(*arguments):
        room = room_for_states(*arguments)
        return room | {
            "state_first": np.minimum(room["state_first"], 2 * np.arange(len(room["state_first"])))
        }

    base, outlines = in_the_open()
    graph = base.with_zones(outlines)
    monkeypatch.setattr(dividing, "room_for_states", little)
    cramped = base.with_zones(outlines)
    graph.block(*outlines)
    cramped.block(*outlines)
    assert zones_of(cramped).switches.piece_count.max() > 2
    assert_alike(graph, cramped)


def test_there_is_a_state_for_each_zone_of_a_disc():
    room = room_for_states(np.array([0, 2, 3]), np.array([0, 1, 0]), np.array([0, 10, 50], np.int32))
    assert room["state_start"].tolist() == [0, 2, 3]
    assert room["state_row"].tolist() == [0, 10, 20, 60]
    assert len(room["state_label"]) == 60 and (room["state_count"] == -1).all()
