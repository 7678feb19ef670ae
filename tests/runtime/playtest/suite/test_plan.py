"""Suite files: what they say, and what is refused with its line."""

import pytest

from runtime.playtest.suite.plan import cells_of, read_suite
from surefoot.files.yamlfile import FileError


@pytest.fixture
def written(tmp_path):
    (tmp_path / "levels").mkdir()
    for name in ("yard.obj", "hall.glb", "hall.obj"):
        (tmp_path / "levels" / name).write_text("")

    def write(text):
        (tmp_path / "night.yaml").write_text(text)
        return tmp_path / "night.yaml"

    return write


def test_every_level_is_played_by_every_body_with_every_seed(written, tmp_path):
    path = written(
        "levels: [levels/yard.obj, {file: levels/hall.glb, up: y, scale: 0.01}]\n"
        "bodies: [walker, dog]\nseeds: [3, 1]\nbots: 5\nseconds: 9\n"
    )
    suite = read_suite(path)
    cells = cells_of(suite, path)
    assert (suite.bots, suite.seconds, len(cells)) == (5, 9.0, 8)
    assert [(each.level, each.body, each.seed) for each in cells[:3]] == [
        ("yard", "walker", 3), ("yard", "walker", 1), ("yard", "dog", 3),
    ]  # fmt: skip
    assert cells[0].file == tmp_path / "levels" / "yard.obj" and cells[0].plan is None
    assert (cells[-1].up, cells[-1].scale) == ("y", 0.01)
    assert len({each.folder for each in cells}) == 8 and cells[0].folder.as_posix() == "yard/walker/seed-3"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("levels: []", "levels"),
        ("levels: [nowhere.obj]", r"1:10: levels\[0\]\.file: no such file"),
        ("levels:\n  - {file: levels/yard.obj, plan: no.yaml}", r"2:35: levels\[0\]\.plan: no such file"),
        ("levels: [levels/hall.glb, levels/hall.obj]", "a second 'hall'; give it a name of its own"),
        ("levels: [levels/yard.obj]\nseeds: [1, 2, 1]", r"2:15: seeds\[2\]: 1 a second time"),
        ("levels: [levels/yard.obj]\nbodies: [bird]", "2:10: bodies.*'bird'"),
        ("levels: [levels/yard.obj]\nbots: -1", "2:7: bots"),
        ("levels: [{file: levels/yard.obj, name: ../up}]", "a name is a letter"),
        ("levels: [levels/yard.obj]\nnights: 3", "nights"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(written, text, says):
    with pytest.raises(FileError, match=says):
        read_suite(written(text))
