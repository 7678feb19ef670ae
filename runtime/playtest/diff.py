"""What has changed since an earlier report of the same level."""

from dataclasses import dataclass

import numpy as np

from runtime.playtest.fault import Fault
from runtime.playtest.report import Report

__all__ = ["Difference", "compare", "same_finding"]

_SAME = 2.0
"""[m] findings of one kind this near to each other are the same one."""


@dataclass(frozen=True)
class Difference:
    """Findings that are new, gone, and as before; coverage [share] then and now."""

    new: tuple[Fault, ...]
    gone: tuple[Fault, ...]
    kept: tuple[Fault, ...]
    coverage: tuple[float, float]


def compare(before: Report, after: Report) -> Difference:
    """What ``after`` says that ``before`` did not, and the other way round."""
    left = list(before.faults)
    new, kept = [], []
    for fault in after.faults:
        twin = next((each for each in left if same_finding(each, fault)), None)
        if twin is None:
            new.append(fault)
        else:
            left.remove(twin)
            kept.append(fault)
    covered = tuple(report.coverage[-1][1] if report.coverage else 0.0 for report in (before, after))
    return Difference(tuple(new), tuple(left), tuple(kept), (covered[0], covered[1]))


def same_finding(a: Fault, b: Fault) -> bool:
    """Whether two reports of a level speak of one thing: of a kind, and near each other."""
    near = float(np.linalg.norm(np.subtract(a.position, b.position))) <= _SAME
    return near and a.kind == b.kind and a.fails == b.fails
