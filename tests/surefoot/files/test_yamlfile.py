"""YAML that grows, nests or counts too far is refused where it does, without taking time or memory for it."""

import pytest
from pydantic import BaseModel

from surefoot.files.yamlfile import FileError, read_yaml


class Anything(BaseModel):
    model_config = {"extra": "allow"}


def problem(tmp_path, text):
    path = tmp_path / "a.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError) as refused:
        read_yaml(path, Anything, "thing")
    return str(refused.value).removeprefix(str(path))


def test_aliases_stand_for_what_they_repeat(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_text("a: &a [1, 2]\nb: [*a, *a]\n", encoding="utf-8")
    assert read_yaml(path, Anything, "thing")[0].model_dump() == {"a": [1, 2], "b": [[1, 2], [1, 2]]}


def test_aliases_of_aliases_do_not_multiply(tmp_path):
    lines = ["a: &a [x, x, x, x, x, x, x, x, x]"]
    lines += [
        f"{to}: &{to} [{', '.join([f'*{of}'] * 9)}]" for of, to in zip("abcdefgh", "bcdefghi", strict=True)
    ]
    assert problem(tmp_path, "\n".join(lines)).startswith(":6:4: more than 100000 values")


def test_many_values_are_refused(tmp_path):
    assert "more than 100000 values" in problem(tmp_path, "a: [" + "1," * 100_001 + "]")
    assert "more than 100000 values" in problem(tmp_path, "a: &a [1, 2, 3]\nb: [" + "*a," * 30_000 + "]")


@pytest.mark.parametrize(
    "text", ["[" * 60 + "]" * 60, "[" * 100_000, "{a: " * 100_000, "- " * 100_000, "? " * 9_000]
)
def test_deep_nesting_is_refused(tmp_path, text):
    assert "nested" in problem(tmp_path, text)


@pytest.mark.parametrize("number", ["1" + ":59" * 100_000, "0x" + "f" * 100_000, "9" * 100_000])
def test_long_numbers_are_refused(tmp_path, number):
    said = problem(tmp_path, f"a: {number}")
    assert said.startswith(":1:4: ") and said.endswith("characters") and len(said) < 100


def test_what_refers_to_itself_is_refused(tmp_path):
    assert problem(tmp_path, "a: &a\n  b: *a\n") == ":1:4: refers to itself"
