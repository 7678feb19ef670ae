"""Tag files: an author's additions, changes and removals, and messages that say where a file is wrong."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from navmesh.obstacles.tagging import TagFile
from navmesh.obstacles.tags import Addition, Change, NewValues, Reference, Tags
from surefoot import SurefootError

LEVELS = Path(__file__).resolve().parents[3] / "examples" / "levels"


@pytest.fixture(scope="module")
def terrain() -> navmesh.Terrain:
    return navmesh.Terrain.load(LEVELS / "courtyard.obj")


@pytest.fixture(scope="module")
def plain(terrain: navmesh.Terrain) -> navmesh.NodeGraph:
    return navmesh.NodeGraph.build(terrain)


def _apply(plain: navmesh.NodeGraph, tags: TagFile):
    return tags.apply(plain.obstacles, plain.surface, plain.rules)


def _file(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "level.tags.yaml"
    path.write_text(text)
    return path


def test_the_courtyard_comes_with_tags_that_fit_it(
    terrain: navmesh.Terrain, plain: navmesh.NodeGraph
) -> None:
    path = navmesh.tags_path(LEVELS / "courtyard.obj")
    assert path == LEVELS / "courtyard.tags.yaml"
    graph = navmesh.NodeGraph.build(terrain, tags=navmesh.load_tags(path))
    assert {"lane 1", "lane 2", "lane 3", "terrace"} <= set(graph.obstacles.tag)
    assert len(graph.obstacles) == len(plain.obstacles) - 4
    assert graph.obstacles.authored.sum() == 4
    assert len(graph.links) < len(plain.links)


def test_additions_are_measured_on_the_surface_and_get_links(
    terrain: navmesh.Terrain, plain: navmesh.NodeGraph, tmp_path: Path
) -> None:
    text = """
version: 1
add:
  - {name: bench, affordance: vault, position: [10, 21, 0.7], run_towards_deg: 0,
     height: 0.7, depth: 0.4, width: 2}
  - {name: puddle, affordance: gap, position: [16, 21, 0], run_towards_deg: 180.0,
     depth: 1.0, width: 2, landing: 3}
"""
    graph = navmesh.NodeGraph.build(terrain, tags=navmesh.load_tags(_file(tmp_path, text)))
    obstacles = graph.obstacles
    bench, puddle = (int(np.flatnonzero(obstacles.tag == name)[0]) for name in ("bench", "puddle"))
    assert obstacles.authored[bench] and np.allclose(obstacles.normal[bench], (-1, 0, 0))
    assert np.allclose(obstacles.rim[bench], [(10, 22, 0.7), (10, 20, 0.7)])
    assert 9.0 <= obstacles.run_up[bench] <= 10.0
    assert obstacles.landing[puddle] == 3.0
    for k in (bench, puddle):
        own = graph.links.obstacle == k
        assert own.any()
        assert np.all(graph.links.start[own][:, 2] == pytest.approx(0.0, abs=0.02))
    across = graph.find_path((5, 21, 0), (13, 21, 0), skills={"vault": (0.6, 1.0)})
    assert across.status == "complete"


def test_changes_and_removals_find_their_obstacle_by_place_or_by_tag(plain: navmesh.NodeGraph) -> None:
    name = "gap@42.0,27.0,0.0/0"
    tags = Tags(
        change=[
            Change(at=[25.2, 3.4, 0.3], set=NewValues(name="first", width=2.0, height=0.25, landing=5.0)),
            Change(tag="vault@36.0,27.0,0.8/0", set=NewValues(depth=0.35)),
        ],
        remove=[Reference(tag=name), Reference(at=[52.0, 19.0, 1.2], affordance="drop")],
    )
    result = _apply(plain, TagFile(tags))
    assert len(result) == len(plain.obstacles) - 2 and name not in result.tag
    first = int(np.flatnonzero(result.tag == "first")[0])
    assert result.width[first] == 2.0 and result.height[first] == 0.25 and result.rise[first] == 0.25
    assert np.allclose(result.rim_height[first], 0.25)
    assert np.allclose(result.rim[first], [(25, 4.4, 0.3), (25, 2.4, 0.3)], atol=0.01)
    assert result.landing[first] == 5.0 and result.authored[first]
    assert result.depth[result.tag == "vault@36.0,27.0,0.8/0"][0] == 0.35
    assert result.authored.sum() == 2


def test_tags_are_written_whole_and_read_back(tmp_path: Path) -> None:
    tags = Tags(
        add=[
            Addition(name="a", affordance="drop", position=[1, 2, 3], run_towards_deg=45, width=2, height=1.2)
        ],
        change=[Change(at=[0, 0, 0], within=2.0, set=NewValues(name="Brüstung"))],
        remove=[Reference(tag="x")],
    )
    path = tmp_path / "level.tags.yaml"
    navmesh.save_tags(path, tags)
    assert navmesh.load_tags(path).tags == tags
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]
    before = path.read_bytes()
    with pytest.raises(FileNotFoundError):
        navmesh.save_tags(tmp_path / "absent" / "level.tags.yaml", tags)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("version: 1\nadd: 3\n", "2:6: add: "),
        ("version: 2\n", "1:10: version: "),
        ("version: 1\nremoved:\n  - {tag: x}\n", "2:1: removed: unknown key; did you mean 'remove'"),
        (
            "version: 1\nremove:\n  - {affordance: jump}\n",
            "3:5: remove[0]: needs either at: [x, y, z] or tag",
        ),
        (
            "version: 1\nadd:\n  - name: a\n    affordance: hop\n    position: [0, 0, 0]\n",
            "4:17: add[0].affordance: Input should be 'jump', 'vault', 'drop' or 'gap', not 'hop'",
        ),
        (
            "version: 1\nadd:\n"
            "  - {name: a, affordance: vault, position: [0, 0, 0], run_towards_deg: 0, width: 1, "
            "height: 1}\n",
            "3:5: add[0]: a vault needs depth, above 0 [m]",
        ),
        ("version: 1\nchange:\n  - {at: [0, 0], set: {width: 1}}\n", "3:10: change[0].at: "),
        (
            "version: 1\nchange:\n  - {at: [0, 0, 0], set: {}}\n",
            "3:26: change[0].set: changes nothing; valid: name",
        ),
        ("version: 1\nchange:\n  - {at: [0, .nan, 0], set: {width: 1}}\n", "3:14: change[0].at[1]: "),
        ("version: 1\nchange: [\n", "3:1: not YAML"),
    ],
)
def test_wrong_files_are_answered_with_line_and_column(tmp_path: Path, text: str, said: str) -> None:
    path = _file(tmp_path, text)
    with pytest.raises(SurefootError) as raised:
        navmesh.load_tags(path)
    message = str(raised.value)
    assert message.startswith(f"{path}:{said}"), message
    assert "\n" not in message


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "version: 1\nremove:\n  - {at: [25, 3.4, 0.3], affordance: vault}\n",
            "3:10: no vault within 0.5 m; nearest: vault@36.0,27.0,0.8/0",
        ),
        ("version: 1\nremove:\n  - {tag: jmup}\n", "3:11: no obstacle is called 'jmup'; valid: drop@"),
        (
            "version: 1\nremove:\n  - {at: [36.15, 27, 0.8]}\n",
            "3:10: both vault@36.0,27.0,0.8/0 and vault@36.3,27.0,0.8/180 are here",
        ),
        (
            "version: 1\nremove:\n  - {at: [25, 3.4, 0.3]}\n"
            "change:\n  - {at: [25, 3.4, 0.3], set: {width: 1}}\n",
            "5:5: jump@25.0,3.4,0.3/0 is also removed",
        ),
        (
            "version: 1\nchange:\n  - {at: [25, 3.4, 0.3], set: {name: 'jump@34.0,9.6,0.7/180'}}\n",
            "3:38: two obstacles would be called 'jump@34.0,9.6,0.7/180'",
        ),
        (
            "version: 1\nadd:\n  - {name: a, affordance: jump, position: [10, 21, 5], "
            "run_towards_deg: 0, width: 1, height: 0.5}\n",
            "3:43: no floor before 'a'",
        ),
    ],
)
def test_tags_that_do_not_fit_the_level_say_where(
    plain: navmesh.NodeGraph, tmp_path: Path, text: str, said: str
) -> None:
    path = _file(tmp_path, text)
    with pytest.raises(SurefootError) as raised:
        _apply(plain, navmesh.load_tags(path))
    assert str(raised.value).startswith(f"{path}:{said}"), str(raised.value)


def test_tags_made_in_memory_are_named_by_their_entry(plain: navmesh.NodeGraph) -> None:
    tags = TagFile(Tags(remove=[Reference(tag="nothing")]))
    with pytest.raises(navmesh.NavmeshError, match=r"tags: remove\.0\.tag: no obstacle is called 'nothing'"):
        _apply(plain, tags)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(SurefootError, match="no such file; expected a tag file"):
        navmesh.load_tags(tmp_path / "none.tags.yaml")
