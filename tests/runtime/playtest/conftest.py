import pytest
import trimesh

from runtime.cli.app import main
from runtime.playtest import playtest
from tests.runtime.playtest.levels import box


@pytest.fixture(scope="package")
def level(tmp_path_factory):
    """A yard with walls all around, a platform of 0.5 m to jump onto, and a pit that nobody gets out of."""
    folder = tmp_path_factory.mktemp("yard")
    floor = [box(0, 4, 0, 12, -3, 0), box(6, 16, 0, 12, -3, 0)]
    floor += [box(4, 6, 0, 5, -3, 0), box(4, 6, 7, 12, -3, 0)]
    pit = box(4, 6, 5, 7, -3, -1.5)
    wall = [box(-1, 0, -1, 13, -3, 3), box(16, 17, -1, 13, -3, 3)]
    wall += [box(0, 16, -1, 0, -3, 3), box(0, 16, 12, 13, -3, 3)]
    platform = box(11, 15, 4, 8, 0, 0.5)
    trimesh.util.concatenate([*floor, pit, *wall, platform]).export(folder / "yard.obj")
    return folder / "yard.obj"


@pytest.fixture(scope="package")
def outcome(level):
    return playtest(level, bots=8, seconds=40.0, seed=7)


@pytest.fixture
def surefoot(capsys):
    def call(*arguments):
        with pytest.raises(SystemExit) as left:
            main([str(each) for each in arguments])
        return left.value.code, capsys.readouterr()

    return call
