"""One process compiles a kernel while the others that need it wait."""

from tests.surefoot.kernels.processes import ASK, BODY, COUNT, LOW


def test_processes_that_start_together_compile_each_kernel_once(place, processes):
    (place / "low.py").write_text(LOW.format(body=BODY))
    answers = processes.ask_at_once(place, [ASK] * 3)
    assert answers[0][0] == answers[1][0] == answers[2][0]
    assert sorted(name for answer in answers for name in answer[1]) == ["apart", "big", "other", "top"]


def test_one_that_cannot_be_compiled_keeps_nobody_waiting(place, processes):
    """It gives its turn back, and so does the one that calls it."""
    (place / "low.py").write_text(LOW.format(body="return [x] + x"))
    tried = f"""
{COUNT}
for _ in range(2):
    try:
        high.top(3.0)
    except Exception as error:
        said = str(error)
from surefoot.kernels import cache
print(json.dumps(["List" in said or "list" in said, len(cache._turns._locks)]))
"""
    assert processes.ask(place, tried) == [True, 0]
