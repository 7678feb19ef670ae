"""Work in pieces: it and its caller take turns, and never run at the same time."""

import threading

import pytest

from runtime.server.worker import Abandoned, Worker
from surefoot.pausing import pause


@pytest.fixture
def worker():
    made = Worker()
    yield made
    made.end()


def test_a_job_is_done_piece_by_piece_and_then_another(worker):
    done = []

    def job(name):
        for piece in range(3):
            done.append((name, piece, threading.current_thread() is threading.main_thread()))
            pause()
        return name

    for name in ("first", "second"):
        worker.begin(lambda name=name: job(name))
        pieces = 1
        while worker.go_on():
            assert len(done) % 3 == pieces % 3
            pieces += 1
        assert pieces == 4 and worker.result == name and worker.error is None
    assert done == [(name, piece, False) for name in ("first", "second") for piece in range(3)]


def test_what_a_job_raises_is_kept_and_the_next_one_begins_without_it(worker):
    worker.begin(lambda: 1 / 0)
    assert not worker.go_on() and isinstance(worker.error, ZeroDivisionError)
    worker.begin(lambda: 5)
    assert not worker.go_on() and (worker.result, worker.error) == (5, None)


def test_an_abandoned_job_ends_where_it_is_and_cleans_up_in_pieces(worker):
    done = []

    def job():
        try:
            pause()
            done.append("more")
        finally:
            done.append("clean")

    worker.begin(job)
    assert worker.go_on()
    worker.abandon()
    assert done == ["clean"] and isinstance(worker.error, Abandoned)
    worker.begin(lambda: pause() or "new")
    assert worker.go_on() and not worker.go_on() and worker.result == "new"
