"""The files of the packages that have kernels."""

import hashlib
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import surefoot
from surefoot.kernels.dependencies import PACKAGES

__all__ = ["digest_of_sources"]

_KERNEL = re.compile(rb"^@(?:allocating_)?kernel\b|\bcfunc\(|^FIRST_USES\b", re.MULTILINE)
"""In files with kernels, and in that with the uses for which they are prepared."""


@cache
def digest_of_sources() -> str:
    """Hex digest of all files with kernels, and of the uses for which they are prepared."""
    checksum = hashlib.sha256()
    for file, content in _sources():
        checksum.update(f"{file} {len(content)}\0".encode())
        checksum.update(content)
    return checksum.hexdigest()


def _sources() -> Iterator[tuple[Path, bytes]]:
    """Path in the packages, and content."""
    root = Path(surefoot.__file__).parents[1]
    for package in PACKAGES:
        for file in sorted((root / package).rglob("*.py")):
            content = file.read_bytes()
            if _KERNEL.search(content):
                yield file.relative_to(root), content
