"""Archives are checked by their schema: sizes before they are unpacked, then types, shapes and values."""

import io
import json
import tracemalloc
import zipfile

import numpy as np
import pytest

from surefoot.files.archive import ArchiveError, most_unpacked, read_archive, seal_of, write_archive
from surefoot.files.schema import Array, Flags, Header, Indices, Numbers, Offsets, Rising, Schema, Words


class ThingHeader(Header):
    name: str
    weight: float


THING = Schema(
    kind="thing",
    version=2,
    header=ThingHeader,
    arrays={
        "place": Numbers("rows", 3, low=-10.0, high=10.0),
        "next": Indices("rows", into="rows", none=True),
        "start": Offsets("rows", into="parts"),
        "part": Indices("parts", into=7),
        "time": Rising("times"),
        "kind": Words("rows", longest=5, among=lambda: ("floor", "wall")),
        "seen": Flags("rows"),
    },
    remedy="make it again",
    check=lambda header, arrays: "too heavy" if header.weight > 100.0 else None,
)


def good():
    return {
        "place": np.zeros((3, 3)),
        "next": np.array([1, 2, -1], np.int32),
        "start": np.array([0, 2, 2, 4], np.int32),
        "part": np.array([0, 6, 3, 3], np.int32),
        "time": np.array([0.0, 0.5]),
        "kind": np.array(["floor", "wall", "wall"], "<U5"),
        "seen": np.array([True, False, True]),
    }


def read(path, arrays, header=None):
    write_archive(
        path / "a.npz", "thing", 2, {"name": "x", "weight": 1.0} if header is None else header, arrays
    )
    return read_archive(path / "a.npz", THING)


def test_reads_what_fits(tmp_path):
    header, arrays = read(tmp_path, good())
    assert (header.name, header.weight) == ("x", 1.0)
    for name, array in good().items():
        assert np.array_equal(arrays[name], array) and arrays[name].dtype == array.dtype


@pytest.mark.parametrize(
    ("name", "array", "problem"),
    [
        ("place", np.full((3, 3), 11.0), r"place\[0, 0\] is 11.0, expected a finite number from -10 to 10"),
        ("place", np.full((3, 3), np.nan), r"place\[0, 0\] is nan"),
        ("place", np.zeros((3, 2)), "place has shape"),
        ("place", np.zeros((4, 3)), "does not fit 4 rows"),
        ("place", np.zeros((3, 3), np.float32), "place is of type float32, expected float64"),
        ("place", np.zeros((3, 3), ">f8"), "place is of type"),
        ("next", np.array([1, 2, 3], np.int32), r"next\[2\] is 3, expected -1 to 2"),
        ("next", np.array([-2, 2, -1], np.int32), r"next\[0\] is -2"),
        ("start", np.array([0, 3, 2, 4], np.int32), "start decreases after 1"),
        ("start", np.array([0, 2, 2, 5], np.int32), "start goes from 0 to 5, expected 0 to 4"),
        ("start", np.array([1, 2, 2, 4], np.int32), "start goes from 1 to 4"),
        ("start", np.zeros(0, np.int32), "start has shape"),
        ("part", np.array([0, 7, 3, 3], np.int32), r"part\[1\] is 7, expected 0 to 6"),
        ("time", np.array([0.0, 0.0]), "time does not increase after 0"),
        ("time", np.zeros(0), "time has 0 rows, expected at least 1"),
        ("kind", np.array(["floor", "roof", "wall"], "<U5"), "kind holds 'roof', expected floor, wall"),
        ("kind", np.array(["floor"] * 3, "<U6"), "kind is of type <U6"),
        ("kind", np.frombuffer(b"\xff" * 60, "<U5"), "kind holds values that are not text"),
        ("seen", np.array([1, 2, 0], np.uint8).view(np.bool_), r"seen\[1\] is 2, expected 0 to 1"),
    ],
)
def test_refuses_an_array_that_does_not_fit(tmp_path, name, array, problem):
    with pytest.raises(ArchiveError, match=rf"a\.npz: not a whole thing: .*{problem}.*; make it again$"):
        read(tmp_path, {**good(), name: array})


def test_refuses_arrays_that_are_missing_or_too_many(tmp_path):
    with pytest.raises(ArchiveError, match="lacks 'time'"):
        read(tmp_path, {name: array for name, array in good().items() if name != "time"})
    with pytest.raises(ArchiveError, match="should not hold 'more'"):
        read(tmp_path, {**good(), "more": np.zeros(3)})


@pytest.mark.parametrize(
    ("header", "problem"),
    [
        ({"name": "x"}, "its header.weight: Field required"),
        ({"name": "x", "weight": "1"}, "its header.weight"),
        ({"name": "x", "weight": float("nan")}, "NaN is not finite"),
        ({"name": 1, "weight": 1.0}, "its header.name"),
        ({"name": "x", "weight": 1.0, "more": 1}, "its header.more"),
        ({"name": "x", "weight": 101.0}, "too heavy"),
        ({"name": "x", "weight": 10**400}, "its header.weight"),
    ],
)
def test_refuses_a_header_that_does_not_fit(tmp_path, header, problem):
    with pytest.raises(ArchiveError, match=problem):
        read(tmp_path, good(), header)


def members_of(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def rewritten(path, members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members:
            archive.writestr(name, content)


def test_the_seal_guards_what_the_schema_cannot(tmp_path):
    read(tmp_path, good())
    path, members = tmp_path / "a.npz", members_of(tmp_path / "a.npz")
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.ones((3, 3)))
    changed = {**members, "place.npy": stream.getvalue()}
    rewritten(path, changed.items())
    with pytest.raises(ArchiveError, match="its content was changed after it was written"):
        read_archive(path, THING)
    header = json.loads(np.lib.format.read_array(io.BytesIO(members["header.npy"])).tobytes())
    rewritten(path, [(name, content) for name, content in changed.items() if name != "header.npy"])
    with zipfile.ZipFile(path) as archive:
        header["seal"] = seal_of(header, archive.infolist())
    for told in (header, {key: value for key, value in header.items() if key != "seal"}):
        stream = io.BytesIO()
        np.lib.format.write_array(stream, np.frombuffer(json.dumps(told).encode(), np.uint8))
        rewritten(path, {**changed, "header.npy": stream.getvalue()}.items())
        assert read_archive(path, THING)[1]["place"].sum() == 9.0


def test_the_same_content_gives_the_same_bytes(tmp_path):
    read(tmp_path, good())
    first = (tmp_path / "a.npz").read_bytes()
    read(tmp_path, good())
    assert (tmp_path / "a.npz").read_bytes() == first


def test_what_would_unpack_to_very_much_is_not_unpacked(tmp_path):
    """All sizes fit each other, but a small file cannot become a large one: what is honest and packs so well
    is written unpacked."""
    bare = Schema("bare", 1, Header, {"x": Array("float64", ("n",))}, "make it again")
    big = np.zeros(40 * 2**20 // 8)
    path = tmp_path / "a.npz"
    write_archive(path, "bare", 1, {}, {"x": big})
    assert path.stat().st_size > big.nbytes and np.array_equal(read_archive(path, bare)[1]["x"], big)
    rewritten(path, members_of(path).items())
    assert most_unpacked(path.stat().st_size) < big.nbytes
    tracemalloc.start()
    with pytest.raises(ArchiveError, match="bytes unpack to"):
        read_archive(path, bare)
    assert tracemalloc.get_traced_memory()[1] < 2**20
    tracemalloc.stop()


def test_shapes_are_compared_before_anything_is_unpacked(tmp_path):
    arrays = {**good(), "place": np.zeros((600_000, 3))}  # 14 MB, which any file may unpack to
    tracemalloc.start()
    with pytest.raises(ArchiveError, match="does not fit 600000 rows"):
        write_archive(tmp_path / "a.npz", "thing", 2, {"name": "x", "weight": 1.0}, arrays)
        tracemalloc.reset_peak()
        del arrays
        before = tracemalloc.get_traced_memory()[0]
        read_archive(tmp_path / "a.npz", THING)
    assert tracemalloc.get_traced_memory()[1] - before < 2**20
    tracemalloc.stop()


def test_nothing_is_unpickled(tmp_path):
    read(tmp_path, good())
    path, members = tmp_path / "a.npz", members_of(tmp_path / "a.npz")
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.array([print, print, print], object), allow_pickle=True)
    rewritten(path, {**members, "place.npy": stream.getvalue()}.items())
    with pytest.raises(ArchiveError):
        read_archive(path, THING)


@pytest.mark.parametrize(
    "text", [b"[" * 100_000, b"[]", b"7", b"\xff\xfe", b'{"kind": "thing", "version": true}']
)
def test_refuses_a_header_that_is_none(tmp_path, text):
    read(tmp_path, good())
    path, members = tmp_path / "a.npz", members_of(tmp_path / "a.npz")
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.frombuffer(text, np.uint8))
    rewritten(path, {**members, "header.npy": stream.getvalue()}.items())
    with pytest.raises(ArchiveError):
        read_archive(path, THING)
