"""Spoiled files, a few of those of `benchmarks.file_fuzz`: refused in one sentence, or as good as they were.
Here in one process, and for kinds that are read quickly."""

import pytest

from benchmarks.file_fuzz import judge, spoiled
from benchmarks.file_kinds import KINDS, content

_QUICK = (
    "run", "brake", "drop-roll", "checkpoint", "clip", "mapping", "body", "description", "playtest",
    "report", "configuration",
)  # fmt: skip


@pytest.mark.parametrize("name", _QUICK)
def test_spoiled_files_are_refused_or_as_good(name, tmp_path):
    kind = KINDS[name]
    path = tmp_path / f"good{kind.ending}"
    kind.make(path)
    data, good = path.read_bytes(), content(kind.read(path))
    found = set()
    for number in range(20):
        spoilt, seal = spoiled(name, data, 2, number)
        path.write_bytes(spoilt)
        outcome, problem = judge(kind, path, seal, good)
        assert outcome in ("refused", "same", "other"), f"file {number}: {outcome}: {problem}"
        found.add(outcome)
    assert "refused" in found
