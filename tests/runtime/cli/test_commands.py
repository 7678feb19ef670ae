"""Bake, path, obstacles, run and check: what they answer and leave."""

import json
from pathlib import Path

import numpy as np
import pytest

import navmesh
from navmesh.graph.graph_file import GRAPH_FILE
from runtime.cli import commands
from runtime.events import Arrived, Departed
from surefoot.files.archive import write_archive
from tests.runtime.cli.answers import names, one_line
from tests.small_level import MISSION


def test_results_need_a_folder(surefoot, folder):
    (folder / "taken").write_text("")
    code, _, err = surefoot("run", folder / "mission.yaml", "--out", folder / "taken" / "out")
    assert code == 2 and one_line(err) and "not a folder" in err
    code, _, err = surefoot("bake", folder / "level.obj", "-o", folder / "nowhere" / "graph.npz")
    assert code == 2 and one_line(err) and "no folder" in err


def test_bake_tells_the_size_of_the_level(surefoot, folder):
    graph = folder / "graph.npz"
    code, out, _ = surefoot("bake", folder / "level.obj", "--scale", "2", "-o", graph, "--json")
    low, high = navmesh.Terrain.load(folder / "level.obj").bounds
    assert code == 0 and json.loads(out)["size"] == pytest.approx((2.0 * (high - low)).tolist(), abs=0.01)


def raw(path):
    """Header and arrays of an archive as they are, unchecked."""
    with np.load(path) as file:
        arrays = dict(file)
    return json.loads(arrays.pop("header").tobytes()), arrays


def test_bakes_a_graph_and_finds_paths(surefoot, folder):
    graph = folder / "graph.npz"
    code, out, _ = surefoot("bake", folder / "level.obj", "-o", graph, "--max-step", 0.3, "--json")
    values = json.loads(out)
    assert code == 0 and values["triangles"] == 4 and values["nodes"] > 10
    header, _ = raw(graph)
    assert header["rules"]["max_step"] == 0.3

    ends = ["--start", 2, 3, 0, "--goal", 9, 3, 0]
    code, out, _ = surefoot("path", graph, *ends, "--json")
    values = json.loads(out)
    assert code == 0 and values["status"] == "complete" and values["length"] == pytest.approx(7.0, abs=0.3)
    assert surefoot("path", graph, *ends, "--smooth")[0] == 0
    code, out, _ = surefoot("path", graph, "--start", 2, 3, 0, "--goal", 18, 3, 0)
    assert code == 1 and not out.startswith("complete")
    code, out, _ = surefoot("path", graph, "--start", 2, 3, 0, "--goal", 90, 3, 0, "--json")
    assert code == 1 and json.loads(out)["status"] == "off_graph"


def test_bad_graphs(surefoot, folder):
    graph = folder / "graph.npz"
    ends = ["--start", 2, 3, 0, "--goal", 9, 3, 0]
    surefoot("bake", folder / "level.obj", "-o", graph)
    whole = graph.read_bytes()
    header, arrays = raw(graph)
    graph.write_bytes(whole[: len(whole) // 2])
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "cut off or damaged" in err
    write_archive(graph, "surefoot navigation graph", 1, header, arrays)
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "version 1" in err
    moved = {**arrays, "terrain_vertices": arrays["terrain_vertices"] + 1.0}
    write_archive(graph, "surefoot navigation graph", GRAPH_FILE.version, header, moved)
    code, _, err = surefoot("path", graph, *ends)
    assert code == 2 and one_line(err) and "terrain" in err
    code, _, err = surefoot("path", folder / "gone.npz", *ends)
    assert code == 2 and one_line(err) and "no such file" in err


def test_runs_a_mission_and_leaves_its_results(surefoot, folder):
    out_folder = folder / "deep" / "out"
    code, out, _ = surefoot("run", folder / "mission.yaml", "--out", out_folder, "--json")
    values = json.loads(out)
    assert code == (0 if values["held"] else 1)
    assert {check["expected"] for check in values["checks"]} == {"arrives within 15 s", "never falls"}
    assert values["events"][0]["kind"] == "Departed"
    assert names(out_folder) == ["film.png", "level.png", "run.html", "trace.npz"]

    again = json.loads(surefoot("run", folder / "mission.yaml", "--json")[1])
    assert again["state_hash"] == values["state_hash"]

    code, _, _ = surefoot("view", out_folder / "trace.npz", "-o", folder / "again.html")
    assert code == 0 and (folder / "again.html").stat().st_size > 100_000
    code, _, err = surefoot("view", folder / "level.obj", "-o", folder / "none.html")
    assert code == 2 and one_line(err) and not (folder / "none.html").exists()


def test_an_expectation_that_fails_is_exit_code_1(surefoot, folder):
    (folder / "mission.yaml").write_text(MISSION.replace("arrives_within: 15", "arrives_within: 0.5"))
    code, out, _ = surefoot("run", folder / "mission.yaml")
    assert code == 1
    assert "arrives within 0.5 s" in out and "no" in out


def test_obstacles_are_listed_with_the_names_that_missions_use(surefoot):
    roofs = Path(__file__).parents[3] / "examples" / "levels" / "roofs.obj"
    code, out, _ = surefoot("obstacles", roofs, "--json")
    listed = json.loads(out)["obstacles"]
    assert code == 0 and len(listed) == 6
    assert {(each["skill"], each["affordance"]) for each in listed} == {("leap", "gap")}
    assert sorted(round(each["depth"], 1) for each in listed) == [0.8, 0.8, 1.2, 1.2, 1.5, 1.5]
    code, out, _ = surefoot("obstacles", roofs)
    assert code == 0 and all(any(each["tag"] in line for line in out.splitlines()) for each in listed)


def test_check_names_who_takes_part_and_runs_nothing(surefoot, folder, monkeypatch):
    monkeypatch.setattr(commands, "run_mission", None)
    code, out, _ = surefoot("check", folder / "mission.yaml", "--json")
    assert code == 0 and json.loads(out)["agents"] == [{"name": "ada", "body": "human"}]
    assert (
        surefoot("check", folder / "mission.yaml")[1]
        == f"{folder / 'mission.yaml'}: ready to run (1 agent)\n"
    )


def test_departures_in_a_row_are_told_once():
    """A pursuer replans again and again."""
    at = (0.0, 0.0, 0.0)

    def leaves(time, agent):
        return Departed(time, agent, at, at, 5.0, ())

    arrives = Arrived(4.0, "rex", at, at)
    told = [
        leaves(0.0, "rex"),
        leaves(0.0, "tom"),
        leaves(1.0, "rex"),
        leaves(2.0, "rex"),
        arrives,
        leaves(5.0, "rex"),
    ]
    assert commands._in_short(told) == [(told[0], 2), (told[1], 0), (arrives, 0), (told[5], 0)]


def test_two_levels_of_one_name_cannot_be_served(surefoot, folder):
    (folder / "more").mkdir()
    (folder / "more" / "level.obj").write_text((folder / "level.obj").read_text())
    code, _, err = surefoot("serve", folder / "level.obj", folder / "more" / "level.obj")
    assert code == 2 and one_line(err) and "two levels are called 'level'" in err
