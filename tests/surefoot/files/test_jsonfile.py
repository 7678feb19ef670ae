"""Standard JSON of a sensible size is read; what is wrong is told in a sentence with the file's name."""

import pytest

from surefoot import SurefootError
from surefoot.files import jsonfile
from surefoot.files.jsonfile import plain_json, read_json


def refused(path):
    with pytest.raises(SurefootError) as found:
        read_json(path, "report")
    return str(found.value).removeprefix(f"{path}: ")


def test_it_gives_what_the_file_holds(tmp_path):
    file = tmp_path / "a.json"
    file.write_text('{"é": [1, 2.5, null, true]}', encoding="utf-8")
    assert read_json(file, "report") == {"é": [1, 2.5, None, True]}


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "not a report: Expecting value: line 1 column 1"),
        (b"{'a': 1}", "not a report: Expecting property name"),
        (b"[1, NaN]", "not a report: NaN is not finite"),
        (b"-Infinity", "not a report: -Infinity is not finite"),
        (b"\xff\xfe1", "not a report: 'utf-8' codec"),
        (b"[" * 100_000, "not a report: nested too deeply"),
    ],
)
def test_what_is_no_json_is_refused(tmp_path, content, problem):
    file = tmp_path / "a.json"
    file.write_bytes(content)
    assert refused(file).startswith(problem)


def test_a_missing_file_a_folder_and_a_large_file_are_refused(tmp_path, monkeypatch):
    assert refused(tmp_path / "no.json") == "No such file or directory; expected a report (JSON)"
    assert refused(tmp_path).endswith("; expected a report (JSON)")
    file = tmp_path / "a.json"
    file.write_text("12345")
    monkeypatch.setattr(jsonfile, "_MOST_BYTES", 5)
    assert read_json(file, "report") == 12345
    file.write_text("123456")
    assert refused(file) == "6 bytes; a report may have at most 5"


def test_text_that_is_no_json_is_a_value_error():
    assert plain_json("[0.5]") == [0.5]
    with pytest.raises(ValueError, match="not finite"):
        plain_json('{"x": Infinity}')
