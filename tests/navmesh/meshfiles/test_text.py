"""Lines and numbers of mesh files that are text, and what is wrong with them by line."""

import numpy as np
import pytest

from navmesh.meshfiles.mesh_file import MeshFileError
from navmesh.meshfiles.text import as_lines, finite_rows, numbers, quoted, read_bytes, whole_numbers


@pytest.mark.parametrize(
    "content",
    [
        b"a\nb\n", b"a\r\nb\r\n", b"a\rb\r", "\ufeffa\nb\n".encode(), "\ufeffa\nb\n".encode("utf-16-le"),
        "\ufeffa\r\nb\r\n".encode("utf-16-be"),
    ],
)  # fmt: skip
def test_lines_of_all_systems_and_encodings(content):
    assert as_lines(content) == [b"a", b"b", b""]


@pytest.mark.parametrize(
    ("text", "kind", "found"),
    [
        (b"1 2.5\n-3e2", np.float64, [1.0, 2.5, -300.0]),
        (b" 7 -8 ", np.int64, [7, -8]),
        (b"", np.float64, []),
        (b"1 - 2", np.float64, None),
        (b"1 +", np.float64, None),
        (b"1,5", np.float64, None),
        (b"1.5", np.int64, None),
        (b"x", np.float64, None),
        (b"1 2 #", np.float64, None),
    ],
)
def test_numbers_and_nothing_else(text, kind, found):
    values = numbers(text, kind)
    assert found is None if values is None else values.tolist() == found and values.dtype == kind


def rows(*lines):
    return [line.encode() for line in lines], list(range(10, 10 + len(lines)))


def test_of_each_row_the_first_three_numbers_count():
    assert finite_rows("a", *rows("1 2 3", "4 5 6"), "a vertex").tolist() == [[1, 2, 3], [4, 5, 6]]
    assert finite_rows("a", *rows("1 2 3 9", "4 5 6 9"), "a vertex").tolist() == [[1, 2, 3], [4, 5, 6]]
    assert finite_rows("a", *rows("1 2 3 red", "4 5 6"), "a vertex").tolist() == [[1, 2, 3], [4, 5, 6]]
    assert finite_rows("a", *rows(), "a vertex").shape == (0, 3)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ("1 2", "line 11: '1 2': expected three numbers of a vertex"),
        ("1 2 x", "line 11: '1 2 x': expected three numbers"),
        ("1 nan 2", "line 11: '1 nan 2': a coordinate is not finite"),
        ("1 1e999 2", "a coordinate is not finite"),
    ],
)
def test_a_wrong_row_is_named_by_its_line(wrong, says):
    with pytest.raises(MeshFileError, match=f"^level.obj: cannot be read as a mesh: .*{says}"):
        finite_rows("level.obj", *rows("1 2 3", wrong, "4 5 6"), "a vertex")


def test_whole_numbers_come_with_how_many_each_row_has():
    values, counts = whole_numbers("a", *rows("1 2 3", "", "4"), "corners")
    assert values.tolist() == [1, 2, 3, 4] and counts.tolist() == [3, 0, 1]
    with pytest.raises(MeshFileError, match=r"line 11: '2\.5': expected corners"):
        whole_numbers("a", *rows("1 2 3", "2.5"), "corners")


def test_long_lines_are_cut_in_messages():
    assert quoted(b" abc ") == "'abc'"
    assert len(quoted(b"x" * 1000)) == 62 and quoted(b"x" * 1000).endswith("...'")


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(MeshFileError, match=r"none\.obj: cannot be read as a mesh: No such file"):
        read_bytes(tmp_path / "none.obj")
