"""Where bots start and go: what the plan says, else spread over the floor that players reach."""

import numpy as np
import pytest
import trimesh

from runtime.errors import RuntimeInputError
from runtime.playtest import playtest
from runtime.playtest.goals import PATCH, _spread, make_goals, patches_of
from runtime.playtest.plan import LoadedPlan
from surefoot.files.yamlfile import FileError
from tests.runtime.playtest.levels import box, site_of


def test_a_level_without_room_is_refused_in_a_sentence(tmp_path):
    box(0, 1.2, 0, 1.2, -0.5, 0).export(tmp_path / "plate.obj")
    with pytest.raises(RuntimeInputError, match="no part with 1 m² of room for the middle of a person"):
        playtest(tmp_path / "plate.obj", bots=1, seconds=1.0)


@pytest.fixture(scope="module")
def site():
    """Two floors that nobody gets from one to the other, of 40 m² and of 6 m²."""
    return site_of(trimesh.util.concatenate([box(0, 10, 0, 4, -0.2, 0), box(30, 33, 0, 2, -0.2, 0)]))


def plan_of(folder, text):
    (folder / "plan.yaml").write_text(text)
    return LoadedPlan.read(folder / "plan.yaml")


def test_each_patch_has_one_place_where_the_body_fits(site):
    all_parts = np.ones(len(site.areas), dtype=bool)
    places, patch = patches_of(site, all_parts)
    cells = site.graph.surface.centers(np.arange(len(patch)))
    assert set(patch) == {-1, *range(len(places))} and (patch[site.cell_part < 0] == -1).all()
    for k, place in enumerate(places):
        own = cells[patch == k]
        assert np.linalg.norm(own - place, axis=1).min() == 0.0
        assert (np.ptp(own[:, :2], axis=0) <= PATCH).all()
    large = np.arange(len(site.areas)) == np.argmax(site.areas)
    assert (patches_of(site, large)[0][:, 0] < 10.0).all()


def test_without_a_plan_bots_start_and_go_where_players_are(site):
    goals = make_goals(site, LoadedPlan.read(None), np.random.default_rng(1))
    assert goals.spawn_names == ("spawn1", "spawn2", "spawn3", "spawn4")
    assert len(goals.places) == 8 and goals.obstacles == ()
    assert (goals.spawns[:, 0] < 10.0).all() and (goals.targets[:, 0] < 10.0).all()


def test_the_plan_names_them(site, tmp_path):
    text = "spawns: [{name: a, at: [31, 1, 0]}]\nplaces:\n  - {name: b, at: [32, 1, 0]}\n"
    text += "  - {name: never, at: [2, 2, 0], reachable: false}\n"
    goals = make_goals(site, plan_of(tmp_path, text), np.random.default_rng(1))
    assert (goals.spawn_names, goals.place_names) == (("a",), ("b",))
    assert (goals.targets[:, 0] > 30.0).all()


def test_a_spawn_where_nobody_fits_names_its_line(site, tmp_path):
    plan = plan_of(tmp_path, "spawns:\n  - {name: a, at: [20, 1, 0]}\n")
    with pytest.raises(FileError, match=r"plan\.yaml:2:19: spawns\[0\]\.at: .* where a person fits"):
        make_goals(site, plan, np.random.default_rng(1))


@pytest.mark.parametrize("seed", range(4))
def test_each_next_one_is_the_farthest_from_those_before(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(0.0, 9.0, (30, 3))
    chosen = _spread(points, 6, np.random.default_rng(seed))
    for k in range(1, 6):
        away = np.linalg.norm(points[:, None] - chosen[:k], axis=2).min(axis=1)
        assert np.linalg.norm(chosen[k] - chosen[:k], axis=1).min() == pytest.approx(away.max())
    assert len(_spread(points[:3], 6, rng)) == 3
