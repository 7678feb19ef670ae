"""Bots that playtest a level: what cannot be reached, is one-way, traps, or makes a body stumble."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from runtime.playtest.diff import Difference, compare
    from runtime.playtest.fault import Fault
    from runtime.playtest.report import Report, read_report, write_report
    from runtime.playtest.run import Outcome, playtest

__all__ = ["Difference", "Fault", "Outcome", "Report", "compare", "playtest", "read_report", "write_report"]

_WHERE = {
    "diff": ("Difference", "compare"),
    "fault": ("Fault",),
    "report": ("Report", "read_report", "write_report"),
    "run": ("Outcome", "playtest"),
}


def __getattr__(name: str) -> Any:
    # imported when first asked for: pytest loads the plugin of this package in every run
    for module, names in _WHERE.items():
        if name in names:
            return getattr(import_module(f"runtime.playtest.{module}"), name)
    raise AttributeError(f"module 'runtime.playtest' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
