"""Which processes still run."""

import os

__all__ = ["has_ended"]


def has_ended(process: str) -> bool:
    """Whether the process with this number, as text, is known to have ended."""
    if not process.isdecimal() or os.name != "posix":
        return False
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return True
    except PermissionError:
        pass
    return False
