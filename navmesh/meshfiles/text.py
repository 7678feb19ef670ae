"""Mesh files that are text: their lines, and numbers out of many lines at once."""

import codecs
import os
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from navmesh.meshfiles.mesh_file import MeshFileError

__all__ = ["as_lines", "finite_rows", "numbers", "quoted", "read_bytes", "whole_numbers"]

_MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}

_LONE_SIGN = re.compile(rb"[-+](?![0-9.niNI])")


def read_bytes(path: str | os.PathLike[str]) -> bytes:
    """The file's content. Raises `MeshFileError` where the system does not give it."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise MeshFileError(path, "", error.strerror or str(error)) from None


def as_lines(content: bytes) -> list[bytes]:
    """The lines of a text in UTF-8, UTF-16 with its mark, or any encoding that holds ASCII; of Unix, Windows
    and old Macs."""
    for mark, encoding in _MARKS.items():
        if content.startswith(mark):
            content = content.decode(encoding, errors="replace").encode()
    if b"\r" in content:
        content = content.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return content.split(b"\n")


def finite_rows(
    path: str | os.PathLike[str], rows: Sequence[bytes], lines: Sequence[int], what: str
) -> np.ndarray:
    """(r, 3) float64: the first three numbers of each of ``rows``, which stand in ``lines`` of the file.
    Raises `MeshFileError` for a line that has fewer, or one that is not finite."""
    values, widths = numbers(b" ".join(rows), np.float64), {len(row.split()) for row in rows}
    width = widths.pop() if len(widths) == 1 else 0
    if width < 3 or values is None or len(values) != width * len(rows):
        values, width = _first_three(path, rows, lines, what), 3
    found = values.reshape(-1, width)[:, :3]
    broken = np.flatnonzero(~np.isfinite(found).all(axis=1))
    if len(broken):
        at = int(broken[0])
        raise MeshFileError(path, f"line {lines[at]}", f"{quoted(rows[at])}: a coordinate is not finite")
    return np.ascontiguousarray(found)


def _first_three(
    path: str | os.PathLike[str], rows: Sequence[bytes], lines: Sequence[int], what: str
) -> np.ndarray:
    found = np.empty((len(rows), 3))
    for k, row in enumerate(rows):
        try:
            x, y, z = row.split(None, 3)[:3]
            found[k] = float(x), float(y), float(z)
        except ValueError:
            problem = f"{quoted(row)}: expected three numbers of {what}"
            raise MeshFileError(path, f"line {lines[k]}", problem) from None
    return found


def whole_numbers(
    path: str | os.PathLike[str], rows: Sequence[bytes], lines: Sequence[int], what: str
) -> tuple[np.ndarray, np.ndarray]:
    """The whole numbers of all ``rows``, one after the other, and (r,) how many each has. Raises
    `MeshFileError` for a line that holds something else."""
    counts = np.fromiter((len(row.split()) for row in rows), np.int64, len(rows))
    values = numbers(b" ".join(rows), np.int64)
    if values is None or len(values) != counts.sum():
        for row, number in zip(rows, lines, strict=True):
            own = numbers(row, np.int64)
            if own is None or len(own) != len(row.split()):
                raise MeshFileError(path, f"line {number}", f"{quoted(row)}: expected {what}")
    assert values is not None
    return values, counts


def numbers(text: bytes, kind: type) -> np.ndarray | None:
    """The numbers of a text, None if it holds anything else."""
    if not text.strip():
        return np.empty(0, kind)
    if _LONE_SIGN.search(text):  # NumPy takes one for 0
        return None
    try:
        return np.fromstring(text, dtype=kind, sep=" ")
    except ValueError:
        return None


def quoted(row: bytes) -> str:
    text = row.decode(errors="replace").strip()
    return repr(text if len(text) <= 60 else text[:57] + "...")
