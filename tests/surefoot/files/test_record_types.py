"""Records that come from a file hold what their classes say."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, NamedTuple, Protocol

import numpy as np
import pytest
from numpy.typing import NDArray

from surefoot.files.record_types import wrong_field


class Told(Protocol):
    name: str


class Point(NamedTuple):
    x: float
    y: float = 0.0


ORIGIN = Point(0.0)


@dataclass
class Record:
    count: int = 1
    speed: float = 1.0
    on: bool = True
    name: str = ""
    pair: tuple[int, str] = (1, "a")
    many: tuple[float, ...] = ()
    by_name: dict[str, int] | None = None
    named: Mapping[str, Point] | None = None
    which: Literal["a", 1] = "a"
    place: NDArray[np.float64] | None = None
    bare: np.ndarray | None = None
    point: Point = ORIGIN
    marked: Annotated[int, "of something"] = 0
    told: Told | None = None
    anything: Any = None
    call: Callable | None = None


def test_one_that_is_as_declared_has_no_wrong_field():
    assert wrong_field(Record()) is None
    full = Record(
        speed=2, many=(1.0, 2), by_name={"a": 1}, named={"a": Point(1.0)}, which=1, place=np.zeros(3),
        bare=np.zeros((2, 2)), told=object(), anything={3: 4},
    )  # fmt: skip
    assert wrong_field(full) is None
    assert wrong_field(Point(1.0)) is None


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("count", True), ("count", 1.0), ("count", None), ("count", np.int64(1)),
        ("speed", float("nan")), ("speed", True), ("speed", "1"), ("speed", 10**400),
        ("speed", np.float64(1)),
        ("on", 1), ("name", b"a"), ("name", None),
        ("pair", (1, "a", 2)), ("pair", ("a", 1)), ("pair", [1, "a"]),
        ("many", (1.0, "a")), ("many", 1.0),
        ("by_name", {"a": "b"}), ("by_name", {1: 1}), ("by_name", [("a", 1)]), ("named", {"a": (1.0, 2.0)}),
        ("which", "b"), ("which", True), ("which", 1.0),
        ("place", np.zeros(3, np.float32)), ("place", [0.0]), ("bare", np.zeros(2, int)),
        ("point", (0.0, 0.0)), ("marked", "a"),
    ],
)  # fmt: skip
def test_a_field_of_another_type_is_named(field, value):
    assert wrong_field(Record(**{field: value})) == field


def test_infinity_is_a_number_and_the_first_wrong_field_is_told():
    assert wrong_field(Record(speed=float("inf"))) is None
    assert wrong_field(Record(count="a", speed="b")) == "count"
    assert wrong_field(Point("a")) == "x"
