"""Archives for baked and learned data: a NumPy ``.npz`` with a JSON header, written atomically.

The header holds the file's ``kind``, its format version, a ``seal``, and what its writer adds (such as the
digest of its inputs). The seal is a digest of the header and of the names, sizes and checksums of all arrays;
it reveals damaged or swapped arrays, but guards against accidents only. Every file is therefore checked
against its `surefoot.files.schema.Schema`: first sizes, types and shapes, which are known before anything is
unpacked, then the values. Nothing is unpickled.
"""

import hashlib
import json
import os
import tokenize
import zipfile
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import IO, Any, NamedTuple, cast

import numpy as np
from pydantic import ValidationError

from surefoot.errors import SurefootError
from surefoot.files.atomic_write import whole_file
from surefoot.files.inputs import refuse_input
from surefoot.files.jsonfile import plain_json
from surefoot.files.schema import HeaderType, Schema, Sizes

__all__ = ["ArchiveError", "check_target", "most_unpacked", "read_archive", "seal_of", "write_archive"]

_HEADER, _ENDING = "header", ".npy"
_SEAL = "seal"
_ALWAYS, _PACKED = 16 * 2**20, 100  # [bytes] that any file may unpack to, plus a multiple of its packed size
_MOST_MEMBERS = 100_000
_CHUNK = 2**20  # [bytes] read at a time
_COMPRESSIONS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1
# Errors of NumPy and zipfile for a file that is cut off, overwritten or not an archive.
_DAMAGE = (
    ValueError, KeyError, TypeError, EOFError, AttributeError, RuntimeError, MemoryError, IndexError,
    OverflowError, SyntaxError, zipfile.BadZipFile, zlib.error,
    tokenize.TokenError,
)  # fmt: skip


class ArchiveError(SurefootError):
    """An archive is missing, damaged, or of another kind or version."""


def check_target(path: str | os.PathLike[str]) -> None:
    """Check before long work that ``path`` can be written. Raises `ArchiveError` if not, and `SurefootError`
    if it is an input of this command."""
    target = Path(path)
    if not target.parent.is_dir():
        raise ArchiveError(f"{target}: no folder {target.parent} to write to")
    if target.is_dir():
        raise ArchiveError(f"{target}: is a folder; give a file")
    if not os.access(target.parent, os.W_OK):
        raise ArchiveError(f"{target}: the folder {target.parent} is not writable")
    refuse_input(target)


def most_unpacked(packed: int) -> int:
    """Most bytes that an archive of ``packed`` bytes may unpack to. Larger content is stored uncompressed."""
    return _ALWAYS + _PACKED * packed


def write_archive(
    path: str | os.PathLike[str],
    kind: str,
    version: int,
    header: Mapping[str, Any],
    arrays: Mapping[str, np.ndarray],
) -> None:
    """Write ``arrays`` under ``header`` to ``path``; the file appears whole or not at all.

    ``header`` must be representable in JSON. Equal content gives equal bytes. Content is checked only when it
    is read, by `read_archive`.
    """
    if _HEADER in arrays:
        raise ArchiveError(f"no array may be called {_HEADER!r}, the name of the header")
    check_target(path)
    content = {**header, "kind": kind, "version": version}
    with whole_file(path) as temporary:
        _write(temporary, content, arrays, zipfile.ZIP_DEFLATED)
        unpacked = sum(array.nbytes for array in arrays.values())
        if unpacked > most_unpacked(temporary.stat().st_size):
            _write(temporary, content, arrays, zipfile.ZIP_STORED)


def _write(path: Path, content: dict[str, Any], arrays: Mapping[str, np.ndarray], compression: int) -> None:
    def put(name: str, array: np.ndarray) -> None:
        member = zipfile.ZipInfo(name + _ENDING)
        member.compress_type = compression
        with archive.open(member, "w", force_zip64=True) as file:
            np.lib.format.write_array(file, np.asarray(array, order="C"), allow_pickle=False)

    with zipfile.ZipFile(path, "w") as archive:
        for name, array in arrays.items():
            put(name, array)
        text = json.dumps({**content, _SEAL: seal_of(content, archive.infolist())}, sort_keys=True)
        put(_HEADER, np.frombuffer(text.encode(), dtype=np.uint8))


def seal_of(header: Mapping[str, Any], members: Iterable[zipfile.ZipInfo]) -> str:
    """Seal of an archive with these arrays and this ``header`` without its seal."""
    listed = sorted((each.filename, each.file_size, each.CRC) for each in members)
    told = json.dumps({key: value for key, value in header.items() if key != _SEAL}, sort_keys=True)
    return hashlib.sha256(f"{told}{listed}".encode()).hexdigest()[:32]


def read_archive(
    path: str | os.PathLike[str], schema: Schema[HeaderType]
) -> tuple[HeaderType, dict[str, np.ndarray]]:
    """Read a file of `write_archive`: the header and the arrays by name, checked against the ``schema``.

    Raises `ArchiveError` if the file is missing, cut off, of another kind or version, or does not match the
    schema. At most `most_unpacked` bytes are unpacked.
    """
    target = Path(path)
    if not target.is_file():
        raise ArchiveError(f"{target}: no such file; expected a {schema.kind} archive")
    try:
        with zipfile.ZipFile(target) as archive:
            return _Reader(target, archive, schema).read()
    except ArchiveError:
        raise
    except OSError as error:
        raise ArchiveError(f"{target}: cannot be read: {error.strerror or error}") from error
    except _DAMAGE as error:
        raise _damaged(target, schema, str(error) or type(error).__name__) from error


def _damaged(target: Path, schema: Schema, problem: str) -> ArchiveError:
    return _wrong(target, schema, problem, " archive (cut off or damaged)")


def _wrong(target: Path, schema: Schema, problem: str, how: str = "") -> ArchiveError:
    told = " ".join(problem.split())
    told = told if len(told) <= 300 else f"{told[:297]}..."
    return ArchiveError(f"{target}: not a whole {schema.kind}{how}: {told}; {schema.remedy}")


class _Reader:
    """Reads one archive, cheap checks before unpacking."""

    def __init__(self, target: Path, archive: zipfile.ZipFile, schema: Schema) -> None:
        self.target, self.archive, self.schema = target, archive, schema

    def read(self) -> tuple[Any, dict[str, np.ndarray]]:
        members = self._members()
        header = self._header(members)
        wanted = self.schema.arrays_of(header)
        self._compare_names(list(members), list(wanted))
        sizes = Sizes()
        packed = {}
        for name, kind in wanted.items():
            each = packed[name] = self._opened(members[name])
            if not kind.accepts(each.dtype):
                raise self._error(f"{name} is of type {each.dtype}, expected {kind.dtype}")
            if problem := sizes.problem(name, each.shape, kind.shape):
                raise self._error(problem)
        arrays = {}
        for name, kind in wanted.items():
            arrays[name] = self._unpacked(packed.pop(name))
            if problem := kind.problem(name, arrays[name], sizes):
                raise self._error(problem)
        if problem := self.schema.check(header, arrays):
            raise self._error(problem)
        return header, arrays

    def _error(self, problem: str) -> ArchiveError:
        return _wrong(self.target, self.schema, problem)

    def _members(self) -> dict[str, zipfile.ZipInfo]:
        """The listed arrays by name, none of them read yet."""
        listed = self.archive.infolist()
        if len(listed) > _MOST_MEMBERS:
            raise self._error(f"lists {len(listed)} arrays")
        found: dict[str, zipfile.ZipInfo] = {}
        for member in listed:
            name = member.filename.removesuffix(_ENDING)
            if name in found:
                raise _damaged(self.target, self.schema, f"lists {_shown(name)} twice")
            if member.flag_bits & _ENCRYPTED or member.compress_type not in _COMPRESSIONS:
                problem = f"{_shown(name)} is encrypted, or uses an unknown compression"
                raise _damaged(self.target, self.schema, problem)
            found[name] = member
        unpacked, packed = sum(each.file_size for each in listed), self.target.stat().st_size
        if unpacked > most_unpacked(packed):
            raise self._error(f"its {packed} bytes unpack to {unpacked}, more than {most_unpacked(packed)}")
        if _HEADER not in found:
            raise self._error("has no header")
        return found

    def _header(self, members: dict[str, zipfile.ZipInfo]) -> Any:
        """The header, checked for kind and version; removes it from ``members``."""
        member = members.pop(_HEADER)
        packed = self._opened(member)
        if packed.dtype != np.uint8 or len(packed.shape) != 1:
            raise self._error("its header is not text")
        text = self._unpacked(packed).tobytes()
        found = plain_json(text.decode())
        if not isinstance(found, dict):
            raise self._error("its header is not a mapping")
        self._compare_versions(found.get("kind"), found.get("version"))
        seal = found.get(_SEAL)  # archives of earlier releases have no seal
        if seal is not None and seal != seal_of(found, members.values()):
            raise self._error("its content was changed after it was written")
        fields = {key: value for key, value in found.items() if key not in ("kind", "version", _SEAL)}
        try:
            return self.schema.header.model_validate_json(json.dumps(fields))
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            where = ".".join(["its header", *(str(step) for step in first["loc"])])
            raise self._error(f"{where}: {first['msg'].removeprefix('Value error, ')}") from None

    def _compare_versions(self, kind: Any, version: Any) -> None:
        if kind != self.schema.kind:
            raise ArchiveError(f"{self.target}: holds a {_shown(kind)}, expected a {self.schema.kind!r}")
        if version != self.schema.version or isinstance(version, bool):
            by = ""
            if isinstance(version, int) and not isinstance(version, bool):
                age = "an older" if version < self.schema.version else "a newer"
                by = f", written by {age} Surefoot"
            raise ArchiveError(
                f"{self.target}: {kind} of version {_shown(version)}{by}; this release reads version "
                f"{self.schema.version}: {self.schema.remedy}"
            )

    def _compare_names(self, found: list[str], wanted: list[str]) -> None:
        for names, others, problem in ((wanted, found, "lacks"), (found, wanted, "should not hold")):
            known = set(others)
            if missing := [name for name in names if name not in known]:
                raise self._error(f"{problem} {_shown(missing[0])}")

    def _opened(self, member: zipfile.ZipInfo) -> "_Packed":
        """An array of which only the first bytes are read; they give its shape, type and so its size."""
        file = self.archive.open(member)
        major = np.lib.format.read_magic(file)[0]
        if major not in (1, 2):
            raise self._error(f"{_shown(member.filename)} is of version {major} of its format")
        read = np.lib.format.read_array_header_1_0 if major == 1 else np.lib.format.read_array_header_2_0
        shape, is_fortran, dtype = read(cast(Any, file))
        count = 1
        for size in shape:
            count *= size
        if dtype.hasobject or min(shape, default=0) < 0:
            raise self._error(f"{_shown(member.filename)} is of type {dtype} and shape {shape}")
        if file.tell() + count * dtype.itemsize != member.file_size:
            raise self._error(f"{_shown(member.filename)} is shorter or longer than its shape {shape}")
        return _Packed(file, shape, dtype, is_fortran)

    def _unpacked(self, packed: "_Packed") -> np.ndarray:
        """The values, read from the current position of the file of ``packed``."""
        order = "F" if packed.is_fortran else "C"
        array = np.empty(packed.shape, packed.dtype, order)
        into = array.reshape(-1, order=order).view(np.uint8).data if array.size else memoryview(b"")
        with packed.file as file:
            done = 0
            while done < len(into):
                read = file.read(min(_CHUNK, len(into) - done))
                if not read:
                    raise self._error(f"{_shown(file.name)} is cut off")
                into[done : done + len(read)] = read
                done += len(read)
            if file.read(1):  # reads the checksum too
                raise self._error(f"{_shown(file.name)} is longer than its shape")
        return np.asarray(array, order="C")


class _Packed(NamedTuple):
    """An array in an archive whose header has been read, but not its values."""

    file: IO[bytes]
    shape: tuple[int, ...]
    dtype: np.dtype
    is_fortran: bool


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
