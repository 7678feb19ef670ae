"""JSON files written by Surefoot: standard JSON, limited in size, every number finite."""

import json
import os
from pathlib import Path
from typing import Any

from surefoot.errors import SurefootError

__all__ = ["plain_json", "read_json"]

_MOST_BYTES = 20_000_000


def read_json(path: str | os.PathLike[str], what: str) -> Any:
    """The content of the ``what`` (a noun for messages) at ``path``. Raises `SurefootError` if the file is
    missing, unreadable, too large or not JSON."""
    target = Path(path)
    try:
        size = target.stat().st_size
        if size > _MOST_BYTES:
            raise SurefootError(f"{target}: {size} bytes; a {what} may have at most {_MOST_BYTES}")
        return plain_json(target.read_text(encoding="utf-8"))
    except OSError as error:
        raise SurefootError(f"{target}: {error.strerror}; expected a {what} (JSON)") from None
    except SurefootError:
        raise
    except ValueError as error:
        raise SurefootError(f"{target}: not a {what}: {error}") from None


def plain_json(text: str) -> Any:
    """Parse ``text``. Raises `ValueError` if it is not JSON (which excludes NaN and infinity) or nested too
    deeply."""
    try:
        return json.loads(text, parse_constant=_refuse)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def _refuse(name: str) -> None:
    raise ValueError(f"{name} is not finite")
