"""JSON files that Surefoot has written: plain JSON, not too much of it, every number finite."""

import json
import os
from pathlib import Path
from typing import Any

from surefoot.errors import SurefootError

__all__ = ["plain_json", "read_json"]

_MOST_BYTES = 20_000_000


def read_json(path: str | os.PathLike[str], what: str) -> Any:
    """The content of the ``what`` (named in messages) at ``path``. Raises `SurefootError` for a file that is
    missing, cannot be read, is too large, or is no JSON."""
    target = Path(path)
    try:
        size = target.stat().st_size
        if size > _MOST_BYTES:
            raise SurefootError(f"{target}: {size} bytes; a {what} has at most {_MOST_BYTES}")
        return plain_json(target.read_text(encoding="utf-8"))
    except OSError as error:
        raise SurefootError(f"{target}: {error.strerror}; expected a {what} (JSON)") from None
    except SurefootError:
        raise
    except ValueError as error:
        raise SurefootError(f"{target}: not a {what}: {error}") from None


def plain_json(text: str) -> Any:
    """The values that ``text`` says. Raises `ValueError` for what is no JSON, which has neither NaN nor
    infinity, or nested too deeply."""
    try:
        return json.loads(text, parse_constant=_refuse)
    except RecursionError:
        raise ValueError("nested too deeply") from None


def _refuse(name: str) -> None:
    raise ValueError(f"{name} is not finite")
