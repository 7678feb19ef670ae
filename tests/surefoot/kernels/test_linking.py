"""Large kernels are compiled once and called; small ones are copied into those who call them."""

from tests.surefoot.kernels.processes import BODY, LOW


def test_a_large_kernel_is_not_copied_and_is_found_in_a_later_process(place, processes):
    assert processes.ask(place)[2] == []  # a small one is inlined
    (place / "low.py").write_text(LOW.format(body=BODY))
    answer, compiled, called = processes.ask(place)
    assert compiled == ["top", "big"] and called == [True]
    assert processes.ask(place)[:2] == [answer, []]
    # without the kernel that it calls the caller is compiled again
    (kept,) = [
        each for each in (place / "kept" / "surefoot").glob("low.big-*") if each.stat().st_size > 20_000
    ]
    kept.unlink()
    again, compiled, _ = processes.ask(place)
    assert again == answer and sorted(compiled) == ["big", "top"]
    assert processes.ask(place)[:2] == [answer, []]
