from surefoot.slices import Slices, finish


def counted(to: int) -> Slices[list[int]]:
    done = []
    for number in range(to):
        done.append(number)
        yield 1
    return done


def test_all_pieces_are_done_and_the_result_returned():
    assert finish(counted(3)) == [0, 1, 2]


def test_what_was_begun_is_finished():
    work = counted(3)
    assert next(work) == 1
    assert finish(work) == [0, 1, 2]


def test_work_without_pieces_has_a_result_too():
    assert finish(counted(0)) == []
