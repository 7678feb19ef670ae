from dataclasses import replace

import numpy as np
import pytest

from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.schema import Header, Numbers, Schema


class ThingHeader(Header):
    made_by: str


THING = Schema("thing", 3, ThingHeader, {"x": Numbers("rows")}, "make it again")


@pytest.fixture
def archive(tmp_path):
    path = tmp_path / "a.npz"
    write_archive(path, "thing", 3, {"made_by": "test"}, {"x": np.arange(1000.0)})
    return path


def test_reads_what_it_wrote(archive):
    header, arrays = read_archive(archive, THING)
    assert header.made_by == "test"
    np.testing.assert_array_equal(arrays["x"], np.arange(1000.0))


def test_missing_file_is_named(tmp_path):
    with pytest.raises(ArchiveError, match=r"nowhere\.npz: no such file"):
        read_archive(tmp_path / "nowhere.npz", THING)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_cut_off_file_is_refused(archive, share):
    whole = archive.read_bytes()
    archive.write_bytes(whole[: int(len(whole) * share)])
    with pytest.raises(ArchiveError, match="cut off or damaged"):
        read_archive(archive, THING)


def test_overwritten_bytes_are_refused_or_harmless(archive):
    whole = archive.read_bytes()
    for position in range(0, len(whole), 37):
        archive.write_bytes(whole[:position] + bytes([whole[position] ^ 0xFF]) + whole[position + 1 :])
        try:
            _, arrays = read_archive(archive, THING)
        except ArchiveError:
            continue
        np.testing.assert_array_equal(arrays["x"], np.arange(1000.0))


@pytest.mark.parametrize(("field", "damage"), [(6, 0xFF), (8, 0x01), (8, 0x20), (10, 0xFF)])
def test_listing_that_asks_for_what_no_archive_has_is_refused(archive, field, damage):
    """Its version, encryption, patches, and way of compression."""
    content = bytearray(archive.read_bytes())
    content[content.rindex(b"PK\x01\x02") + field] ^= damage
    archive.write_bytes(content)
    with pytest.raises(ArchiveError, match="cut off or damaged"):
        read_archive(archive, THING)


def test_other_kind_and_version_are_named(archive):
    with pytest.raises(ArchiveError, match="holds a 'thing', expected a 'skill'"):
        read_archive(archive, replace(THING, kind="skill"))
    older = "version 3, written by an older Surefoot; this release reads version 4: make it again"
    with pytest.raises(ArchiveError, match=older):
        read_archive(archive, replace(THING, version=4))
    with pytest.raises(ArchiveError, match="written by a newer Surefoot"):
        read_archive(archive, replace(THING, version=2))


def test_failed_write_leaves_the_old_file_alone(archive):
    before = archive.read_bytes()
    with pytest.raises(TypeError):
        write_archive(archive, "thing", 3, {"bad": object()}, {})
    assert archive.read_bytes() == before
    assert [p.name for p in archive.parent.iterdir()] == [archive.name]


def test_missing_folder_is_named(tmp_path):
    with pytest.raises(ArchiveError, match="no folder"):
        write_archive(tmp_path / "no" / "a.npz", "thing", 1, {}, {})
