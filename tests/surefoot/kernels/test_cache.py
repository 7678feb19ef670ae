"""Compiled kernels are kept by what they depend on."""


def test_what_depends_on_an_edit_is_compiled_anew_and_nothing_else(place, processes):
    assert processes.ask(place)[:2] == [[7.0, 4.0], ["top", "big", "apart", "other"]]
    assert processes.ask(place)[:2] == [[7.0, 4.0], []]
    source = place / "low.py"
    source.write_text("# a comment\n" + source.read_text())
    assert processes.ask(place)[1] == []
    source.write_text(source.read_text().replace("FACTOR = 2.0", "FACTOR = 5.0"))
    assert processes.ask(place)[:2] == [[16.0, 4.0], ["top", "big"]]
    source.write_text(source.read_text().replace("x + 1.0", "x + 2.0"))
    assert processes.ask(place)[:2] == [[16.0, 5.0], ["apart", "other"]]
    assert not list(place.glob("__pycache__"))


def test_a_damaged_file_is_compiled_again(place, processes):
    first = processes.ask(place)[0]
    for file in (place / "kept" / "surefoot").glob("high.*"):
        file.write_bytes(file.read_bytes()[:100])
    assert processes.ask(place)[:2] == [first, ["top", "apart"]]
